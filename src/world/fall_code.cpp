#include "hires/world/fall_code.h"

namespace hires::world {

using base::FailureCode;

FailureCode CodeOf(Fall fall, FallenThing thing) {
  if (fall == Fall::kNone) return FailureCode::kNone;
  if (fall == Fall::kLost) return FailureCode::kObjectLost;
  if (thing == FallenThing::kHeld) return FailureCode::kObjectSlipped;
  if (fall == Fall::kSlid) return FailureCode::kObjectSlid;
  const bool lies = fall == Fall::kToppled && thing == FallenThing::kHandled;
  return lies ? FailureCode::kObjectToppled : FailureCode::kObjectFell;
}

}  // namespace hires::world
