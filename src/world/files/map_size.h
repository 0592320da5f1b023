#pragma once

#include <string>

#include "hires/world/occupancy_grid.h"

namespace hires::world {

/// Whether a map is so large (2 km and more across) or its cells so coarse (1 m and more) or so
/// fine (less than 1 mm) that its resolution may be in another unit than metres: a sentence with
/// file, size and remedy; else "". Nothing is scaled.
std::string DoubtedMapSize(const OccupancyGrid& grid, const std::string& yaml_path);

}  // namespace hires::world
