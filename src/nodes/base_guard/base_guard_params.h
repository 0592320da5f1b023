#pragma once

#include <string>

#include "hires/control/robot_names.h"
#include "hires/navigation/base_guard.h"

namespace hires_ros {

/// What the node `base_guard` goes by.
struct BaseGuardNodeParams {
  hires::navigation::BaseGuardParams guard;
  hires::control::RobotNames names;
  bool uses_move_base{false};  ///< the robot's own move_base drives: it is tuned and cancelled
  std::string journal;         ///< of the tuner; empty: its default
};

/// From ~config (config/base_guard.yaml where there is none), ~names, ~navigation ("own" or
/// "move_base") and ~journal. What the robot has by its names, it must tell.
/// @throws hires::base::ConfigError naming file or parameter.
BaseGuardNodeParams LoadBaseGuardParams();

}  // namespace hires_ros
