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

/// All poses of a grid about a guess, to be asked for the one at which points lie nearest to what a
/// map shows. A pose at the window's edge is as good as that in its middle only if its points lie
/// nearer by 5 %. Squares of poses that cannot hold the best one are left out as a whole, by bounds
/// that hold for all of them [Olson 2009, ICRA, 4387-4393; Hess et al. 2016, ICRA, 1271-1278].
class GridSearch {
 public:
  /// @param points  [m] from the base.
  GridSearch(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points,
             const geometry::Pose2& guess, const SearchWindow& window, const SearchStep& step);

  /// The best; of equal ones the first, by yaw, row and column.
  /// @param left_out  positions that do not count.
  GridMatch Best(const std::optional<Disc>& left_out = std::nullopt) const;

 private:
  /// Poses of one yaw whose columns and rows begin at these.
  struct Square {
    int yaw{0}, row{0}, column{0};  // in steps from the guess
    double bound{-1.0};             // no pose of it scores more
  };

  static bool IsBetter(const Square& a, const Square& b);
  Square SquareAt(int yaw, int row, int column, int level) const;
  void Look(const Square& square, int level, const std::optional<Disc>& left_out,
            Square* best) const;
  double PenaltyOf(const Square& square, int edge) const;
  geometry::Pose2 PoseOf(const Square& square) const;

  geometry::Pose2 guess_;
  SearchWindow window_;
  SearchStep step_;
  int most_, most_yaw_;                             // steps to either side
  std::vector<Nearness> levels_;                    // most of squares of 2^level steps
  std::vector<std::vector<Eigen::Array2i>> cells_;  // of the points, for each yaw
  std::vector<Square> largest_;                     // of the last level, the best first
};

}  // namespace hires::mapping
