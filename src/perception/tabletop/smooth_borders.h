#pragma once

#include <vector>

#include "hires/perception/segmentation_params.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// Joins parts that border on each other without a concave edge: where nearly all of the border is
/// convex or flat, and where both parts bend towards the camera and their border does so as gently,
/// as patches of the inside of a bowl do. Where two things touch, the border is an edge, and
/// hardly anything bends towards the camera on either side of it.
/// @param part  of each surfel, 0, 1, ...; -1: of none.
/// @return likewise, some numbers unused.
std::vector<int> JoinAcrossSmoothBorders(const SurfelCloud& surfels, std::vector<int> part,
                                         const SmoothBorderParams& params);

}  // namespace hires::perception
