#include <stdexcept>

#include "hires/skills/action_library.h"

namespace {

class Throwing : public hires::skills::ActionLibrary {
 public:
  std::vector<hires::skills::Action> Actions() const override {
    throw std::runtime_error("the licence server is away");
  }
};

}  // namespace

HIRES_REGISTER_ACTIONS(Throwing)
