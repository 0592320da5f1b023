#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/localisation/robot_log.h"
#include "hires/robot/readings.h"

namespace hires::mapping {

/// Where a beam ended, in the frame of the base.
struct SurfacePoint {
  Eigen::Vector2d p;                           ///< [m]
  Eigen::Vector2d n{Eigen::Vector2d::Zero()};  ///< unit normal towards the laser; zero: unknown
  bool has_normal() const { return n.x() != 0.0 || n.y() != 0.0; }
};
using SurfacePoints = std::vector<SurfacePoint>;

/// Whether a beam met something, no farther away than `max_range` [m].
bool HasMet(const robot::ScanReading& scan, std::size_t beam, double max_range);
/// Where a beam that met something ended, in the frame of the laser [m].
Eigen::Vector2d EndOf(const robot::ScanReading& scan, std::size_t beam);

/// Ends of the beams that met something nearer than `max_range` [m], with normals from what was
/// met beside them.
SurfacePoints PointsOf(const localisation::RobotLog::Scan& scan, double max_range);

/// Those that are `spacing` [m] apart from the one before, in the order of the beams.
SurfacePoints Thinned(const SurfacePoints& points, double spacing);

}  // namespace hires::mapping
