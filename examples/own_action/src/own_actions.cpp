// What this package brings along: one action, what it is and how it is made.
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/action_library.h"
#include "turn_towards.h"

namespace own_action {
namespace {

using hires::base::ActionCall;
using hires::skills::Skill;
using hires::skills::SkillSet;

hires::actions::ActionSpec TurnTowardsSpec() {
  using hires::actions::ParameterKind;
  hires::actions::ActionSpec spec;
  spec.name = "turn_towards";
  spec.parameters = {{"area", ParameterKind::kArea}, {"motion_set", ParameterKind::kMotionSet}};
  spec.detail = hires::actions::Detail::kBase;
  spec.groups = {hires::actions::kBaseGroup};
  spec.driving = hires::actions::Driving::kOwnWay;
  spec.failures = {hires::base::FailureCode::kStuck};
  return spec;
}

/// The value of a name, or an error that lists names like it.
template <typename T>
const T& Lookup(const std::map<std::string, T>& known, const char* kind, const std::string& name) {
  const auto found = known.find(hires::base::ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw hires::base::ConfigError(hires::base::UnknownName(kind, name, names));
}

std::unique_ptr<Skill> MakeTurnTowards(const SkillSet& skills, const ActionCall& call) {
  return std::make_unique<TurnTowards>(Lookup(skills.areas, "area", call.arguments[0]).position(),
                                       Lookup(skills.motion_sets, "motion set", call.arguments[1]));
}

class OwnActions : public hires::skills::ActionLibrary {
 public:
  std::vector<hires::skills::Action> Actions() const override {
    return {{TurnTowardsSpec(), MakeTurnTowards}};
  }
};

}  // namespace
}  // namespace own_action

HIRES_REGISTER_ACTIONS(own_action::OwnActions)
