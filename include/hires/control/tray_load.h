#pragma once

#include <optional>
#include <vector>

#include "hires/navigation/braking.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::control {

/// What the robot knows to stand loose on its tray: whose origin lies over the tray's plate and
/// near its top. What a hand holds cannot fall from there.
/// @param seen  Whose objects the robot remembers.
std::vector<robot::SeenObject> OnTray(const robot::Robot& robot, const robot::Observation& seen);

/// How hard the base may brake with what stands on the tray. Nothing where that is not known: an
/// object of a model that the world does not have, or that could not stand; then the guard of the
/// base takes the worst.
/// @param has_eyes  The robot sees objects; else it is unknown what stands on the tray.
std::optional<navigation::BrakingLimits> BrakingFor(const robot::Robot& robot,
                                                    const world::World& world,
                                                    const robot::Observation& seen, bool has_eyes,
                                                    const navigation::BrakingParams& params);

}  // namespace hires::control
