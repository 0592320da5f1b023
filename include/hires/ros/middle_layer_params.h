#pragma once

#include "hires/imagination/imagination_setup.h"
#include "hires/ros/middle_layer_runner.h"
#include "hires/ros/middle_layer_scan.h"

namespace hires_ros {

struct MiddleLayerParams {
  hires::imagination::SetupConfig setup;
  RunnerParams runner;
  ScanParams scan;
  double start_patience{5.0};   ///< [s] by the wall's clock, that controllers and sensors may take
  double feedback_period{0.2};  ///< [s]
  bool lockstep{false};         ///< acknowledge every tick of a simulated robot
};

/// Reads a file like config/middle_layer.yaml.  @throws hires::base::ConfigError.
MiddleLayerParams ReadMiddleLayerParams(const std::string& path);

/// The file in ~config (config/middle_layer.yaml where there is none); ~world, ~robot, ~objects and
/// ~lockstep win over it.  @throws hires::base::ConfigError.
MiddleLayerParams LoadMiddleLayerParams();

}  // namespace hires_ros
