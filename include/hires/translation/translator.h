#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/translation/areas.h"
#include "hires/translation/classify_params.h"
#include "hires/world/standing.h"
#include "hires/world/world.h"

namespace hires::translation {

/// What is needed to read symbols as geometry and back; constant.
struct TranslatorContext {
  std::shared_ptr<const world::World> world;
  std::shared_ptr<const robot::Robot> robot;
  std::map<std::string, std::string> object_models;     ///< instance (lower case) -> model
  std::shared_ptr<const knowledge::Ontology> ontology;  ///< null: fluents are not looked at
  Areas areas;
  world::StandingCriterion standing;  ///< what leans too far is on no area
  ClassifyParams classify;            ///< when a symbol holds
  double slot_distance{0.13};         ///< [m] between places on the tray

  /// The catalogue's, or that of its kin: an instance that differs from one of the catalogue in its
  /// number only (mug3 is what mug1 is), or a model by its own name, with or without a number.
  /// Empty: unknown.
  std::string FindModel(const std::string& instance) const;
  /// @throws base::ConfigError with the names that come near.
  std::string ModelOf(const std::string& instance) const;
};

/// The context of a world, a robot and a catalogue (world::LoadObjectCatalogue).
/// @param catalogue  added to the world's.
/// @param ontology  may be null.
TranslatorContext MakeContext(
    world::World world, robot::Robot robot,
    const std::map<std::string, std::shared_ptr<const world::ObjectModel>>& catalogue,
    std::shared_ptr<const knowledge::Ontology> ontology);

/// The context with what fluents say of areas, and of the boxes of things of unknown kind (concept
/// UnknownObject).  @pre it has an ontology.
TranslatorContext WithKnowledge(TranslatorContext context, const knowledge::FluentView& view);

/// Where fluents say that an object is.
struct StatedObject {
  std::string name;  ///< lower case
  std::string model;
  std::string link;  ///< of the robot, as the fluent spells it; empty: the map
  geometry::Pose3 X_LO;
};

/// Every loose object (a PassiveObject that is no part of the world and whose model is known) of
/// which fluents say where it is, by concept and instance. Empty without an ontology.
std::vector<StatedObject> StatedObjects(const TranslatorContext& context,
                                        const knowledge::FluentView& fluents);

/// Where things are, in metres and radians.
struct GeometricState {
  world::WorldState world;  ///< objects by name, in lower case
  robot::RobotState robot;
};

/// Symbols to geometry: `atoms` say what holds in the state to be built, `fluents` where things
/// were seen. Atoms that follow from knowledge (Type, Connected, At, ...) and wishes are passed
/// over.
///
/// RobotAt(area): the base stands where it was seen if that is at the area (anywhere in it, if it
/// is a room), else on its middle; in the middle of a room it turns so that it is at no other area.
/// HasArmPosture, HasTorsoPosture: the first variant of the posture; of an arm that holds something
/// the holding variant. `armunnamedposture` says that the arm is somewhere else: it is put into its
/// carrying posture, turned in the shoulder until that fits no name. `torsoposture` is a height
/// between two named ones. What no atom names stands as the robot's driving posture has it. Without
/// an upper body there is nothing to move.
/// Holding(arm, object): in the hand as it was seen there (a Pose in the frame of the palm); else
/// between the finger tips, upright and held at 0.4 of its height or, if the hand points down,
/// hanging from it by its uppermost 0.028 m, whichever leaves it more upright in this posture. The
/// gripper's gap is the object's width. On(object, area): where it was seen if that is on the area;
/// else on its middle, or beside it by as little as keeps it clear of the objects that are there.
/// On(object, trayarea1): where it was seen on the tray; else on the next free slot (middle, right,
/// left), or where there is room. Objects that only fluents know stay where they were seen
/// in the map; upright ones from 0.08 m below to 0.03 m above the top of furniture stand on it;
/// those whose last place was a part of the robot, which no atom confirms, are left out. Objects
/// that were seen in each other are parted, by the shortest way, where that moves none by more than
/// 0.06 m.
///
/// @param fluents  may be null: nothing was seen.
/// @throws base::ConfigError naming the atom: unknown area, object, posture or predicate, another
/// number of arguments, an area of the wrong kind, contradictions (two places of one object, two
/// objects in one hand), RobotAt missing, no room on the tray, no tray, no such arm.
GeometricState StateOf(const TranslatorContext& context, const knowledge::FluentView* fluents,
                       const std::vector<base::Atom>& atoms);

}  // namespace hires::translation
