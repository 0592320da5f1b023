#pragma once

#include "hires/robot/observation.h"
#include "hires/simulation/scene.h"
#include "hires/simulation/variation.h"

namespace hires::simulation {

/// A robot cannot stand where it touches the world: a `start_offset` that would put it there is
/// halved until it does not, eight times at most; then there is none. All else stays as drawn.
/// @param start  where the robot is thought to stand; its joints decide what it touches.
/// @throws base::ConfigError as FrozenShapes.
Variation WithFreeStart(Variation variation, const Scene& scene, const robot::RobotState& start);

}  // namespace hires::simulation
