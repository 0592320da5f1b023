#include "hires/skills/action_library.h"

namespace {

using namespace hires;

/// An action that needs nothing of the robot.
class Senseless : public skills::ActionLibrary {
 public:
  std::vector<skills::Action> Actions() const override {
    skills::Action action;
    action.spec.name = "do_nothing";
    action.make = [](const skills::SkillSet&, const base::ActionCall&) {
      return std::unique_ptr<skills::Skill>();
    };
    return {action};
  }
};

}  // namespace

HIRES_REGISTER_ACTIONS(Senseless)
