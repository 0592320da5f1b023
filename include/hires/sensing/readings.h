#pragma once

#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"

namespace hires::sensing {

/// Base in the frame of the odometry, and its velocity in the base frame.
struct OdometryReading {
  geometry::Pose2 X_OB;
  geometry::Twist2 V_B;
};

/// Where joints are and how fast; velocities may be missing.
struct JointReading {
  robot::JointPositions positions, velocities;
};

}  // namespace hires::sensing
