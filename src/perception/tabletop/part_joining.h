#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/table.h"
#include "perception/tabletop/seen_depth.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// The inner side of a vessel that is open above; what is seen through the opening is its floor.
struct Opening {
  int part{0};
  geometry::Polygon outline{};  ///< of the whole thing, Table::FromAbove [m]
  double height{0.0};           ///< [m] of the rim above the table
};

struct JoinedParts {
  std::vector<int> part{};  ///< of each surfel; -1: of none
  std::vector<Opening> openings{};
};

/// Joins parts of one thing that no convex border connects: the inner and the outer side of a
/// vessel, which meet at the rim; and what something in front divides into two, if the faces of one
/// side go on at the other.
/// @param part  of each surfel, 0, 1, ...; -1: of none.
JoinedParts JoinParts(const PointCloud& cloud, const Table& table, const SurfelCloud& surfels,
                      const SeenDepth& seen, std::vector<int> part, const PartJoiningParams& params,
                      const base::Rng& rng);

/// Whether the sight line to a point goes through the opening, and the point is within the thing.
bool IsSeenThrough(const Opening& opening, const Table& table, const Eigen::Vector3d& p_C);

}  // namespace hires::perception
