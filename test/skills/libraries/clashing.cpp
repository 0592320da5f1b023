#include "hires/skills/action_library.h"

namespace {

using namespace hires;

class Clash : public skills::ActionLibrary {
 public:
  std::vector<skills::Action> Actions() const override {
    const auto make = [](const skills::SkillSet&, const base::ActionCall&) {
      return std::unique_ptr<skills::Skill>();
    };
    return {{actions::OwnActions().Get("move_base"), make}};
  }
};

}  // namespace

HIRES_REGISTER_ACTIONS(Clash)
