#pragma once

#include "hires/control/robot_names.h"

namespace hires_ros {

/// The file in ~names (config/robots/pr2_names.yaml where there is none or it is empty), and
/// ~map_to_world ("x y yaw scale"; the identity where there is none).
/// @throws hires::base::ConfigError as control::ReadRobotNames.
hires::control::RobotNames LoadRobotNames();

}  // namespace hires_ros
