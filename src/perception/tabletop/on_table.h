#pragma once

#include <vector>

#include "hires/perception/table.h"
#include "perception/tabletop/seen_depth.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// What is known of where a table ends.
enum class Outline {
  kSeen,   ///< where its measured points end; things may hide more of it
  kWhole,  ///< all of it
};

/// Which parts of what is above a table's plane may stand on the table. Those within its outline
/// do. The outline ends where things hide the table, too, so a part beside it is dropped only where
/// something speaks against it: it goes on below the plane, the camera looks through the plane
/// where its foot would be, it is larger than what stands on tables, or it touches what is. Beside
/// an outline that is whole nothing stands on the table.
/// @param part  of each surfel, 0, 1, ...; -1: of none.
/// @return the same, -1 for parts that stand beside the table.
std::vector<int> WithoutBeside(const PointCloud& cloud, const Table& table, const SurfelCloud& all,
                               const SeenDepth& seen, Outline outline, std::vector<int> part);

}  // namespace hires::perception
