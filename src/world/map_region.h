#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "hires/world/world.h"

namespace hires::world {

/// [m] x and y that grids of a world cover, where it is so wide that they do not cover all of its
/// bodies: 50 m (in the widest 20 m) around all areas, as far as there is anything there that could
/// stand in a robot's way or bear it. Nothing: they cover all bodies, as in worlds of up to
/// 10,000 m^2 and in worlds without areas.
std::optional<Eigen::AlignedBox2d> MapRegion(const World& world);

/// Says in the notes of a world that its grids do not cover all of it, where that is so.
void NoteMapRegion(World* world);

}  // namespace hires::world
