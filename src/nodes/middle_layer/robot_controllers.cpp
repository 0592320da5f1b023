#include "nodes/middle_layer/robot_controllers.h"

#include <utility>

#include "hires/ros/robot/robot_messages.h"

namespace hires_ros {

RobotControllers::RobotControllers(const hires::control::RobotNames& names,
                                   const std::string& base_topic, ros::NodeHandle* nh)
    : base_(nh->advertise<geometry_msgs::Twist>(base_topic, 10)) {
  for (const auto& [group, topic] : names.trajectories) {
    trajectories_[group] = {names.trajectory_interface, topic, nh};
  }
  for (const auto& [arm, topic] : names.grippers) {
    grippers_[arm] = {names.gripper_interface, topic, nh};
  }
}

void RobotControllers::Send(const hires::robot::Command& command) {
  if (command.base_velocity) {
    base_.publish(ToMsg(*command.base_velocity));
    ++num_sent_;
  }
  for (const auto& [group, trajectory] : command.trajectories) {
    trajectories_.at(group).Send(trajectory);
    ++num_sent_;
  }
  for (const auto& [arm, gripper] : command.grippers) {
    grippers_.at(arm).Send(gripper);
    ++num_sent_;
  }
}

std::string RobotControllers::Missing(const std::set<std::string>& groups) const {
  if (groups.count("base") > 0 && !is_base_there()) return base_topic();
  for (const std::string& group : groups) {
    std::string missing = group == "base" ? "" : MissingOf(group);
    if (!missing.empty()) return missing;
  }
  return "";
}

std::string RobotControllers::Missing() const {
  std::set<std::string> groups{"base"};
  for (const auto& entry : trajectories_) groups.insert(entry.first);
  return Missing(groups);
}

std::string RobotControllers::MissingOf(const std::string& group) const {
  const bool is_arm = group != "torso" && group != "head";
  const auto trajectory = trajectories_.find(group);
  const auto gripper = grippers_.find(group);
  if (trajectory == trajectories_.end() || (is_arm && gripper == grippers_.end())) {
    return "a controller: the names file has none for " + group;
  }
  if (!trajectory->second.is_heard()) return trajectory->second.name();
  if (is_arm && !gripper->second.is_heard()) return gripper->second.name();
  return "";
}

std::uint64_t RobotControllers::TakeNumSent() { return std::exchange(num_sent_, 0); }

}  // namespace hires_ros
