#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"

namespace hires::world {

/// Says what the <state> of a world has otherwise than its models are written: a world that was
/// saved while it ran may have them elsewhere, or larger.
void NoteState(const tinyxml2::XMLElement& state, const tinyxml2::XMLElement& world,
               const std::string& path, LoadNotes* notes);

}  // namespace hires::world
