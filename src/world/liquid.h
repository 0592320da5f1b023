#pragma once

#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/world/world.h"

namespace hires::world {

/// Reads the map `liquid: {radius, fill, rim}` [m].
/// @throws base::ConfigError naming file, line, key, value and range: all three keys are needed,
/// radius within 1 mm .. 10 m, rim likewise, 0 < fill <= rim.
Liquid ReadLiquid(base::ParamReader in);

/// Whether it may hold a liquid that no file describes: by its concept or name (mug, glass, bottle,
/// ...), or because no concept says what it is and it is round.
bool MayHoldUnknownLiquid(const ObjectModel& model);

}  // namespace hires::world
