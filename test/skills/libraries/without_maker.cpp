#include "hires/skills/action_library.h"

namespace {

using namespace hires;

class WithoutMaker : public skills::ActionLibrary {
 public:
  std::vector<skills::Action> Actions() const override {
    skills::Action action;
    action.spec.name = "bow";
    action.spec.groups = {actions::kBaseGroup};
    return {action};
  }
};

}  // namespace

HIRES_REGISTER_ACTIONS(WithoutMaker)
