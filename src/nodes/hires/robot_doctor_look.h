#pragma once

#include "cli/verbs/doctor/robot_needs.h"
#include "cli/verbs/doctor/robot_view.h"

namespace hires_ros {

/// Listens for `seconds`.
/// @throws hires::base::ConfigError if no master answers.
hires::cli::RobotView LookAtRobot(double seconds, const hires::cli::RobotNeeds& needs);

}  // namespace hires_ros
