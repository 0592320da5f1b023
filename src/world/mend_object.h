#pragma once

#include <string>
#include <vector>

#include "hires/world/world.h"

namespace hires::world {

/// Gives an object whose inertia no body of its mass and shapes has (geometry::WhyImplausible), as
/// of a placeholder or of other units, that of the solid of its shapes.
/// @param is_said  whether its file says one.
/// @return what came and what was taken, for LoadNotes behind "model" or "link"; "" if it stays.
/// @pre it has shapes, and geometry::WhyUnphysical says nothing.
std::string MendInertia(bool is_said, ObjectModel* object);

/// What suggests that a file means other units, or another place of its mass: more mass than any
/// matter has in the box round its shapes, a centre of mass outside of that box. It stays as it is.
/// @return for LoadNotes behind "model" or "object".
std::vector<std::string> DoubtsOfMass(const ObjectModel& object);

/// That something to carry or to put somewhere is larger than 3 m; "" if it is not. For LoadNotes.
std::string DoubtOfSize(const ObjectModel& object);

/// [m] Over the origin, along its z axis; 0 without shapes.
double LowestOf(const ObjectModel& object);

/// Moves the origin to the height of the lowest point of its shapes, as a pose of an object is that
/// of the middle of its underside; one that is there already stays to the bit.
/// @return where it was, for LoadNotes behind "object", where that is more than 1 mm off; else "".
std::string PutOriginAtUnderside(ObjectModel* object);

}  // namespace hires::world
