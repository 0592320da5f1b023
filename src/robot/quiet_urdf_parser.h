#pragma once

#include <urdf_world/types.h>

#include <string>

#include "robot/urdf/urdf_problems.h"

namespace hires::robot {

/// Parses a URDF with urdfdom, which prints its errors to the console and cannot be told not to:
/// they come back as one exception, its warnings go to base::Log. Safe to call from any thread.
/// `where` stands for the file in messages.
/// @throws base::ConfigError with `problems` and all that the parser complained about.
urdf::ModelInterfaceSharedPtr ParseUrdfQuietly(const std::string& xml, const std::string& where,
                                               UrdfProblems* problems);

}  // namespace hires::robot
