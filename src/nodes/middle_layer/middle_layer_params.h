#pragma once

#include "hires/control/action_runner.h"
#include "hires/control/move_base_params.h"
#include "hires/control/override_watch.h"
#include "hires/control/robot_names.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/navigation/braking.h"
#include "hires/sensing/scan_obstacles.h"

namespace hires_ros {

/// The process between the skills and the base, and what it is told.
struct GuardParams {
  bool is_there{false};  ///< velocities go to the guard, and only with its permission
  double request_period{
      0.03};  ///< [s] between two requests for permission; the guard waits for 0.1 s
  hires::navigation::BrakingParams braking;  ///< the guard's, so that both think the same
};

struct MiddleLayerParams {
  hires::imagination::SetupConfig setup;
  hires::control::RobotNames names;
  hires::control::RunnerParams runner;
  hires::sensing::ScanParams scan;
  GuardParams guard;
  hires::control::OverrideParams override;
  hires::control::MoveBaseDriveParams navigation;
  double start_patience{5.0};   ///< [s] by the wall's clock, that controllers and sensors may take
  double feedback_period{0.2};  ///< [s]
  bool lockstep{false};         ///< acknowledge every tick of a simulated robot
  bool dry_run{false};          ///< no controller is told anything, and every goal is refused
};

/// Reads a file like config/middle_layer.yaml; it does not say the names.  @throws
/// hires::base::ConfigError.
MiddleLayerParams ReadMiddleLayerParams(const std::string& path);

/// The file in ~config (config/middle_layer.yaml where there is none); ~world, ~robot, ~objects,
/// ~guard, ~navigation, ~lockstep and ~dry_run win over it. Names as LoadRobotNames.  @throws
/// hires::base::ConfigError.
MiddleLayerParams LoadMiddleLayerParams();

}  // namespace hires_ros
