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

/// Refuses a thing that is to begin on the tray and would not: its place lies beside the plate, or
/// farther above or below its top than what settles onto it, or the plate is tilted so that
/// nothing begins at rest on it. What begins on another part of the robot is left alone.
/// @throws base::ConfigError naming the thing, `object_on_tray`, the plate, what came and is
/// wanted.
void RefuseOffTray(const Scene& scene, const robot::RobotState& start,
                   const world::ObjectState& object);

}  // namespace hires::simulation
