#pragma once

#include <optional>
#include <vector>

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

struct TrayPlace {
  geometry::Pose3 X_MO;
  /// False: the plate ends nearer to its middle than half of its own half width, so that it may
  /// fall by itself.
  bool is_carried{true};
};

/// Where a thing begins on the tray beside others: at its own place, if it is free there and
/// carried; else, as it is turned, at the place nearest to object_on_tray that carries all of it
/// and has 1 cm of room; else at its own place, if that is free. Nothing where there is none, or no
/// plate.
std::optional<TrayPlace> FreeOnTray(const Scene& scene, const robot::RobotState& start,
                                    const world::ObjectState& object,
                                    const std::vector<world::ObjectState>& others);

}  // namespace hires::simulation
