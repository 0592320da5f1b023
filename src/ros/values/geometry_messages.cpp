#include "hires/ros/values/geometry_messages.h"

#include <cmath>

namespace hires_ros {
namespace {

using hires::geometry::Pose3;

}  // namespace

geometry_msgs::Pose ToMsg(const Pose3& pose) {
  geometry_msgs::Pose out;
  out.position.x = pose.translation.x();
  out.position.y = pose.translation.y();
  out.position.z = pose.translation.z();
  out.orientation.x = pose.rotation.x();
  out.orientation.y = pose.rotation.y();
  out.orientation.z = pose.rotation.z();
  out.orientation.w = pose.rotation.w();
  return out;
}

Pose3 FromMsg(const geometry_msgs::Pose& pose) {
  const auto& q = pose.orientation;
  Pose3 out{{pose.position.x, pose.position.y, pose.position.z}, {q.w, q.x, q.y, q.z}};
  const double norm = out.rotation.norm();
  if (norm == 0.0) out.rotation.setIdentity();
  // A unit quaternion passes untouched: dividing by a norm of almost 1 would change its bits.
  if (norm > 0.0 && std::abs(norm - 1.0) > 1e-9) out.rotation.normalize();
  return out;
}

}  // namespace hires_ros
