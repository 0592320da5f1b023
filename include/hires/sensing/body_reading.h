#pragma once

#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"

namespace hires::sensing {

/// What the robot feels of itself at a moment.
struct BodyReading {
  double time{0.0};  ///< [s]
  geometry::Pose2 X_MB;
  robot::JointPositions joints;  ///< gripper joints are gaps [m]; finger angles agree with them
};

}  // namespace hires::sensing
