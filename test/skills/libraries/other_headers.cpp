#include "hires/skills/action_library.h"

namespace {

/// As if it had been built when an observation was smaller.
class Old : public hires::skills::ActionLibrary {
 public:
  std::vector<std::size_t> Layout() const override { return {8, 16}; }
  std::vector<hires::skills::Action> Actions() const override { return {}; }
};

}  // namespace

HIRES_REGISTER_ACTIONS(Old)
