#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/observation.h"
#include "hires/robot/readings.h"
#include "hires/robot/robot_profile.h"

/// A robot's sensors and controllers as messages. What came and makes no sense is a
/// hires::base::ConfigError naming topic and field.
namespace hires_ros {

geometry_msgs::Twist ToMsg(const hires::geometry::Twist2& V_B);
/// @throws ConfigError for a number that is not finite.
hires::geometry::Twist2 FromMsg(const geometry_msgs::Twist& twist, const std::string& where);

trajectory_msgs::JointTrajectory ToMsg(const hires::robot::JointTrajectory& trajectory);
/// @throws ConfigError: no joints or points, a joint that is none of `known` or comes twice, a
/// point with another number of positions or velocities (none is allowed), times that do not ascend
/// from 0 on, numbers that are not finite.
hires::robot::JointTrajectory FromMsg(const trajectory_msgs::JointTrajectory& msg,
                                      const std::vector<std::string>& known,
                                      const std::string& where);

hires::robot::JointReading FromMsg(const sensor_msgs::JointState& msg);
sensor_msgs::JointState ToMsg(const hires::robot::JointReading& joints, const ros::Time& stamp);

hires::robot::OdometryReading FromMsg(const nav_msgs::Odometry& msg);

/// Where each link hangs, joints as they are said; the base's own pose in the map left out.
std::vector<geometry_msgs::TransformStamped> LinkTransforms(
    const hires::robot::Robot& robot, const hires::robot::JointPositions& joints,
    const ros::Time& stamp);

geometry_msgs::TransformStamped MakeTransform(const std::string& parent, const std::string& child,
                                              const hires::geometry::Pose3& X_PC,
                                              const ros::Time& stamp);

}  // namespace hires_ros
