#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"

namespace hires::world {

/// Infinite and negative coefficients of ODE, which files mean alike, become base::kNoSlip. What is
/// not played is said: friction of <bullet> that differs from ODE's, and <torsional> friction.
void MendFriction(tinyxml2::XMLElement* collision, const std::string& path, LoadNotes* notes);

}  // namespace hires::world
