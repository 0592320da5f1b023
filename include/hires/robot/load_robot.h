#pragma once

#include <string>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// From a bare URDF (a path that ends in ".urdf", in either case) or from a profile.
/// @throws base::ConfigError as LoadRobotFromUrdf and LoadRobot.
Robot LoadAnyRobot(const std::string& path);

/// The text of the URDF behind a robot's profile, or of the URDF that was loaded in place of one.
/// @param path  that the robot was loaded from.
/// @throws base::ConfigError if it cannot be read.
std::string ReadUrdfOf(const std::string& path, const RobotProfile& profile);

}  // namespace hires::robot
