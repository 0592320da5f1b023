#pragma once

#include <cstdint>
#include <optional>

#include "hires/control/robot_names.h"
#include "hires/localisation/monte_carlo_params.h"
#include "hires/world/occupancy_grid.h"
#include "nodes/localisation/pose_keeper.h"

namespace hires_ros {

struct LocalisationNodeParams {
  hires::localisation::LocalisationConfig config;  ///< config/localisation.yaml
  hires::control::RobotNames names;                ///< with base_scan
  std::uint64_t seed{1};                           ///< of all chance
  std::optional<hires::world::OccupancyGrid> map;  ///< of ~map_file; nothing: it comes by topic
  bool is_start_given{false};     ///< by a private parameter, not by the file alone
  std::optional<KeptPlace> kept;  ///< by a process of this name before
};

/// From the private parameters config, names, seed, map_file; initial_pose_x, _y, _a and
/// initial_cov_xx, _yy, _aa win over the file, and with them KeptKeys().
/// @throws hires::base::ConfigError naming file and key; also where the names file has no laser,
/// and for a map that tells no place.
LocalisationNodeParams LoadLocalisationNodeParams();

}  // namespace hires_ros
