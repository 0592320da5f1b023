#pragma once

#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/navigation/a_star.h"
#include "hires/navigation/costmap.h"
#include "hires/navigation/reeds_shepp.h"

namespace hires::navigation {

struct CarPathResult {
  PathStatus status{PathStatus::kNoPath};
  std::vector<CarPose> path;  ///< from start to goal, both included
  double cost{0.0};           ///< [m] length, made longer by all that CarPathParams weighs
  int num_expansions{0};
};

struct CarPathParams {
  AStarParams costs;  ///< a metre of way costs 1 + cost_factor / neutral_cost * cost below
  double steering_reserve{1.1};  ///< planned arcs are so many times as wide as the smallest one, so
                                 ///< that who follows them can steer into them
  double clearance{0.03};        ///< [m] kept around the footprint where start and goal allow it
  double spacing{0.05};          ///< [m] between two poses, at most
  double backward_factor{1.5};   ///< a metre backward costs as much as so many forward
  double reversal{0.5};          ///< [m] that stopping and driving the other way costs
  int num_headings{72};          ///< that the search tells apart
  int max_expansions{10000};     ///< with clearance, and as many without, in each search but ...
  int max_last_expansions{20000};  ///< ... the last one, after which there counts as being no path
  double haste{1.3};               ///< of all but the first one: the weight of estimates
};

/// A way that a base which steers like a car can drive, forward and backward, from one pose to
/// another round what stands in the way: hybrid A* [Dolgov, Thrun, Montemerlo, Diebel 2010, Int. J.
/// Robotics Research 29:485-501] over arcs of the smallest circle, of one twice as wide, and
/// straight lines, with Reeds and Shepp's ways to the goal as the last piece. Where that meets its
/// bound, hasty searches follow, in which ways are found sooner that cost more: from the start and
/// from the goal, with driving backward as cheap as forward, and from the start once more. Below no
/// pose of the path does the footprint touch an obstacle. Of the ways that it comes upon it takes
/// the cheapest; it need not be the cheapest of all. Same input, same bits.
///
/// kStartBlocked, kGoalBlocked: the footprint touches an obstacle there. kNoPath: no way for the
/// robot's centre on the grid, or all searches ended or met their bounds.
/// @param footprint  Convex, padded, in the base frame [m].
/// @param min_turning_radius  [m] > 0
CarPathResult PlanCarPath(const Costmap& costmap, const Footprint& footprint,
                          const geometry::Pose2& X_MStart, const geometry::Pose2& X_MGoal,
                          double min_turning_radius, const CarPathParams& params = {});

/// The shortest way where nothing stands, on arcs as PlanCarPath drives them, both ends included.
std::vector<CarPose> ShortestCarPath(const geometry::Pose2& X_MStart,
                                     const geometry::Pose2& X_MGoal, double min_turning_radius,
                                     const CarPathParams& params = {});

}  // namespace hires::navigation
