#pragma once

#include <optional>

#include "hires/world/occupancy_grid.h"

namespace hires::world {

/// Turns a grid about its lower left corner, counter-clockwise, as the yaw of a map's origin says
/// (RViz and map_server have it so). Quarters of a turn are exact; else the result is a grid of the
/// same resolution that covers it, in which cells have what lies at their middle (unknown beside
/// the turned grid), and all with which an occupied one overlaps are occupied.
/// @throws base::ConfigError where that has more than 1e8 cells.
OccupancyGrid TurnedGrid(const OccupancyGrid& grid, double yaw);

/// Whole quarters of a turn, 0 .. 3, if by these every cell of width x height comes to lie where
/// the yaw has it, to a twentieth of its edge.
std::optional<int> QuartersOf(double yaw, int width, int height);

}  // namespace hires::world
