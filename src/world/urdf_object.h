#pragma once

#include <string>

#include "hires/world/world.h"
#include "world/resource_finder.h"
#include "world/sdf/load_notes.h"

namespace hires::world {

/// Reads a single-link object from a URDF. Friction is what base::ReadUrdfFriction finds, 1 where
/// there is none; URDF knows no restitution. Origin B is the link's frame.
/// @param notes  gets what is played otherwise than it is written.
/// @throws base::ConfigError naming file, element and remedy.
ObjectModel LoadUrdfObject(const std::string& path, const ResourceFinder& finder, LoadNotes* notes);

}  // namespace hires::world
