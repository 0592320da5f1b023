#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"

namespace hires::robot {

/// Base in the frame of the odometry, and its velocity in the base frame.
struct OdometryReading {
  geometry::Pose2 X_OB;
  geometry::Twist2 V_B;
};

/// Where joints are and how fast; velocities may be missing.
struct JointReading {
  JointPositions positions, velocities;
};

/// What an inertial unit measures of a base that stays level, in the base frame.
struct ImuReading {
  double yaw{0.0};       ///< [rad] integrated by the unit; its zero is arbitrary
  double yaw_rate{0.0};  ///< [rad/s]
};

/// A planar laser scan in the laser's frame.
struct ScanReading {
  double angle_min{0.0};        ///< [rad]
  double angle_increment{0.0};  ///< [rad]; negative where the laser hangs upside down
  double range_min{0.0};        ///< [m] shorter ones are no measurement
  std::vector<float> ranges;    ///< [m]
  double range_max{0.0};        ///< [m] what is as long or longer met nothing; 0: nobody said
};

/// A scan, and where the robot was by its odometry when it was taken.
struct PlacedScan {
  ScanReading reading;
  geometry::Pose2 X_OB;  ///< base in the frame of the odometry
  geometry::Pose2 X_BL;  ///< laser in the base
  /// [m] Where earlier scans showed something and this one does not look (ScanMemory); odometry.
  std::vector<Eigen::Vector2d> out_of_view_O;
};

}  // namespace hires::robot
