#pragma once

#include <vector>

#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// Regions of a surface that no concave edge divides: where two things touch, their surfaces meet
/// in a concave edge, while those of one thing are convex or bend slowly [Stein, Schoeler, Papon,
/// Woergoetter 2014, "Object Partitioning Using Local Convexity", CVPR; the criterion alone].
/// Regions are joined one pair after the other, the pair first whose common border is least concave
/// on average, so that a single wrong normal joins nothing and divides nothing.
/// @return part of each surfel, 0, 1, ...; -1: of a region that is too small and borders on no
/// part.
std::vector<int> FindConvexParts(const SurfelCloud& surfels, const ConvexPartParams& params);

}  // namespace hires::perception
