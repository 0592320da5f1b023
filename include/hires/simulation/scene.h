#pragma once

#include <memory>
#include <string>

#include "hires/robot/robot_profile.h"
#include "hires/simulation/robot_clearance.h"
#include "hires/world/world.h"

namespace hires::simulation {

/// A constant world with a constant robot in it, shared by all simulators of it.
struct Scene {
  world::World world;
  robot::Robot robot;
  std::vector<geometry::Collision> robot_shapes_B;  ///< joints frozen in the driving posture
  RobotClearance clearance;
  geometry::Pose3 X_BO;  ///< where an object is put on the tray, in the base frame
};

/// @throws base::ConfigError if robot and profile do not fit.
std::shared_ptr<const Scene> MakeScene(world::World world, robot::Robot robot);

}  // namespace hires::simulation
