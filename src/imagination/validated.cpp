#include "hires/imagination/validated.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "hires/actions/catalogue.h"
#include "hires/base/text.h"
#include "imagination/hazards.h"
#include "imagination/purpose.h"
#include "imagination/rollout/rollout_start.h"
#include "imagination/uncertainty_layers.h"

namespace hires::imagination {
namespace {

using base::ActionCall;
using Sentences = std::vector<std::string>;

std::map<std::string, std::string> ReadPlaces(base::ParamReader in) {
  std::map<std::string, std::string> places;
  for (const std::string& name : in.Keys()) {
    std::string& where = places[base::ToLower(name)];
    where = in.GetString(name);
    if (where.empty()) in.Fail(name, "wanted where it was shown: a document and its section");
  }
  return places;
}

ValidatedLimit ReadLimit(base::ParamReader in) {
  ValidatedLimit limit;
  limit.at_most = in.Get("at_most", base::Between(0.0, 1e6));
  limit.where = in.GetString("where");
  if (limit.where.empty()) in.Fail("where", "wanted a document and its section");
  return limit;
}

std::string WordOf(simulation::LevelOfDetail level) {
  return level == simulation::LevelOfDetail::kTray ? "tray" : "planar";
}

std::string NamesIn(const std::map<std::string, std::string>& places) {
  std::vector<std::string> names;
  for (const auto& [name, where] : places) names.push_back(name);
  return base::Join(names, ", ");
}

/// What the robot carries at the start, and what an action takes or puts down: indices.
std::set<int> ObjectsOfConcern(const RolloutSetup& setup, const std::vector<ActionCall>& actions) {
  const simulation::RobotSimulator start(setup.scene, {}, setup.world_state, setup.robot_state,
                                         base::Rng(setup.seed), setup.physics,
                                         LevelFor(*setup.skills, actions.front()));
  std::set<int> concern(start.carried().begin(), start.carried().end());
  const actions::Catalogue& catalogue = setup.skills->actions->catalogue();
  std::set<std::string> handled;
  for (const ActionCall& action : actions) handled.insert(PurposeOf(catalogue, action).object);
  const auto& objects = setup.world_state.objects;
  for (int i = 0; i < static_cast<int>(objects.size()); ++i) {
    const bool is_handled = handled.count(base::ToLower(objects[i].name)) > 0;
    if (is_handled || !objects[i].attached_to.empty()) concern.insert(i);
  }
  return concern;
}

void AddObjects(const RolloutSetup& setup, const std::vector<ActionCall>& actions,
                const Validated& validated, Sentences* caveats) {
  for (const int i : ObjectsOfConcern(setup, actions)) {
    const world::ObjectState& object = setup.world_state.objects[i];
    if (validated.objects.count(base::ToLower(object.model)) > 0) continue;
    caveats->push_back(
        fmt::format("how {} (model {}) stands and falls was not validated; validated "
                    "are {}",
                    object.name, object.model, NamesIn(validated.objects)));
  }
}

void AddFloor(const RolloutSetup& setup, const ValidatedLimit& limit, Sentences* caveats) {
  const auto floor = setup.uncertainty->quantities.find("floor_roughness");
  if (floor == setup.uncertainty->quantities.end()) return;
  const double most = floor->second.Largest();
  if (most <= limit.at_most) return;
  caveats->push_back(fmt::format("the floor may be uneven by {} m, validated are up to {} m ({})",
                                 most, limit.at_most, limit.where));
}

/// The motion sets that driving actions name; the default one where they name none.
std::set<std::string> MotionSetsOf(const RolloutSetup& setup,
                                   const std::vector<ActionCall>& actions) {
  std::set<std::string> used;
  for (const ActionCall& action : actions) {
    const actions::ActionSpec& spec = skills::SpecOf(*setup.skills, action);
    if (spec.driving == actions::Driving::kNone) continue;
    const auto named = actions::ArgumentOf(spec, action, actions::ParameterKind::kMotionSet);
    used.insert(named.value_or(base::ToLower(setup.skills->default_motion_set)));
  }
  return used;
}

/// One sentence about all motion sets that go beyond the limit.
/// @param what  "drive", "turn".
void AddSpeed(const RolloutSetup& setup, const std::set<std::string>& motion_sets,
              double robot::MotionSet::*speed, const std::string& what, const std::string& unit,
              const ValidatedLimit& limit, Sentences* caveats) {
  std::vector<std::string> beyond;
  double highest = 0.0;
  for (const std::string& name : motion_sets) {
    const auto set = setup.skills->motion_sets.find(name);
    if (set == setup.skills->motion_sets.end() || set->second.*speed <= limit.at_most) continue;
    beyond.push_back(name);
    highest = std::max(highest, set->second.*speed);
  }
  if (beyond.empty()) return;
  const bool is_one = beyond.size() == 1;
  caveats->push_back(
      fmt::format("motion set{} {} {}{} at up to {} {}, validated are up to {} {} ({})",
                  is_one ? "" : "s", base::Join(beyond, ", "), what, is_one ? "s" : "", highest,
                  unit, limit.at_most, unit, limit.where));
}

void AddSpeeds(const RolloutSetup& setup, const std::vector<ActionCall>& actions,
               const Validated& validated, Sentences* caveats) {
  const std::set<std::string> used = MotionSetsOf(setup, actions);
  AddSpeed(setup, used, &robot::MotionSet::max_linear_velocity, "drive", "m/s",
           validated.linear_speed, caveats);
  AddSpeed(setup, used, &robot::MotionSet::max_angular_velocity, "turn", "rad/s",
           validated.angular_speed, caveats);
}

void AddLevels(const RolloutSetup& setup, const std::vector<ActionCall>& actions,
               const Validated& validated, Sentences* caveats) {
  std::set<std::string> levels;
  for (const ActionCall& action : actions) levels.insert(WordOf(LevelFor(*setup.skills, action)));
  for (const std::string& level : levels) {
    if (validated.levels.count(level) > 0) continue;
    caveats->push_back(fmt::format("level of detail {} was not validated; validated are {}", level,
                                   NamesIn(validated.levels)));
  }
}

/// Once for each kind.
void AddNotesOfObjects(const RolloutSetup& setup, Report* report) {
  std::set<std::string> told;
  for (const world::ObjectState& object : setup.world_state.objects) {
    const auto model = setup.scene->world.FindModel(object.model);
    if (model == nullptr || !told.insert(base::ToLower(object.model)).second) continue;
    report->caveats.insert(report->caveats.end(), model->notes.begin(), model->notes.end());
  }
}

}  // namespace

Validated ReadValidated(base::ParamReader in) {
  Validated validated;
  validated.objects = ReadPlaces(in.Sub("objects"));
  validated.floor_roughness = ReadLimit(in.Sub("floor_roughness"));
  validated.linear_speed = ReadLimit(in.Sub("linear_speed"));
  validated.angular_speed = ReadLimit(in.Sub("angular_speed"));
  base::ParamReader levels = in.Sub("levels");
  for (const std::string& level : levels.Keys()) {
    if (level != "tray" && level != "planar") {
      levels.Fail(level, base::UnknownName("level of detail", level, {"tray", "planar"}));
    }
  }
  validated.levels = ReadPlaces(levels);
  in.RejectUnknownKeys();
  return validated;
}

std::vector<std::string> CaveatsOf(const RolloutSetup& setup,
                                   const std::vector<ActionCall>& actions,
                                   const Validated& validated) {
  Sentences caveats;
  if (actions.empty()) return caveats;
  AddObjects(setup, actions, validated, &caveats);
  AddFloor(setup, validated.floor_roughness, &caveats);
  AddSpeeds(setup, actions, validated, &caveats);
  AddLevels(setup, actions, validated, &caveats);
  return caveats;
}

void AddCaveats(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                const Validated& validated, Report* report) {
  for (std::string& caveat : CaveatsOf(setup, actions, validated)) {
    report->caveats.push_back(std::move(caveat));
  }
  AddNotesOfObjects(setup, report);
  const bool drives = std::any_of(actions.begin(), actions.end(), [&](const ActionCall& action) {
    return skills::SpecOf(*setup.skills, action).driving != actions::Driving::kNone;
  });
  if (drives) {
    for (const std::string& note : setup.scene->world.notes) report->caveats.push_back(note);
    for (const std::string& text : setup.scene->robot.assumed)
      report->caveats.push_back("assumed of the robot, " + text);
  }
  for (std::string& text : HazardsOf(setup, actions)) report->caveats.push_back(std::move(text));
  const std::string certain = CertainText(*setup.uncertainty);
  if (!certain.empty()) report->caveats.push_back(certain);
}

}  // namespace hires::imagination
