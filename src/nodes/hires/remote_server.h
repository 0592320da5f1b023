#pragma once

#include <string>

namespace hires_ros {

constexpr double kPollPeriod = 0.02;  ///< [s] of the wall, between two looks whether an answer came

/// @param launch_file  of hires, that starts a master with what is to be asked.
/// @param otherwise  what else helps, after "or"; may be empty.
/// @throws hires::base::ConfigError if no ROS master answers.
void RequireMaster(const std::string& launch_file, const std::string& otherwise = "");

}  // namespace hires_ros
