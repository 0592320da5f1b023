#pragma once

#include "hires/base/failure.h"

namespace hires::base {

/// Whether a code says what became of things (1 .. 99), and not of the robot, its way or the plan.
bool IsOfThings(FailureCode code);

}  // namespace hires::base
