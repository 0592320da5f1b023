#pragma once

#include <memory>

#include "hires/control/robot_names.h"
#include "hires/perception/warm_objects.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires_ros {

struct HeatReaderParams {
  hires::perception::WarmParams warm;                ///< config/heat_reader.yaml
  std::shared_ptr<const hires::robot::Robot> robot;  ///< whose own parts hide things
  std::shared_ptr<const hires::world::World> world;  ///< likewise, and the models of objects
  hires::control::RobotNames names;                  ///< with thermal_image and thermal_info
};

/// From the private parameters config, world, robot, objects, names, map_to_world.
/// @throws hires::base::ConfigError naming file and key; also where the names file has no thermal
/// camera.
HeatReaderParams LoadHeatReaderParams();

}  // namespace hires_ros
