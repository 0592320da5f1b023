#pragma once

#include <hires/RobotState.h>
#include <hires/WorldState.h>

#include "hires/world/world.h"

/// Every float64 survives both ways bit for bit.
namespace hires_ros {

namespace msg = ::hires;

msg::WorldState ToMsg(const hires::world::WorldState& state);
hires::world::WorldState FromMsg(const msg::WorldState& state);

/// What FromMsg would drop or read as something else: poses in another frame than map, a velocity,
/// heading or joint that is no number. @throws hires::base::ConfigError naming the field.
void RequireSoundState(const msg::WorldState& world, const msg::RobotState& robot);

}  // namespace hires_ros
