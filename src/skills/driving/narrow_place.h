// Private to this layer: where a base is too wide for its way.
#pragma once

#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"

namespace hires::skills {

/// Where a base cannot pass with its heading along its way, wherever beside it it drives: the free
/// width across the way, from obstacle to obstacle.
struct NarrowPlace {
  geometry::Pose2 X_MW;         ///< in its middle, x along the way
  double width{0.0};            ///< [m] free
  double footprint_width{0.0};  ///< [m] across its heading, as it needs least room
};

/// The first pose of a path that lies in a passage, straight on through its narrowest cut, where
/// the footprint, driving 0.6 m straight on, touches something at all places of the cut and all
/// headings within 0.52 rad of the passage's; none: it may pass. Where less than two cells would be
/// left, that is tried with the whole footprint, else with one that is 0.03 m smaller. What lies
/// within the footprint's reach of both ends does not count: there a base may turn as it needs.
/// @param footprint  convex, in the base frame, as local control has it.
std::optional<NarrowPlace> FindTooNarrow(const navigation::Costmap& costmap,
                                         const navigation::Footprint& footprint,
                                         const std::vector<geometry::Pose2>& path);

/// The same map with the passage closed.
navigation::Costmap WithClosed(const navigation::Costmap& costmap, const NarrowPlace& place);

}  // namespace hires::skills
