#pragma once

#include <string>

#include "hires/localisation/robot_log.h"

namespace hires::cli {

/// A CARMEN log with at least one scan.
/// @throws base::ConfigError as localisation::ReadCarmenLog, and for bags and logs without scans.
localisation::RobotLog ReadDrive(const std::string& log);

}  // namespace hires::cli
