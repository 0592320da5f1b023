#pragma once

#include <nav_msgs/OccupancyGrid.h>

#include "hires/world/occupancy_grid.h"

namespace hires_ros {

/// 0 is free, 100 occupied, -1 unknown; in between map_server's thresholds count.
/// @throws hires::base::ConfigError: no cells, another number of cells than its size says, a
/// resolution that is not positive, an origin that is no number or turned (map_server refuses such
/// maps too).
hires::world::OccupancyGrid FromMsg(const nav_msgs::OccupancyGrid& map);

/// Cells are 0, 100 or -1; the stamp is also that of the map's loading.
nav_msgs::OccupancyGrid ToMsg(const hires::world::OccupancyGrid& grid,
                              const std_msgs::Header& header);

}  // namespace hires_ros
