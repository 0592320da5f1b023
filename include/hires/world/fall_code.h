#pragma once

#include "hires/base/failure.h"
#include "hires/world/standing.h"

namespace hires::world {

/// What fell, as far as its fall has another name then.
enum class FallenThing {
  kLoad,     ///< it stood on the robot
  kHandled,  ///< it was put down, or was to be taken
  kHeld      ///< it was in a hand
};

/// What a fall is called, in imagination and in truth. Nothing for Fall::kNone.
base::FailureCode CodeOf(Fall fall, FallenThing thing);

}  // namespace hires::world
