#pragma once

#include "cli/verbs/doctor/robot_needs.h"

namespace hires_ros {

/// As this program was built with them.
hires::cli::RobotMessageTypes MessageTypesOfRobot();

}  // namespace hires_ros
