#pragma once

#include <cstdint>
#include <vector>

#include "manipulation/motion_check.h"

namespace hires::manipulation {

/// Points of a free way through joint space from `start` to one of `goals` by OMPL's RRT-Connect,
/// simplified; empty if none was found within params.max_iterations.
/// @pre start and goals are free and within the limits.
std::vector<ArmJoints> PlanByRrtConnect(const MotionCheck& check, const ArmKinematics& kinematics,
                                        const ArmJoints& start, const std::vector<ArmJoints>& goals,
                                        std::uint64_t seed, const ArmPathParams& params);

}  // namespace hires::manipulation
