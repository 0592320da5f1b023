#include "hires/ros/robot/controller_topics.h"

#include "hires/ros/robot/controller_messages.h"
#include "hires/ros/robot/robot_messages.h"

namespace hires_ros {

using hires::control::GripperInterface;
using hires::control::TrajectoryInterface;

namespace {

constexpr int kQueue = 10;
// [N] more than a gripper has: controllers of control_msgs take an effort's size for its limit, so
// that what means "no limit" to a PR2 would be one newton.
constexpr double kNoLimit = 1000.0;

}  // namespace

TrajectoryTopic::TrajectoryTopic(TrajectoryInterface interface, const std::string& topic,
                                 ros::NodeHandle* nh)
    : interface_(interface),
      publisher_(interface == TrajectoryInterface::kFollowJointTrajectory
                     ? nh->advertise<FollowJointTrajectoryActionGoal>(topic, kQueue)
                     : nh->advertise<trajectory_msgs::JointTrajectory>(topic, kQueue)) {}

void TrajectoryTopic::Send(const hires::robot::JointTrajectory& trajectory) const {
  if (!publisher_) return;
  if (interface_ == TrajectoryInterface::kFollowJointTrajectory) {
    FollowJointTrajectoryActionGoal goal;
    goal.trajectory = ToMsg(trajectory);
    publisher_.publish(goal);
  } else {
    publisher_.publish(ToMsg(trajectory));
  }
}

GripperTopic::GripperTopic(GripperInterface interface, const std::string& topic,
                           ros::NodeHandle* nh)
    : interface_(interface),
      publisher_(interface == GripperInterface::kGripperCommand
                     ? nh->advertise<GripperCommandActionGoal>(topic, kQueue)
                     : nh->advertise<Pr2GripperCommand>(topic, kQueue)) {}

void GripperTopic::Send(const hires::robot::GripperCommand& command) const {
  if (!publisher_) return;
  if (interface_ == GripperInterface::kGripperCommand) {
    GripperCommandActionGoal goal;
    goal.position = command.gap;
    goal.max_effort = command.max_effort < 0.0 ? kNoLimit : command.max_effort;
    publisher_.publish(goal);
  } else {
    publisher_.publish(Pr2GripperCommand{command.gap, command.max_effort});
  }
}

}  // namespace hires_ros
