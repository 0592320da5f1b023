#include "hires/ros/world/world_messages.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

geometry_msgs::Twist TwistMsg(const hires::geometry::Twist3& twist) {
  geometry_msgs::Twist out;
  out.linear.x = twist.linear.x();
  out.linear.y = twist.linear.y();
  out.linear.z = twist.linear.z();
  out.angular.x = twist.angular.x();
  out.angular.y = twist.angular.y();
  out.angular.z = twist.angular.z();
  return out;
}

hires::geometry::Twist3 FromTwistMsg(const geometry_msgs::Twist& twist) {
  return {{twist.linear.x, twist.linear.y, twist.linear.z},
          {twist.angular.x, twist.angular.y, twist.angular.z}};
}

}  // namespace

msg::WorldState ToMsg(const hires::world::WorldState& state) {
  msg::WorldState out;
  out.header.frame_id = "map";
  for (const hires::world::ObjectState& object : state.objects) {
    msg::ObjectState entry;
    entry.name = object.name;
    entry.model = object.model;
    entry.pose = ToMsg(object.X_MO);
    entry.twist = TwistMsg(object.V_MO);
    entry.attached_to = object.attached_to;
    out.objects.push_back(entry);
  }
  return out;
}

hires::world::WorldState FromMsg(const msg::WorldState& state) {
  hires::world::WorldState out;
  for (const msg::ObjectState& entry : state.objects) {
    out.objects.push_back({entry.name, entry.model, FromMsg(entry.pose), FromTwistMsg(entry.twist),
                           entry.attached_to});
  }
  return out;
}

void RequireSoundState(const msg::WorldState& world, const msg::RobotState& robot) {
  if (world.header.frame_id.empty() && world.objects.empty() && robot.joints.name.empty()) {
    throw hires::base::ConfigError(
        "nothing says where it begins: name RobotAt(area) in updated_fluents (robot_at= in "
        "Python), "
        "or give world_state, with header.frame_id 'map', and robot_state");
  }
  if (world.header.frame_id != "map" && world.header.frame_id != "/map") {
    throw hires::base::ConfigError(
        fmt::format("world_state.header.frame_id is '{}', wanted 'map'; give poses in map, or name "
                    "updated_fluents instead of a state",
                    world.header.frame_id));
  }
  constexpr double kHighestBase = 1.0;  // [m] over the floor, where its base link may lie
  const double height = robot.pose.position.z;
  if (!(std::abs(height) <= kHighestBase)) {
    throw hires::base::ConfigError(
        fmt::format("robot_state.pose.position.z is {:.6g} m, wanted about 0: robots drive on the "
                    "floor z = 0 of the map",
                    height));
  }
  const hires::geometry::Twist3 twist = FromTwistMsg(robot.twist);
  if (!twist.linear.allFinite() || !twist.angular.allFinite()) {
    throw hires::base::ConfigError("robot_state.twist is not finite; give numbers, 0 at rest");
  }
  if (!std::isfinite(robot.yaw)) {
    throw hires::base::ConfigError(
        "robot_state.yaw is not finite; leave it at 0 to let the pose say the heading");
  }
  for (std::size_t i = 0; i < robot.joints.position.size(); ++i) {
    if (std::isfinite(robot.joints.position[i])) continue;
    throw hires::base::ConfigError(
        fmt::format("robot_state.joints: position {} is not finite; give numbers", i));
  }
}

}  // namespace hires_ros
