#include "hires/skills/skill_factory.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::skills {
namespace {

using base::ActionCall;

/// The value of a lower-case name, or an error that lists names like it.
template <typename T>
const T& Lookup(const std::map<std::string, T>& known, const char* kind, const std::string& name,
                const ActionCall& action) {
  const auto found = known.find(base::ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw base::ConfigError(
      fmt::format("action '{}': {}", base::ToString(action), base::UnknownName(kind, name, names)));
}

using Maker = std::unique_ptr<Skill> (*)(const SkillSet&, const ActionCall&);
struct Entry {
  std::vector<std::string> parameters;
  Maker make;
};

std::unique_ptr<Skill> MakeMoveBase(const SkillSet& skills, const ActionCall& action) {
  const std::string& motion_set =
      action.arguments.size() > 1 ? action.arguments[1] : skills.default_motion_set;
  return std::make_unique<MoveBase>(skills.driving,
                                    Lookup(skills.areas, "area", action.arguments[0], action),
                                    Lookup(skills.motion_sets, "motion set", motion_set, action));
}

std::unique_ptr<Skill> MakeMoveBaseBlind(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveBaseBlind>(
      skills.blind, Lookup(skills.areas, "area", action.arguments[0], action),
      Lookup(skills.motion_sets, "motion set", skills.default_motion_set, action));
}

const std::map<std::string, Entry>& Actions() {
  static const std::map<std::string, Entry> actions{
      {"move_base", {{"area"}, MakeMoveBase}},
      {"move_base_param", {{"area", "motion set"}, MakeMoveBase}},
      {"move_base_blind", {{"area"}, MakeMoveBaseBlind}},
  };
  return actions;
}

}  // namespace

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind) {
  SkillSet skills;
  skills.driving =
      std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, driving));
  skills.blind = blind;
  for (const auto& [name, X_MF] : world.frames) skills.areas[name] = geometry::Flatten(X_MF);
  skills.motion_sets = robot.profile.motion_sets;
  skills.default_motion_set = robot.profile.default_motion_set;
  return skills;
}

std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const ActionCall& action) {
  const Entry& entry = Lookup(Actions(), "action", action.name, action);
  if (action.arguments.size() != entry.parameters.size()) {
    throw base::ConfigError(fmt::format(
        "action '{}' has {} arguments, wanted {} ({})", base::ToString(action),
        action.arguments.size(), entry.parameters.size(), base::Join(entry.parameters, ", ")));
  }
  return entry.make(skills, action);
}

}  // namespace hires::skills
