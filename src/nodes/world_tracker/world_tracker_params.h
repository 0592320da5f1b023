#pragma once

#include <map>
#include <string>

#include "hires/ros/translator_params.h"
#include "hires/sensing/sensing_params.h"
#include "hires/translation/observed_fluents.h"

namespace hires_ros {

/// How the head looks around when no action needs it.
struct SweepParams {
  bool enabled{true};
  double range{3.2};      ///< [m] from the camera to what is worth looking at
  double period{4.0};     ///< [s] after which a place is looked at again
  double dwell{1.0};      ///< [s] that the head rests on a place: some looks
  double speed{1.0};      ///< [rad/s] of the head
  double hands_off{2.0};  ///< [s] after an action that uses the head
};

/// config/world_tracker.yaml.
struct WorldTrackerParams {
  TranslatorParams files;
  hires::sensing::SensingParams sensing;  ///< of the scene
  hires::translation::ClassifyParams classify;
  hires::translation::ChangeParams changes;
  std::map<std::string, std::string>
      concepts;  ///< model -> concept, for objects that are not in the Blackboard
  SweepParams sweep;
  double write_period{0.05};  ///< [s] between writes to the Blackboard
  /// Tells of known objects with looks alone, so that a node that waits for them after each look
  /// sees the same however messages interleave.
  bool lockstep{false};
};

/// @throws hires::base::ConfigError naming file and key.
WorldTrackerParams ReadWorldTrackerParams(const std::string& path);
/// From the private parameters config, world, robot, objects, sweep, lockstep, names.
WorldTrackerParams LoadWorldTrackerParams();

}  // namespace hires_ros
