#pragma once

#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/rollout.h"
#include "hires/world/world.h"

namespace hires::imagination {

/// Warnings about hazards that rollouts do not play, or play from assumptions, one sentence each:
/// the robot's own tipping (masses and support), liquids of what it carries, static bodies that the
/// routes lead over, carts that it tows. @pre the setup was checked (CheckSetupForAll).
std::vector<std::string> HazardsOf(const RolloutSetup& setup,
                                   const std::vector<base::ActionCall>& actions);

/// "left out: liquids that slosh (...)", of a payload that may hold one which no file describes; ""
/// of others.
std::string UnknownLiquidText(const std::string& object, const world::ObjectModel& model);

/// [m/s^2] From which a sudden start makes a liquid reach its rim: g (rim - fill) / (2 R); a slow
/// one bears twice that (physics::SurfaceRise).
double SpillingAcceleration(const world::Liquid& liquid, double gravity);

}  // namespace hires::imagination
