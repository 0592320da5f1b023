#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/navigation/a_star.h"
#include "hires/navigation/costmap.h"

namespace hires::navigation {

/// What it costs [m] to bring the robot's centre to a goal, as a point that drives anywhere over
/// the 8-connected grid where it does not certainly collide: the length, made longer by the costs
/// below.
class CentreDistances {
 public:
  /// @param p_MStart  its cell and the goal's count as free: what the outline touches there is for
  /// the caller to see.
  CentreDistances(const Costmap& costmap, const Eigen::Vector2d& p_MGoal,
                  const Eigen::Vector2d& p_MStart, const AStarParams& costs);

  double At(const Eigen::Vector2d& p_MB) const;  ///< infinite where no way leads from

 private:
  const Costmap& costmap_;
  std::vector<double> cost_;
};

}  // namespace hires::navigation
