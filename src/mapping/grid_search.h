#pragma once

#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "mapping/nearness.h"

namespace hires::mapping {

/// What is tried around a guess.
struct SearchWindow {
  double reach{0.2};  ///< [m] to either side, along both axes
  double yaw{0.1};    ///< [rad] to either side
};

struct SearchStep {
  int cells{1};     ///< of nearness, along both axes
  double yaw{0.0};  ///< [rad]
};

/// A pose and how near the points lie there to what a map shows.
struct GridMatch {
  geometry::Pose2 X_MB;
  double score{-1.0};  ///< -1: there is none
};

/// Poses that are left out of a search.
struct Disc {
  Eigen::Vector2d centre;
  double radius;  ///< [m]
};

/// The pose at which points lie nearest to what a map shows, of all those of a grid about a guess;
/// of equal ones the first, by yaw, row and column. A pose at the window's edge is as good as that
/// in its middle only if its points lie nearer by 5 %. Squares of poses that cannot hold the best
/// one are left out as a whole, by bounds that hold for all of them [Olson 2009, ICRA, 4387-4393;
/// Hess et al. 2016, ICRA, 1271-1278].
/// @param points  [m] from the base.
/// @param left_out  positions that do not count.
GridMatch SearchGrid(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points,
                     const geometry::Pose2& guess, const SearchWindow& window,
                     const SearchStep& step, const std::optional<Disc>& left_out = std::nullopt);

}  // namespace hires::mapping
