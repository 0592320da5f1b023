#pragma once

#include "hires/world/world.h"

namespace hires::simulation {

/// Loose things of a world's file that stand in one another, in what never moves or in the floor:
/// physics would throw them apart. Those that reach more than 2 cm deep into something stay where
/// the file has them, as obstacles; the others are moved out when a simulation begins, and out of
/// the floor from any depth. Each is said once, in world::World::notes and to base::Log, with
/// count, first place and depth.
/// @throws base::ConfigError of shapes that physics refuses.
world::World HoldWhatIsStuck(world::World world);

}  // namespace hires::simulation
