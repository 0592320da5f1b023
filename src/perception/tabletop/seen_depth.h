#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/perception/point_cloud.h"

namespace hires::perception {

/// How far the camera saw in each direction: the nearest point of each pixel of a picture of 2 by 2
/// in tangents. Its pixels may be smaller than the camera's: where one is empty, those about it
/// count.
class SeenDepth {
 public:
  explicit SeenDepth(const PointCloud& cloud);

  /// The point that was seen in the direction of another, both in the camera's frame [m]; -1: where
  /// nothing was measured something may be, in the shadow of the projector or too near.
  /// @pre the other is in front of the camera.
  int PointTowards(const Eigen::Vector3d& p_C) const;

 private:
  static constexpr int kPixels = 600;

  std::vector<int> nearest_;  // of each pixel, row by row
  std::vector<float> depth_;  // [m] of that point
};

}  // namespace hires::perception
