#include "hires/skills/skill_factory.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/look_skills.h"
#include "hires/skills/object_skills.h"
#include "hires/skills/posture_skills.h"

namespace hires::skills {
namespace {

using base::ActionCall;
using Arguments = std::vector<std::string>;

/// The value of a lower-case name, or an error that lists names like it.
template <typename T>
const T& Lookup(const std::map<std::string, T>& known, const char* kind, const std::string& name) {
  const auto found = known.find(base::ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName(kind, name, names));
}

using Maker = std::unique_ptr<Skill> (*)(const SkillSet&, const ActionCall&);
struct Entry {
  std::vector<std::string> parameters;
  NeededDetail detail;
  Maker make;
};

std::unique_ptr<Skill> MakeMoveBase(const SkillSet& skills, const ActionCall& action) {
  const std::string& motion_set =
      action.arguments.size() > 1 ? action.arguments[1] : skills.default_motion_set;
  return std::make_unique<MoveBase>(skills.driving,
                                    Lookup(skills.areas, "area", action.arguments[0]),
                                    Lookup(skills.motion_sets, "motion set", motion_set));
}

std::unique_ptr<Skill> MakeMoveBaseBlind(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveBaseBlind>(
      skills.blind, Lookup(skills.areas, "area", action.arguments[0]),
      Lookup(skills.motion_sets, "motion set", skills.default_motion_set));
}

std::unique_ptr<Skill> MakeMoveTorso(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveTorso>(skills.manipulation, action, action.arguments[0]);
}

std::unique_ptr<Skill> MakeTuckArms(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<TuckArms>(skills.manipulation, action, action.arguments[0],
                                    action.arguments[1]);
}

std::unique_ptr<Skill> MakeMoveArmToSide(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveArmToSide>(skills.manipulation, action, action.arguments[0]);
}

std::unique_ptr<Skill> MakeMoveArmsToCarry(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveArmsToCarryPosture>(skills.manipulation, action);
}

std::unique_ptr<Skill> MakeLookAt(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<LookAt>(skills.manipulation, action.arguments[0]);
}

std::unique_ptr<Skill> MakeObserve(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<ObserveObjectsOnArea>(skills.manipulation, action.arguments[0]);
}

std::unique_ptr<Skill> MakePickUp(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PickUpObject>(skills.manipulation, action, action.arguments[0],
                                        action.arguments[1], PickUpObject::From::kFurniture);
}

std::unique_ptr<Skill> MakePlace(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PlaceObject>(skills.manipulation, action, action.arguments[0],
                                       action.arguments[1], action.arguments[2]);
}

std::unique_ptr<Skill> MakePlaceOnTray(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PlaceObject>(skills.manipulation, action, action.arguments[1],
                                       action.arguments[0]);
}

std::unique_ptr<Skill> MakePickUpFromTray(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PickUpObject>(skills.manipulation, action, action.arguments[1],
                                        action.arguments[0], PickUpObject::From::kTray);
}

const std::map<std::string, Entry>& Actions() {
  constexpr NeededDetail kBase = NeededDetail::kBase, kUpperBody = NeededDetail::kUpperBody;
  static const std::map<std::string, Entry> actions{
      {"move_base", {{"area"}, kBase, MakeMoveBase}},
      {"move_base_param", {{"area", "motion set"}, kBase, MakeMoveBase}},
      {"move_base_blind", {{"area"}, kBase, MakeMoveBaseBlind}},
      {"move_torso", {{"posture"}, kUpperBody, MakeMoveTorso}},
      {"tuck_arms", {{"left goal", "right goal"}, kUpperBody, MakeTuckArms}},
      {"move_arm_to_side", {{"arm"}, kUpperBody, MakeMoveArmToSide}},
      {"move_arms_to_carryposture", {{}, kUpperBody, MakeMoveArmsToCarry}},
      {"look_at", {{"area or object"}, kUpperBody, MakeLookAt}},
      {"observe_objects_on_area", {{"area"}, kUpperBody, MakeObserve}},
      {"pick_up_object", {{"object", "arm"}, kUpperBody, MakePickUp}},
      {"place_object", {{"object", "arm", "area"}, kUpperBody, MakePlace}},
      {"place_on_tray", {{"arm", "object"}, kUpperBody, MakePlaceOnTray}},
      {"pick_up_from_tray", {{"arm", "object"}, kUpperBody, MakePickUpFromTray}},
  };
  return actions;
}

std::unique_ptr<Skill> Make(const SkillSet& skills, const ActionCall& action) {
  const Entry& entry = Lookup(Actions(), "action", action.name);
  const Arguments& wanted = entry.parameters;
  if (action.arguments.size() != wanted.size()) {
    throw base::ConfigError(fmt::format("has {} arguments, wanted {} ({})", action.arguments.size(),
                                        wanted.size(),
                                        wanted.empty() ? "none" : base::Join(wanted, ", ")));
  }
  if (entry.detail == NeededDetail::kUpperBody && skills.manipulation == nullptr) {
    throw base::ConfigError(
        fmt::format("robot '{}' has no upper body that could do it; describe one in its profile, "
                    "key upper_body",
                    skills.robot_name));
  }
  return entry.make(skills, action);
}

}  // namespace

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind,
                      const ManipulationParams& manipulation) {
  SkillSet skills;
  skills.driving =
      std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, driving));
  skills.blind = blind;
  for (const auto& [name, X_MF] : world.frames) skills.areas[name] = geometry::Flatten(X_MF);
  skills.motion_sets = robot.profile.motion_sets;
  skills.default_motion_set = robot.profile.default_motion_set;
  skills.robot_name = robot.model.name;
  if (robot.profile.upper_body) {
    skills.manipulation =
        MakeManipulationContext(std::make_shared<const world::World>(world),
                                std::make_shared<const robot::Robot>(robot), manipulation);
  }
  return skills;
}

std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const ActionCall& action) {
  try {
    return Make(skills, action);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("action '{}': {}", base::ToString(action), error.what()));
  }
}

NeededDetail DetailFor(const ActionCall& action) {
  return Lookup(Actions(), "action", action.name).detail;
}

}  // namespace hires::skills
