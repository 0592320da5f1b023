#pragma once

#include <vector>

#include "perception/self/padded_shape.h"

namespace hires::perception {

/// Padded shapes by the cells of a grid that they reach into, so that most points ask few of them.
class ShapeGrid {
 public:
  /// @param shapes  outlive this.
  explicit ShapeGrid(const std::vector<PaddedShape>* shapes);

  bool Contains(const Eigen::Vector3f& p_S) const;  ///< false for what is no number
  /// Whether a padded shape without the sensor in it lies before p_S.
  bool HidesFromOrigin(const Eigen::Vector3f& p_S) const;

 private:
  void Fill();

  const std::vector<PaddedShape>& shapes_;
  std::vector<const PaddedShape*> hiding_;  // without the sensor in them
  Eigen::AlignedBox3f bounds_;
  float cell_{0.0f};               // [m] edge
  Eigen::Vector3i size_{0, 0, 0};  // [cells]
  std::vector<int> first_;         // cell -> its first in candidates_, and one behind the last cell
  std::vector<const PaddedShape*> candidates_;
};

}  // namespace hires::perception
