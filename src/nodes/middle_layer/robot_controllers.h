#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "hires/control/robot_names.h"
#include "hires/robot/observation.h"
#include "hires/ros/robot/controller_topics.h"

namespace hires_ros {

/// The controllers of a robot, as they are told by topics.
class RobotControllers {
 public:
  /// @param base_topic  of the base, which may be that of its guard.
  RobotControllers(const hires::control::RobotNames& names, const std::string& base_topic,
                   ros::NodeHandle* nh);

  /// @pre the names tell controllers for all that the command is about.
  void Send(const hires::robot::Command& command);

  /// A controller that is needed and does not listen; empty: all are there.
  /// @param groups  as actions::GroupsOf.
  std::string Missing(const std::set<std::string>& groups) const;
  /// The same of all groups that the names tell controllers for.
  std::string Missing() const;

  bool is_base_there() const { return base_.getNumSubscribers() > 0; }
  std::string base_topic() const { return base_.getTopic(); }

  /// Messages that went out since it was asked last.
  std::uint64_t TakeNumSent();

 private:
  std::string MissingOf(const std::string& group) const;

  ros::Publisher base_;
  std::map<std::string, TrajectoryTopic> trajectories_;  // by group
  std::map<std::string, GripperTopic> grippers_;         // by arm
  std::uint64_t num_sent_{0};
};

}  // namespace hires_ros
