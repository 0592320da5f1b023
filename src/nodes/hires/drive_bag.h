#pragma once

#include <string>

#include "hires/localisation/robot_log.h"
#include "hires/sensing/drive_builder.h"

namespace hires_ros {

/// A drive that was recorded by `rosbag record`: scans (sensor_msgs/LaserScan, or
/// sensor_msgs/MultiEchoLaserScan, of which each beam's nearest echo counts), odometry
/// (nav_msgs/Odometry, or /tf), the inertial unit that `source` names (sensor_msgs/Imu), and where
/// laser and unit are (/tf, /tf_static). What it takes of them says hires::sensing::DriveBuilder.
/// @throws hires::base::ConfigError naming the bag and what to do: no such bag, one without index
/// or broken, no topic or several that could be meant, another type, and as DriveBuilder.
hires::localisation::RobotLog ReadDriveBag(const std::string& path,
                                           const hires::sensing::DriveSource& source);

}  // namespace hires_ros
