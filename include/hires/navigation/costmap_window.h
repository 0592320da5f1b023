#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hires/navigation/costmap.h"

namespace hires::navigation {

/// A square piece of a costmap, in the numbers that other programs show costmaps by: 0 free, 1..98
/// in an obstacle's surroundings, 99 where the robot's centre certainly collides, 100 an obstacle,
/// -1 unknown or beyond the map.
struct CostmapWindow {
  double resolution{0.05};                          ///< [m] edge of a cell
  int width{0};                                     ///< [cells] of either edge
  Eigen::Vector2d origin{Eigen::Vector2d::Zero()};  ///< [m] lower left corner of cell (0, 0)
  std::vector<std::int8_t> occupancy;               ///< row by row, x fastest
};

/// The cells whose distance from the point's cell is at most `half_width` [m] in x and y: always
/// the same number, also at the map's edge.
/// @pre half_width is finite and >= 0.
CostmapWindow WindowAround(const Costmap& costmap, const Eigen::Vector2d& point_M,
                           double half_width);

}  // namespace hires::navigation
