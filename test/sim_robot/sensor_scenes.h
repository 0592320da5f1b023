#pragma once

#include <memory>
#include <string>

#include "sim_robot/sim_robot_world.h"
#include "support/scenes.h"

/// A PR2 and what its sensors look at.
namespace hires::test_support {

/// Room's walls from x -4 to 3 m, and a plate of 0.5 x 0.4 m that hangs in the air 2 m before the
/// origin, across x. The mill and the tower may stand about.
inline world::World PlateRoom() {
  world::World room = Room();
  room.statics = {Block("east_wall", {0.1, 8.0, 3.0}, {3.05, 0.0, 1.5}),
                  Block("west_wall", {0.1, 8.0, 3.0}, {-4.05, 0.0, 1.5}),
                  Block("plate", {0.002, 0.5, 0.4}, {2.0, 0.1, 1.3})};
  room.hash = room.ComputeHash();
  return room;
}

/// A PR2 in PlateRoom for which `uncertainty` is uncertain.
inline imagination::ImaginationSetup PlateSetup(const std::string& uncertainty = "none") {
  static const auto scene = simulation::MakeScene(
      PlateRoom(), robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  imagination::ImaginationSetup setup;
  setup.scene = scene;
  setup.uncertainty = std::make_shared<const imagination::Uncertainty>(
      imagination::UncertaintyFromText(uncertainty, "test"));
  return setup;
}

/// At the origin, looking ahead, a tower on the floor 1.8 m before it and 0.5 m to its right, and a
/// mill on its tray.
inline imagination::StartState PlateStart() {
  imagination::StartState start;
  start.robot.joints["head_tilt_joint"] = 0.1;
  world::ObjectState tower, mill;
  tower.name = "tower1";
  tower.model = "tower";
  tower.X_MO.translation = {1.8, -0.5, 0.0002};
  mill.name = "mill1";
  mill.model = "mill";
  mill.X_MO = PlateSetup().scene->X_BO;
  start.world.objects = {tower, mill};
  return start;
}

}  // namespace hires::test_support
