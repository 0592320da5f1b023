#pragma once

#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"

namespace hires::sensing {

/// Whether the map has an obstacle as near as `tolerance` [m]: then a point there is that obstacle.
/// What lies beyond the map's border is left out, as if it were explained.
bool IsExplained(const navigation::Costmap& map, const Eigen::Vector2d& p_M, double tolerance);

/// The square of a grid through the map's origin that stands for what was seen within it.
geometry::Polygon SquareOf(long column, long row, double edge);

}  // namespace hires::sensing
