#pragma once

#include <vector>

#include "hires/localisation/robot_log.h"
#include "hires/world/occupancy_grid.h"

namespace hires::mapping {

/// Draws scans from where the base stood: occupied are cells in which more than a quarter of the
/// beams that reached them ended, free those that beams passed, the rest is unknown.
/// @param scans  one for each pose.
/// @throws base::ConfigError if that takes more than 100 million cells.
world::OccupancyGrid DrawGrid(const std::vector<const localisation::RobotLog::Scan*>& scans,
                              const std::vector<geometry::Pose2>& X_MBs, double resolution,
                              double max_range);

}  // namespace hires::mapping
