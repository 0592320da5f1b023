#include "nodes/hires/message_types.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "hires/ros/robot/controller_messages.h"

namespace hires_ros {
namespace {

template <typename Message>
hires::cli::MessageType TypeOf() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(),
          ros::message_traits::hasHeader<Message>()};
}

}  // namespace

hires::cli::RobotMessageTypes MessageTypesOfRobot() {
  hires::cli::RobotMessageTypes types;
  types.odometry = TypeOf<nav_msgs::Odometry>();
  types.joint_states = TypeOf<sensor_msgs::JointState>();
  types.scan = TypeOf<sensor_msgs::LaserScan>();
  types.localisation = TypeOf<geometry_msgs::PoseWithCovarianceStamped>();
  types.motors_halted = TypeOf<std_msgs::Bool>();
  types.map = TypeOf<nav_msgs::OccupancyGrid>();
  types.base_command = TypeOf<geometry_msgs::Twist>();
  types.trajectory = TypeOf<trajectory_msgs::JointTrajectory>();
  types.gripper = TypeOf<Pr2GripperCommand>();
  types.trajectory_goal = TypeOf<FollowJointTrajectoryActionGoal>();
  types.gripper_goal = TypeOf<GripperCommandActionGoal>();
  return types;
}

}  // namespace hires_ros
