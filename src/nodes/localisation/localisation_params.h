#pragma once

#include <cstdint>

#include "hires/control/robot_names.h"
#include "hires/localisation/monte_carlo_params.h"

namespace hires_ros {

struct LocalisationNodeParams {
  hires::localisation::LocalisationConfig config;  ///< config/localisation.yaml
  hires::control::RobotNames names;                ///< with base_scan
  std::uint64_t seed{1};                           ///< of all chance
};

/// From the private parameters config, names, seed.
/// @throws hires::base::ConfigError naming file and key; also where the names file has no laser.
LocalisationNodeParams LoadLocalisationNodeParams();

}  // namespace hires_ros
