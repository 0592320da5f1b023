#pragma once

#include <vector>

#include "hires/simulation/laser_scanner.h"

namespace hires::simulation {

/// Distance along a ray in the plane to a convex outline [m]; infinite without a hit; 0 from
/// within.
double DistanceTo(const geometry::Polygon& outline, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& direction);

/// Puts obstacles that do not exist before what a scan has really measured.
/// @param X_ML    true pose of the laser in the map.
/// @param ranges  [m] as ScanLaser gives them.
void AddGhosts(const std::vector<geometry::Polygon>& ghosts_M, const LaserParams& params,
               const geometry::Pose2& X_ML, std::vector<double>* ranges);

}  // namespace hires::simulation
