#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/robot/readings.h"

namespace hires::robot {

/// Where the beams of a scan ended, in its order, in the base of the moment when it was taken [m].
/// Left out are what is no measurement, what met nothing, and what lies within the robot's
/// footprint: that is the robot itself.
std::vector<Eigen::Vector2d> EchoesOf(const PlacedScan& scan, const geometry::Polygon& footprint);

/// Whether a point [m, in the base of the moment when the scan was taken] is nearer to the laser
/// than it measures, or so little farther that its noise may hide it.
bool IsTooNear(const PlacedScan& scan, const Eigen::Vector2d& point_B);

/// Whether a scan tells what is at a point, or before it: the laser looks there, the point is not
/// too near, and the beam next to it is a measurement, if only that nothing is there.
bool IsInView(const PlacedScan& scan, const Eigen::Vector2d& point_B);

/// Whether any beam of a scan measured anything, if only that nothing is there: of a laser that is
/// covered none does.
bool HasMeasured(const ScanReading& reading);

/// Of a beam that came back several times, [m]: the nearest echo that is no shorter than
/// `range_min`; infinity if none came back, NaN if none counts.
float NearestEcho(const std::vector<float>& echoes, float range_min);

}  // namespace hires::robot
