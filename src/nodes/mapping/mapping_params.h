#pragma once

#include <string>

#include "hires/control/robot_names.h"
#include "hires/mapping/mapping_config.h"

namespace hires_ros {

struct MappingNodeParams {
  hires::mapping::MappingConfig config;  ///< config/mapping.yaml
  hires::control::RobotNames names;      ///< with base_scan
  std::string map_file;                  ///< what save_map writes; empty: nothing
};

/// From the private parameters config, names, map_file.
/// @throws hires::base::ConfigError naming file and key; also where the names file has no laser.
MappingNodeParams LoadMappingNodeParams();

}  // namespace hires_ros
