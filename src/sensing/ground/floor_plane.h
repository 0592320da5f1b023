#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/base/rng.h"
#include "hires/sensing/ground_reading.h"
#include "hires/sensing/ground_watch.h"

namespace hires::sensing {

/// Finds the floor among points: the best of planes through three of them that the tolerances allow
/// (RANSAC), fitted by least squares to all points near it.
/// @param points_B  finite.
FloorPlane FindFloor(const std::vector<Eigen::Vector3d>& points_B, const FloorParams& params,
                     base::Rng* rng);

}  // namespace hires::sensing
