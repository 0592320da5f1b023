#pragma once

#include <cstdint>
#include <vector>

#include "hires/world/occupancy_grid.h"

namespace hires::localisation {

/// For each cell the squared distance [cells^2] from its centre to that of the nearest occupied
/// one, exact by the lower envelope of parabolas [Felzenszwalb, Huttenlocher 2012, Theory of
/// Computing 8:415-428], and `most` where that is farther or there is none.
/// @pre width and height >= 1, width * height cells, most >= 0
std::vector<std::int32_t> SquaredDistances(const world::OccupancyGrid& grid, std::int32_t most);

}  // namespace hires::localisation
