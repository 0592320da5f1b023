#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/knowledge/fluent.h"
#include "hires/translation/classification.h"

namespace hires::translation {

/// What was observed. Of objects that are in neither list nothing is known beyond what the
/// Blackboard says.
struct ObservedWorld {
  GeometricState state;               ///< robot, and objects that were seen, in the map
  std::vector<std::string> vanished;  ///< looked for and not found where they were, lower case
  std::map<std::string, double> temperatures{};  ///< [degrees Celsius] last measured, by object
};

/// How much must change before it is said.
struct ChangeParams {
  double position{0.01};        ///< [m] of an object
  double angle{0.05};           ///< [rad]
  double robot_position{0.10};  ///< [m] of the base
  double robot_angle{0.10};     ///< [rad]
  double temperature{1.0};      ///< [K] of an object
};

/// The block `changes` of config/world_tracker.yaml.  @throws base::ConfigError naming the key.
ChangeParams ReadChangeParams(base::ParamReader in);
/// Models' concepts stand in the catalogue of objects alone.
/// @throws base::ConfigError for a file that still has a block `concepts`.
void RefuseConcepts(const base::ParamReader& in);

/// What the Blackboard must be told; empty lists: nothing new.
struct FluentUpdate {
  std::vector<knowledge::Fluent> added;    ///< whole fluents, new or instead of the old
  std::vector<knowledge::Fluent> updated;  ///< roles to be replaced in fluents that hold
  std::vector<std::string> removed;        ///< instances that hold no more

  bool empty() const { return added.empty() && updated.empty() && removed.empty(); }
};

/// The smallest change that makes the Blackboard say what was observed, as docs/ontology.md has it:
/// RobotAt, postures, Holding, On; Pose of the robot and of objects (in the frame of the palm of
/// what is held, in the base's of what stands on the tray, so that driving does not change them);
/// BoundingBox of objects; and the object itself where it is new, of the concept that the
/// catalogue names for its model (world::ObjectModel), else that of the model's name (wine_glass is
/// a WineGlass), else TabletopObject; where models of other concepts have the same form, the lowest
/// concept above them all, as nobody sees which of them it is; HasTemperature of objects that are
/// known. A vanished object has neither place nor pose any more.
/// @param said  what the Blackboard says now.
/// @pre the context has an ontology.
/// @throws base::ConfigError for an object that the ontology or the world does not know, a pose or
/// joint that is no number.
FluentUpdate ChangesFrom(const TranslatorContext& context, const knowledge::FluentView& said,
                         const ObservedWorld& observed, const ChangeParams& params = {});

}  // namespace hires::translation
