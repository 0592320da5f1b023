#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"

namespace hires::world {

/// Puts the collisions of a <link> as they can be read: those that nothing collides with go (a
/// <collide_bitmask> of 0, <collide_without_contact>), several shapes in one become as many, and
/// equal names are numbered. What goes or is doubtful is said.
void MendCollisions(tinyxml2::XMLElement* link, const std::string& path, LoadNotes* notes);

}  // namespace hires::world
