#pragma once

#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"

namespace hires::navigation {

enum class PathStatus { kFound, kStartBlocked, kGoalBlocked, kNoPath };

struct PathResult {
  PathStatus status{PathStatus::kNoPath};
  std::vector<geometry::Pose2> path;  ///< from start to goal, one pose per cell, heading along the
                                      ///< path, the last one with the goal's heading
  double cost{0.0};  ///< sum over the steps: length [cells] * (neutral + factor * cost entered)
};

struct AStarParams {
  double neutral_cost{50.0};  ///< cost of a free cell, as navfn's COST_NEUTRAL
  double cost_factor{0.8};    ///< weight of the costmap's values, as navfn's COST_FACTOR
};

/// Cheapest path of the footprint's centre over the 8-connected grid. Start and goal may lie in
/// inflated cells but not where the robot's centre certainly collides (cost >= kInscribedCost);
/// the cells of path never do, nor does the path slip diagonally past one that is blocked. The
/// first and last pose are the start's and the goal's own positions, the others centres of cells;
/// in a single cell the goal is the whole path. Of equally cheap paths always the same one is
/// found. A start or goal outside the map is blocked.  @pre neutral_cost > 0, cost_factor >= 0.
PathResult PlanPath(const Costmap& costmap, const geometry::Pose2& X_MStart,
                    const geometry::Pose2& X_MGoal, const AStarParams& params = {});

}  // namespace hires::navigation
