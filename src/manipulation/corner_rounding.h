#pragma once

#include <vector>

#include "manipulation/motion_check.h"

namespace hires::manipulation {

/// The path with its corners rounded by parabolas, as wide as is free and leaves room for the next
/// corner, so that they can be driven through instead of stopped at. Corners without room stay.
/// @pre the path is free.
std::vector<ArmJoints> RoundCorners(const MotionCheck& check, const std::vector<ArmJoints>& path);

}  // namespace hires::manipulation
