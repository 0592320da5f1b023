#pragma once

#include <urdf_model/model.h>

#include <string>

#include "hires/robot/robot_model.h"
#include "robot/urdf_outline.h"

namespace hires::robot {

/// Turns the parser's model into ours, reads its meshes and checks what the parser lets pass. The
/// hash is left at 0. `where` is the file's path, for messages and for relative meshes.
/// @throws base::ConfigError naming file, link or joint, line and remedy.
RobotModel ConvertUrdf(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
                       const std::string& where);

}  // namespace hires::robot
