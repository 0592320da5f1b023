#pragma once

#include <string>
#include <vector>

#include "hires/control/head_sweep.h"
#include "hires/ros/translation/translator_params.h"
#include "hires/sensing/floor_watch.h"
#include "hires/sensing/sensing_params.h"
#include "hires/translation/observed_fluents.h"

namespace hires_ros {

/// config/world_tracker.yaml.
struct WorldTrackerParams {
  TranslatorParams files;
  std::vector<std::string> action_libraries;  ///< with more actions: which of them use the head
  hires::sensing::SensingParams sensing;      ///< of the scene
  hires::translation::ChangeParams changes;
  hires::control::SweepParams sweep;
  hires::sensing::FloorWatchParams floor;
  double write_period{0.05};  ///< [s] between writes to the Blackboard
  /// Tells of known objects with looks alone, so that a node that waits for them after each look
  /// sees the same however messages interleave.
  bool lockstep{false};
};

/// @throws hires::base::ConfigError naming file and key.
WorldTrackerParams ReadWorldTrackerParams(const std::string& path);
/// From the private parameters config, world, robot, objects, sweep, lockstep, names,
/// action_libraries.
WorldTrackerParams LoadWorldTrackerParams();

}  // namespace hires_ros
