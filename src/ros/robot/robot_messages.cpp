#include "hires/ros/robot/robot_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::robot::JointTrajectory;
using hires::robot::TrajectoryPoint;

bool AllFinite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

void RequireJoints(const std::vector<std::string>& joints, const std::vector<std::string>& known,
                   const std::string& where) {
  if (joints.empty()) {
    throw ConfigError(where + ": names no joints; a trajectory moves at least one");
  }
  std::set<std::string> seen;
  for (const std::string& joint : joints) {
    if (std::find(known.begin(), known.end(), joint) == known.end()) {
      throw ConfigError(where + ": " + hires::base::UnknownName("joint", joint, known));
    }
    if (!seen.insert(joint).second) {
      throw ConfigError(fmt::format("{}: names joint '{}' twice; once is enough", where, joint));
    }
  }
}

TrajectoryPoint PointFrom(const trajectory_msgs::JointTrajectoryPoint& msg, std::size_t joints,
                          const std::string& where) {
  if (msg.positions.size() != joints) {
    throw ConfigError(
        fmt::format("{} has {} positions for {} joints", where, msg.positions.size(), joints));
  }
  if (!msg.velocities.empty() && msg.velocities.size() != joints) {
    throw ConfigError(fmt::format("{} has {} velocities for {} joints; give all or none", where,
                                  msg.velocities.size(), joints));
  }
  if (!AllFinite(msg.positions) || !AllFinite(msg.velocities)) {
    throw ConfigError(where + " has a number that is not finite");
  }
  return {msg.time_from_start.toSec(), msg.positions, msg.velocities};
}

}  // namespace

geometry_msgs::Twist ToMsg(const hires::geometry::Twist2& V_B) {
  geometry_msgs::Twist out;
  out.linear.x = V_B.vx;
  out.linear.y = V_B.vy;
  out.angular.z = V_B.wz;
  return out;
}

hires::geometry::Twist2 FromMsg(const geometry_msgs::Twist& twist, const std::string& where) {
  if (!AllFinite({twist.linear.x, twist.linear.y, twist.angular.z})) {
    throw ConfigError(where + ": linear.x, linear.y or angular.z is not finite; give numbers");
  }
  return {twist.linear.x, twist.linear.y, twist.angular.z};
}

trajectory_msgs::JointTrajectory ToMsg(const JointTrajectory& trajectory) {
  trajectory_msgs::JointTrajectory out;
  out.joint_names = trajectory.joints;
  for (const TrajectoryPoint& point : trajectory.points) {
    trajectory_msgs::JointTrajectoryPoint p;
    p.time_from_start = ros::Duration(point.time);
    p.positions = point.positions;
    p.velocities = point.velocities;
    out.points.push_back(std::move(p));
  }
  return out;
}

JointTrajectory FromMsg(const trajectory_msgs::JointTrajectory& msg,
                        const std::vector<std::string>& known, const std::string& where) {
  RequireJoints(msg.joint_names, known, where);
  if (msg.points.empty()) throw ConfigError(where + ": has no points; one is the least");
  JointTrajectory out{msg.joint_names, {}};
  for (std::size_t i = 0; i < msg.points.size(); ++i) {
    const std::string point = fmt::format("{}: point {}", where, i);
    out.points.push_back(PointFrom(msg.points[i], msg.joint_names.size(), point));
    const double earliest = i == 0 ? 0.0 : out.points[i - 1].time;
    if (out.points[i].time < earliest || (i > 0 && out.points[i].time == earliest)) {
      throw ConfigError(fmt::format("{} comes at {:g} s, wanted after {:g} s; times ascend", point,
                                    out.points[i].time, earliest));
    }
  }
  return out;
}

hires::robot::JointReading FromMsg(const sensor_msgs::JointState& msg) {
  hires::robot::JointReading out;
  for (std::size_t i = 0; i < msg.name.size(); ++i) {
    if (i < msg.position.size()) out.positions[msg.name[i]] = msg.position[i];
    if (i < msg.velocity.size()) out.velocities[msg.name[i]] = msg.velocity[i];
  }
  return out;
}

sensor_msgs::JointState ToMsg(const hires::robot::JointReading& joints, const ros::Time& stamp) {
  sensor_msgs::JointState out;
  out.header.stamp = stamp;
  for (const auto& [name, position] : joints.positions) {
    out.name.push_back(name);
    out.position.push_back(position);
    const auto velocity = joints.velocities.find(name);
    out.velocity.push_back(velocity == joints.velocities.end() ? 0.0 : velocity->second);
  }
  return out;
}

hires::robot::OdometryReading FromMsg(const nav_msgs::Odometry& msg) {
  const geometry_msgs::Twist& twist = msg.twist.twist;
  return {hires::geometry::Flatten(FromMsg(msg.pose.pose)),
          {twist.linear.x, twist.linear.y, twist.angular.z}};
}

std::vector<geometry_msgs::TransformStamped> LinkTransforms(
    const hires::robot::Robot& robot, const hires::robot::JointPositions& joints,
    const ros::Time& stamp) {
  const auto& model = robot.model;
  const auto X_RL = hires::robot::ForwardKinematics(model, joints);
  std::vector<geometry_msgs::TransformStamped> links;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& joint = model.links[i].joint;
    // What hangs below the base's link; that itself stands in the map.
    if (!joint || model.links[i].name == robot.profile.base_link) continue;
    links.push_back(MakeTransform(model.links[joint->parent].name, model.links[i].name,
                                  X_RL[joint->parent].Inverse() * X_RL[i], stamp));
  }
  return links;
}

geometry_msgs::TransformStamped MakeTransform(const std::string& parent, const std::string& child,
                                              const hires::geometry::Pose3& X_PC,
                                              const ros::Time& stamp) {
  geometry_msgs::TransformStamped out;
  out.header.frame_id = parent;
  out.header.stamp = stamp;
  out.child_frame_id = child;
  const geometry_msgs::Pose pose = ToMsg(X_PC);
  out.transform.translation.x = pose.position.x;
  out.transform.translation.y = pose.position.y;
  out.transform.translation.z = pose.position.z;
  out.transform.rotation = pose.orientation;
  return out;
}

}  // namespace hires_ros
