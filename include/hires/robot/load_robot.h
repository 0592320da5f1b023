#pragma once

#include <string>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// From a bare URDF (a path that ends in ".urdf", in either case) or from a profile.
/// @throws base::ConfigError as LoadRobotFromUrdf and LoadRobot.
Robot LoadAnyRobot(const std::string& path);

}  // namespace hires::robot
