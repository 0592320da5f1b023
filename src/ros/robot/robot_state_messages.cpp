#include "hires/ros/robot/robot_state_messages.h"

#include <cmath>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {

msg::RobotState ToMsg(const hires::robot::RobotState& state) {
  msg::RobotState out;
  out.pose.position.x = state.X_MB.x;
  out.pose.position.y = state.X_MB.y;
  out.pose.orientation.z = std::sin(state.X_MB.yaw / 2.0);
  out.pose.orientation.w = std::cos(state.X_MB.yaw / 2.0);
  out.yaw = state.X_MB.yaw;
  out.twist.linear.x = state.V_B.vx;
  out.twist.linear.y = state.V_B.vy;
  out.twist.angular.z = state.V_B.wz;
  for (const auto& [name, position] : state.joints) {
    out.joints.name.push_back(name);
    out.joints.position.push_back(position);
  }
  return out;
}

hires::robot::RobotState FromMsg(const msg::RobotState& state) {
  hires::robot::RobotState out;
  // Who fills in the pose alone leaves yaw at 0: it counts only where it says what the pose says.
  const double posed = hires::geometry::YawOf(FromMsg(state.pose).rotation);
  const bool fits = std::abs(hires::geometry::WrapToPi(posed - state.yaw)) < 1e-9;
  const double yaw = fits ? state.yaw : posed;
  out.X_MB = {state.pose.position.x, state.pose.position.y, yaw};
  out.V_B = {state.twist.linear.x, state.twist.linear.y, state.twist.angular.z};
  if (state.joints.name.size() != state.joints.position.size()) {
    throw hires::base::ConfigError("robot_state.joints: names and positions differ in number");
  }
  for (std::size_t i = 0; i < state.joints.name.size(); ++i) {
    out.joints[state.joints.name[i]] = state.joints.position[i];
  }
  return out;
}

}  // namespace hires_ros
