#pragma once

#include <actionlib_msgs/GoalID.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <string>
#include <vector>

namespace hires_ros {

// What controllers are told, where the message's package is not in Debian. A message is what goes
// over the wire, so name, checksum and layout are given here. By goals of the two actions of
// control_msgs most robots' controllers are led: an action server gives a goal without an id one of
// its own, and takes a newer goal instead of an older.

/// pr2_controllers_msgs/Pr2GripperCommand: what a PR2's gripper controller is told.
struct Pr2GripperCommand {
  double position{0.0};     ///< [m] gap between the finger tips
  double max_effort{-1.0};  ///< [N]; negative: no limit
};

/// control_msgs/JointTolerance: how far a joint may be off; 0 leaves it to the controller.
struct JointTolerance {
  std::string name;
  double position{0.0}, velocity{0.0}, acceleration{0.0};
};

/// control_msgs/FollowJointTrajectoryActionGoal
struct FollowJointTrajectoryActionGoal {
  std_msgs::Header header;
  actionlib_msgs::GoalID goal_id;
  trajectory_msgs::JointTrajectory trajectory;
  std::vector<JointTolerance> path_tolerance, goal_tolerance;
  ros::Duration goal_time_tolerance;
};

/// control_msgs/GripperCommandActionGoal
struct GripperCommandActionGoal {
  std_msgs::Header header;
  actionlib_msgs::GoalID goal_id;
  double position{0.0};    ///< [m] gap between the finger tips
  double max_effort{0.0};  ///< [N]
};

}  // namespace hires_ros

namespace ros {
namespace message_traits {

template <>
struct IsFixedSize<hires_ros::Pr2GripperCommand> : TrueType {};
template <>
struct IsMessage<hires_ros::Pr2GripperCommand> : TrueType {};

template <>
struct MD5Sum<hires_ros::Pr2GripperCommand> {
  static const char* value() { return "680acaff79486f017132a7f198d40f08"; }
  static const char* value(const hires_ros::Pr2GripperCommand&) { return value(); }
};

template <>
struct DataType<hires_ros::Pr2GripperCommand> {
  static const char* value() { return "pr2_controllers_msgs/Pr2GripperCommand"; }
  static const char* value(const hires_ros::Pr2GripperCommand&) { return value(); }
};

template <>
struct Definition<hires_ros::Pr2GripperCommand> {
  static const char* value() { return "float64 position\nfloat64 max_effort\n"; }
  static const char* value(const hires_ros::Pr2GripperCommand&) { return value(); }
};

template <>
struct IsMessage<hires_ros::FollowJointTrajectoryActionGoal> : TrueType {};
template <>
struct HasHeader<hires_ros::FollowJointTrajectoryActionGoal> : TrueType {};

template <>
struct MD5Sum<hires_ros::FollowJointTrajectoryActionGoal> {
  static const char* value() { return "cff5c1d533bf2f82dd0138d57f4304bb"; }
  static const char* value(const hires_ros::FollowJointTrajectoryActionGoal&) { return value(); }
};

template <>
struct DataType<hires_ros::FollowJointTrajectoryActionGoal> {
  static const char* value() { return "control_msgs/FollowJointTrajectoryActionGoal"; }
  static const char* value(const hires_ros::FollowJointTrajectoryActionGoal&) { return value(); }
};

template <>
struct Definition<hires_ros::FollowJointTrajectoryActionGoal> {
  static const char* value();
  static const char* value(const hires_ros::FollowJointTrajectoryActionGoal&) { return value(); }
};

template <>
struct IsMessage<hires_ros::GripperCommandActionGoal> : TrueType {};
template <>
struct HasHeader<hires_ros::GripperCommandActionGoal> : TrueType {};

template <>
struct MD5Sum<hires_ros::GripperCommandActionGoal> {
  static const char* value() { return "aa581f648a35ed681db2ec0bf7a82bea"; }
  static const char* value(const hires_ros::GripperCommandActionGoal&) { return value(); }
};

template <>
struct DataType<hires_ros::GripperCommandActionGoal> {
  static const char* value() { return "control_msgs/GripperCommandActionGoal"; }
  static const char* value(const hires_ros::GripperCommandActionGoal&) { return value(); }
};

template <>
struct Definition<hires_ros::GripperCommandActionGoal> {
  static const char* value();
  static const char* value(const hires_ros::GripperCommandActionGoal&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<hires_ros::Pr2GripperCommand> {
  template <typename Stream, typename Message>
  inline static void allInOne(Stream& stream, Message message) {
    stream.next(message.position);
    stream.next(message.max_effort);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hires_ros::JointTolerance> {
  template <typename Stream, typename Message>
  inline static void allInOne(Stream& stream, Message message) {
    stream.next(message.name);
    stream.next(message.position);
    stream.next(message.velocity);
    stream.next(message.acceleration);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hires_ros::FollowJointTrajectoryActionGoal> {
  template <typename Stream, typename Message>
  inline static void allInOne(Stream& stream, Message message) {
    stream.next(message.header);
    stream.next(message.goal_id);
    stream.next(message.trajectory);
    stream.next(message.path_tolerance);
    stream.next(message.goal_tolerance);
    stream.next(message.goal_time_tolerance);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hires_ros::GripperCommandActionGoal> {
  template <typename Stream, typename Message>
  inline static void allInOne(Stream& stream, Message message) {
    stream.next(message.header);
    stream.next(message.goal_id);
    stream.next(message.position);
    stream.next(message.max_effort);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros
