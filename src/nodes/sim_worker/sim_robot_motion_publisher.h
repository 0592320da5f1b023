#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "hires/control/robot_names.h"
#include "hires/robot/robot_profile.h"
#include "sim_robot/sim_robot_world.h"

namespace hires_ros {

/// Says how the simulated robot's base moves: its odometry, and of a robot that does not tell its
/// place what its inertial unit measures; such a one is told once where it starts, as by "2D Pose
/// Estimate" in RViz.
class SimRobotMotionPublisher {
 public:
  /// @param tells_place  the odometry is that of its localisation; else that of the wheels alone,
  ///                     in a frame of their own.
  SimRobotMotionPublisher(const hires::control::RobotNames& names, const hires::robot::Robot& robot,
                          bool tells_place, ros::NodeHandle* nh);

  void Publish(const hires::sim_robot::SensorReadings& readings, const ros::Time& stamp);

  /// Tells the start to whoever began to listen, while the robot stands there.
  void TellStart(const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp);

 private:
  std::string map_frame_, odometry_frame_, base_frame_, inertia_frame_;
  std::optional<Eigen::Quaterniond> R_BI_;  // of an inertial unit that is heard of
  ros::Publisher odometry_, inertia_, initial_pose_;
  std::uint32_t num_told_{0};  // listeners that know where it starts
};

}  // namespace hires_ros
