#pragma once

#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::translation {

/// What is needed to read symbols as geometry and back; constant.
struct TranslatorContext {
  std::shared_ptr<const world::World> world;  ///< areas are its frames
  std::shared_ptr<const robot::Robot> robot;
  std::map<std::string, std::string> object_models;  ///< instance (lower case) -> model
};

/// Where things are, in metres and radians.
struct GeometricState {
  world::WorldState world;
  robot::RobotState robot;
};

/// Symbols to geometry. `fluents` are what the robot knows (a projected view: poses of objects from
/// hasPose and Pose fluents, areas, postures), `atoms` say what holds in the state to be built:
/// RobotAt puts the base on its area, HasArmPosture and HasTorsoPosture set joints (an arm that
/// holds something takes the holding variant), Holding attaches an object to the palm as its last
/// observed grasp has it, or in the middle of the fingers at the grasp that the skill would take
/// first; On leaves an object where it was seen if that lies on the area, else puts it on the
/// area's middle; On(x, trayarea1) on the tray's next free slot. Objects that only fluents know
/// stay where they were seen.
/// @throws base::ConfigError naming the atom: unknown area, object, posture; RobotAt missing.
GeometricState StateOf(const TranslatorContext& context, const knowledge::FluentView& fluents,
                       const std::vector<base::Atom>& atoms);

struct ClassifyParams {
  double area_distance{0.25};        ///< [m] from an area's pose that counts as being there
  double area_yaw{0.35};             ///< [rad]
  double tucked_tolerance{0.1};      ///< [rad] sum over the arm's joints (PR2's tuck_arms)
  double posture_tolerance{0.3};     ///< [rad] likewise, other postures
  double torso_tolerance{0.02};      ///< [m]
  double placing_half_width{0.175};  ///< [m] of a placing area's square round its frame
  double placing_height{0.10};       ///< [m] above or below its frame
  double tray_height{0.05};          ///< [m] above the tray
  double lying_tilt{0.5};            ///< [rad] beyond which an object has fallen
};

/// Geometry to symbols: RobotAt (the nearest area within tolerance, else the floor area), postures
/// (armunnamedposture where none fits), Holding, On (placing areas and the tray; an object that
/// lies or stands elsewhere has none). Sorted as knowledge::StateAtoms.
std::vector<base::Atom> AtomsOf(const TranslatorContext& context, const GeometricState& state,
                                const ClassifyParams& params = {});

}  // namespace hires::translation
