#include "hires/ros/robot/controller_messages.h"

namespace {

constexpr char kRuler[] =
    "================================================================================\n";

/// What a bag or `rostopic echo` needs to take a message apart: its own text, then that of every
/// type that it is made of.
template <typename Message>
std::string Part(const std::string& type) {
  return kRuler + ("MSG: " + type + '\n') + ros::message_traits::definition<Message>() + '\n';
}

const char kHead[] = "Header header\nactionlib_msgs/GoalID goal_id\n";

std::string HeadParts() {
  return Part<std_msgs::Header>("std_msgs/Header") +
         Part<actionlib_msgs::GoalID>("actionlib_msgs/GoalID");
}

}  // namespace

namespace ros {
namespace message_traits {

const char* Definition<hires_ros::FollowJointTrajectoryActionGoal>::value() {
  static const std::string text =
      kHead + std::string("FollowJointTrajectoryGoal goal\n") + kRuler +
      "MSG: control_msgs/FollowJointTrajectoryGoal\n"
      "trajectory_msgs/JointTrajectory trajectory\n"
      "JointTolerance[] path_tolerance\n"
      "JointTolerance[] goal_tolerance\n"
      "duration goal_time_tolerance\n" +
      kRuler +
      "MSG: control_msgs/JointTolerance\n"
      "string name\nfloat64 position\nfloat64 velocity\nfloat64 acceleration\n" +
      HeadParts() +
      // It brings the header and its points along; a type may stand twice.
      Part<trajectory_msgs::JointTrajectory>("trajectory_msgs/JointTrajectory");
  return text.c_str();
}

const char* Definition<hires_ros::GripperCommandActionGoal>::value() {
  static const std::string text = kHead + std::string("GripperCommandGoal goal\n") + kRuler +
                                  "MSG: control_msgs/GripperCommandGoal\n"
                                  "GripperCommand command\n" +
                                  kRuler +
                                  "MSG: control_msgs/GripperCommand\n"
                                  "float64 position\nfloat64 max_effort\n" +
                                  HeadParts();
  return text.c_str();
}

}  // namespace message_traits
}  // namespace ros
