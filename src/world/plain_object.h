#pragma once

#include <string>

#include "hires/world/world.h"

namespace hires::world {

/// An object as a ruler and scales know it: a solid cylinder or box, one YAML with the keys `shape`
/// (cylinder, box), `radius` or `depth` and `width`, `height` [m], `mass` [kg]; and, if it is not
/// the shape's own, `com_height` [m] of its centre of mass over what it stands on, and `friction`
/// of its base, 1 if it is not named, and `liquid` (ReadLiquid). It is called as its file, and has
/// the solid's inertia about its centre of mass. Origin: middle of its base.
/// @throws base::ConfigError naming file and key.
ObjectModel LoadPlainObject(const std::string& path);

}  // namespace hires::world
