#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// Names of motion sets, the most cautious first: by maximum linear velocity, then linear
/// acceleration, angular velocity, angular acceleration, name.
std::vector<std::string> MostCautiousFirst(const std::map<std::string, MotionSet>& sets);

}  // namespace hires::robot
