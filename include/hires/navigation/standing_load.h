#pragma once

#include "hires/navigation/braking.h"
#include "hires/world/world.h"

namespace hires::navigation {

/// A model of the catalogue, standing as it is modelled. Its base is what lies within 1 mm of its
/// lowest point.  @throws base::ConfigError if its centre of mass is not over its base: it cannot
/// stand.
StandingLoad LoadOf(const world::ObjectModel& model);

}  // namespace hires::navigation
