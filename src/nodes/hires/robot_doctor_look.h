#pragma once

#include "hires/cli/doctor.h"
#include "nodes/hires/robot_doctor_view.h"

namespace hires_ros {

/// Listens for options.seconds.
/// @throws hires::base::ConfigError if no master answers.
RobotView LookAtRobot(const hires::cli::RobotDoctorOptions& options,
                      const hires::control::RobotNames& names);

}  // namespace hires_ros
