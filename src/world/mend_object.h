#pragma once

#include <string>

#include "hires/world/world.h"

namespace hires::world {

/// Gives an object whose inertia no body of its mass and shapes has (geometry::WhyImplausible), as
/// of a placeholder or of other units, that of the solid of its shapes.
/// @return what came and what was taken, for LoadNotes behind "model" or "link"; "" if it stays.
/// @pre it has shapes, and geometry::WhyUnphysical says nothing.
std::string MendInertia(ObjectModel* object);

}  // namespace hires::world
