#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"

namespace hires::world {

/// Makes a problem, with line, of an element of SDF that should hold numbers and does not, and
/// empties it so that nobody complains of it again. Which numbers make sense others say.
void CheckNumbersOf(tinyxml2::XMLElement* element, const std::string& path, LoadNotes* notes);

}  // namespace hires::world
