#pragma once

#include <optional>
#include <string>

#include "hires/base/param_reader.h"
#include "hires/control/move_base_drive.h"
#include "hires/control/robot_names.h"

namespace hires::control {

/// Reads the section `navigation` of config/middle_layer.yaml.
/// @param by  "own" or "move_base", wins over the file; nothing: as the file says.
/// @throws base::ConfigError naming file and key, or ~navigation.
MoveBaseDriveParams ReadNavigation(base::ParamReader in, std::optional<std::string> by);

/// move_base is driven by only with a guard, who brings the motion set to its planner and has it
/// stop, and only where the robot has one.
/// @throws base::ConfigError saying what is missing and what to do.
void RequireMeansFor(const MoveBaseDriveParams& navigation, const RobotNames& names,
                     bool is_guard_there);

}  // namespace hires::control
