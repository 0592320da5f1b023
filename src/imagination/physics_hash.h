#pragma once

#include <cstdint>

#include "hires/imagination/rollout.h"
#include "hires/physics/physics_world.h"
#include "hires/world/standing.h"

namespace hires::imagination {

/// Of what decides, beside world, robot and uncertainty, how a rollout goes and how it is judged.
/// A worker and who asks it compare it, so that both mean the same by a fall.
std::uint64_t PhysicsHash(const physics::PhysicsParams& physics, const RolloutParams& rollout,
                          const world::StandingCriterion& standing);

}  // namespace hires::imagination
