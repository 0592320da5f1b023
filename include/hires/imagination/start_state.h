#pragma once

#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/geometry/pose.h"
#include "hires/robot/observation.h"
#include "hires/world/world.h"

namespace hires::imagination {

struct ImaginationSetup;

/// Where a rollout begins. It may come from symbols, from the translator, or from the final state
/// of a rollout of the step before (RolloutResult::final_world, final_robot).
struct StartState {
  world::WorldState world;
  robot::RobotState robot;
};

/// An object that stands at a place given in numbers.
struct PutObject {
  std::string object;
  std::string area;      ///< in whose frame the pose is given; empty: in the map
  geometry::Pose3 X_AO;  ///< of the object
};

/// What never moves in the world, also because it reaches into another thing of its file
/// (simulation::HoldWhatIsStuck), is put nowhere else: it would be there twice.
/// @throws base::ConfigError naming it and its line.
void RefuseFixed(const ImaginationSetup& setup, const std::string& object);

/// The robot with objects on its tray, and nothing else: the first in the middle, the next ones to
/// its right and left (the slots of the tray pick and place action, slot_distance apart), or where
/// there is room (simulation::FreeOnTray).
/// @throws base::ConfigError for an unknown object, more than three objects, a robot without a
/// tray, and as simulation::RefuseOffTray.
StartState StartOnTray(const ImaginationSetup& setup, const geometry::Pose2& X_MB,
                       const std::vector<std::string>& objects);

/// The same at an area. Loose objects of the world file stand where it says, unless they are named.
/// @throws base::ConfigError as StartOnTray, and for an unknown area.
StartState MakeStartState(const ImaginationSetup& setup, const std::string& area,
                          const std::vector<std::string>& objects);

/// From a projected symbolic state, as translation::StateOf reads it (RobotAt, HasArmPosture,
/// HasTorsoPosture, Holding, On), and objects at poses of their own. Objects of the world file
/// that neither names stand where it says.
/// @throws base::ConfigError naming the atom or object and what is wrong with it; of what is put on
/// the tray as simulation::RefuseOffTray.
StartState MakeStartState(const ImaginationSetup& setup, const std::vector<base::Atom>& atoms,
                          const std::vector<PutObject>& put = {});

}  // namespace hires::imagination
