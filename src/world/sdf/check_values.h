#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"

namespace hires::world {

/// Makes a problem, with line, of an element of SDF that should hold numbers, or <static>'s true or
/// false, and does not, and gives it another text so that nobody complains of it again. Commas
/// behind numbers become blanks. Which numbers make sense others say.
void CheckValueOf(tinyxml2::XMLElement* element, const std::string& path, LoadNotes* notes);

}  // namespace hires::world
