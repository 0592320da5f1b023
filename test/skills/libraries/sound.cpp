#include "hires/base/error.h"
#include "hires/skills/action_library.h"

namespace {

using namespace hires;

/// Done at once; fails where its argument says so.
class Nod : public skills::Skill {
 public:
  skills::Status Update(const robot::Observation&, robot::Command*) override {
    return {skills::Progress::kSucceeded, {}};
  }
  double period() const override { return 0.125; }
};

class Gestures : public skills::ActionLibrary {
 public:
  std::vector<skills::Action> Actions() const override {
    actions::ActionSpec spec;
    spec.name = "nod";
    spec.parameters = {{"area", actions::ParameterKind::kArea}};
    spec.groups = {actions::kBaseGroup};
    return {{spec, [](const skills::SkillSet& skills, const base::ActionCall& call) {
               if (skills.areas.count(call.arguments[0]) == 0) {
                 throw base::ConfigError("area '" + call.arguments[0] + "' is unknown");
               }
               return std::make_unique<Nod>();
             }}};
  }
};

}  // namespace

HIRES_REGISTER_ACTIONS(Gestures)
