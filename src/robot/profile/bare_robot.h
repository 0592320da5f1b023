#pragma once

#include <string>

#include "hires/robot/robot_profile.h"
#include "robot/urdf/urdf_file.h"

namespace hires::robot {

/// As LoadRobotFromUrdf, for a profile that is written: its footprint is empty where no shape gives
/// one, and then nothing is said of what else is assumed.
/// @param xml  text of that file.  @throws base::ConfigError as LoadRobotModel.
Robot LoadRobotToDescribe(const UrdfFile& file, const std::string& xml);

}  // namespace hires::robot
