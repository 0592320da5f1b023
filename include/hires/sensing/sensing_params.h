#pragma once

#include "hires/sensing/ground_watch.h"
#include "hires/sensing/object_memory.h"
#include "hires/sensing/robot_state_estimator.h"

namespace hires::base {
class ParamReader;
}  // namespace hires::base

namespace hires::sensing {

/// How robot and objects are sensed: one block of config/scene.yaml for tracker, middle layer and
/// rollouts.
struct SensingParams {
  StateParams robot_state;
  MemoryParams memory;
  GroundWatchParams ground;
  bool operator==(const SensingParams& other) const {
    return robot_state == other.robot_state && memory == other.memory && ground == other.ground;
  }
};

/// @throws base::ConfigError naming file, key and line.
SensingParams ReadSensingParams(base::ParamReader in);

}  // namespace hires::sensing
