#pragma once

#include <optional>

#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"

namespace hires::localisation {

constexpr double kMostLaserTilt = 0.1;  ///< [rad] out of the level

/// Where a laser scans in the plane of the base. One that hangs upside down measures its angles the
/// other way round: the scan is then turned over.
/// @return nothing: the laser is tilted by more than kMostLaserTilt.
std::optional<geometry::Pose2> LevelLaser(const geometry::Pose3& X_BL, robot::ScanReading* scan);

}  // namespace hires::localisation
