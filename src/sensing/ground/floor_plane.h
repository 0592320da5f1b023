#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/base/rng.h"
#include "hires/sensing/ground_watch.h"

namespace hires::sensing {

/// The plane z = slope . (x, y) + offset in the frame of the base.
struct FloorPlane {
  Eigen::Vector2d slope{0.0, 0.0};
  double offset{0.0};   ///< [m]
  bool is_seen{false};  ///< else it is the base's own z = 0, as too little of a floor was seen
  int num_points{0};    ///< that it rests on

  double HeightOf(const Eigen::Vector3d& p_B) const {  ///< [m] over it, along the base's z axis
    return p_B.z() - slope.dot(p_B.head<2>()) - offset;
  }
};

/// Finds the floor among points: the best of planes through three of them that the tolerances allow
/// (RANSAC), fitted by least squares to all points near it.
/// @param points_B  finite.
FloorPlane FindFloor(const std::vector<Eigen::Vector3d>& points_B, const FloorParams& params,
                     base::Rng* rng);

}  // namespace hires::sensing
