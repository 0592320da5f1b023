#pragma once

#include <Eigen/Core>

#include "hires/geometry/angles.h"
#include "hires/geometry/pose.h"

namespace hires::geometry {

/// a - b in x, y [m] and yaw [rad, -pi .. pi], component by component, as filters take it.
inline Eigen::Vector3d Difference(const Pose2& a, const Pose2& b) {
  return {a.x - b.x, a.y - b.y, WrapToPi(a.yaw - b.yaw)};
}

}  // namespace hires::geometry
