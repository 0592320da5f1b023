#pragma once

#include <kdl/frames.hpp>

#include "hires/geometry/pose.h"

namespace hires::manipulation {

inline KDL::Vector ToKdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline KDL::Frame ToKdl(const geometry::Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()), ToKdl(pose.translation)};
}

inline geometry::Pose3 FromKdl(const KDL::Frame& frame) {
  double x, y, z, w;
  frame.M.GetQuaternion(x, y, z, w);
  return {{frame.p.x(), frame.p.y(), frame.p.z()}, Eigen::Quaterniond(w, x, y, z).normalized()};
}

}  // namespace hires::manipulation
