#include "hires/ros/values/pose_messages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "hires/base/error.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;

constexpr std::array<int, 3> kPlanar{0, 1, 5};  // x, y, yaw of x, y, z, roll, pitch, yaw

}  // namespace

geometry_msgs::PoseWithCovarianceStamped ToMsg(const UncertainPose& pose,
                                               const std_msgs::Header& header) {
  geometry_msgs::PoseWithCovarianceStamped msg;
  msg.header = header;
  msg.pose.pose = ToMsg(hires::geometry::Lift(pose.X_AB));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      msg.pose.covariance[6 * kPlanar[row] + kPlanar[column]] = pose.covariance(row, column);
  }
  return msg;
}

void RequireRotation(const geometry_msgs::Quaternion& rotation, const std::string& where) {
  const double length = std::sqrt(rotation.x * rotation.x + rotation.y * rotation.y +
                                  rotation.z * rotation.z + rotation.w * rotation.w);
  if (std::abs(length - 1.0) <= 0.01) return;  // never of NaN
  throw ConfigError(fmt::format("{} has length {:.3g}, wanted 1", where, length));
}

UncertainPose FromMsg(const geometry_msgs::PoseWithCovariance& msg) {
  const geometry_msgs::Point& position = msg.pose.position;
  if (!std::isfinite(position.x) || !std::isfinite(position.y)) {
    throw ConfigError(
        fmt::format("pose.pose.position is {}, {}, wanted numbers [m]", position.x, position.y));
  }
  RequireRotation(msg.pose.orientation, "pose.pose.orientation");
  UncertainPose pose;
  pose.X_AB = {position.x, position.y, hires::geometry::YawOf(FromMsg(msg.pose).rotation)};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      pose.covariance(row, column) = msg.covariance[6 * kPlanar[row] + kPlanar[column]];
  }
  if (!pose.covariance.allFinite()) {
    throw ConfigError("pose.covariance of x, y and yaw is not finite, wanted numbers");
  }
  return pose;
}

}  // namespace hires_ros
