#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace hires_ros {

/// What a PR2's gripper controller is told. The package of that message is not in Debian; a message
/// is what goes over the wire, so name, checksum and layout are given here.
struct Pr2GripperCommand {
  double position{0.0};     ///< [m] gap between the finger tips
  double max_effort{-1.0};  ///< [N]; negative: no limit
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

}  // namespace serialization
}  // namespace ros
