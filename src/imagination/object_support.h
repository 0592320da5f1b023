#pragma once

#include <string>
#include <vector>

#include "hires/imagination/rollout.h"
#include "hires/world/world.h"

namespace hires::imagination {

/// Where things begin, they stand on the floor, on what stands or lies there, or on the robot, or
/// would fall and be told as knocked over. Whatever is round a place counts as bearing.
/// @param X_MB  where the robot begins, with all that is within `reach` [m] of it.
/// @return of each of these objects that nothing bears, how high it would hang, and over what, or
/// that it lies below the floor. What is held, or not in the state, is left out.
std::vector<std::string> WhyUnsupported(const std::vector<std::string>& objects,
                                        const world::WorldState& state, const world::World& world,
                                        const geometry::Pose2& X_MB, double reach);
/// The same where rollouts begin. @pre all of its objects have models.
std::vector<std::string> WhyUnsupported(const std::vector<std::string>& objects,
                                        const RolloutSetup& setup);

}  // namespace hires::imagination
