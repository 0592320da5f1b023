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

}  // namespace hires::robot
