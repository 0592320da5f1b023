#pragma once

#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "hires/navigation/base_guard.h"
#include "hires/robot/robot_profile.h"

/// What `hires doctor --robot` wants of a robot.
namespace hires::cli {

/// A topic that some node must publish for our nodes to work.
struct WantedTopic {
  std::string what;  ///< "odometry"
  std::string name;  ///< "/base_odometry/odom"
  std::string type;  ///< "nav_msgs/Odometry"
  std::string md5;
  bool is_stamped{false};  ///< its messages begin with a header
  double min_rate{0.0};    ///< [Hz] below which a motion is not safe; 0: comes when there is news
  double max_age{0.0};     ///< [s] of its stamps; 0: old ones are well
  std::string remedy;      ///< what to do where no node publishes it
};

/// A topic that some node must listen to, or nothing moves.
struct WantedListener {
  std::string what;  ///< "arm leftarm1"
  std::string name;  ///< "/l_arm_controller/command"
  std::string type;
  std::string remedy;
};

/// A type of messages, as its publishers and listeners must have it.
struct MessageType {
  std::string name;  ///< "nav_msgs/Odometry"
  std::string md5;
  bool has_header{false};
};

/// Those of a robot's topics. They belong to ROS, and are handed in by who knows it.
struct RobotMessageTypes {
  MessageType odometry, joint_states, scan, localisation, motors_halted, map;
  MessageType base_command, trajectory, gripper;
  MessageType trajectory_goal, gripper_goal;  ///< where controllers are actions
};

/// What a robot of these names must publish and listen to.
struct RobotNeeds {
  hires::control::RobotNames names;
  std::vector<WantedTopic> topics;  ///< without the map
  WantedTopic map;                  ///< a service does as well
  std::vector<WantedListener> listeners;
  double max_frame_age{0.0};  ///< [s] of transforms between map and base

  std::vector<WantedTopic> all_topics() const;  ///< the map is the last one
};
/// @param guard  what it waits for in vain ends each motion of the base.
RobotNeeds NeedsOf(const hires::control::RobotNames& names, const RobotMessageTypes& types,
                   const navigation::BaseGuardParams& guard);

/// Links that our nodes look up; each must have a transform.
std::vector<std::string> LinksOf(const hires::robot::RobotProfile& profile);

/// A joint that must be told by one of these names: a gripper's by its gap or its finger's angle.
using JointChoice = std::vector<std::string>;
std::vector<JointChoice> JointsOf(const hires::robot::RobotProfile& profile);

/// "/base_scan" for "base_scan".
std::string Absolute(const std::string& name);

}  // namespace hires::cli
