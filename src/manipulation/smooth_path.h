#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::manipulation {

/// A stretch of a path in joint space: q(u) = a0 + a1 u + a2 u^2 with u in [0, 1].
struct PathPiece {
  Eigen::VectorXd a0, a1, a2;
  bool stops_at_end{false};  ///< the path turns back here, or ends

  Eigen::VectorXd Position(double u) const { return a0 + u * (a1 + u * a2); }
  Eigen::VectorXd Slope(double u) const { return a1 + 2.0 * u * a2; }
};

/// Straight lines with parabolas at the corners, so that the direction never jumps but at
/// reversals.
/// @param max_deviation  [rad] or [m] by which a joint may cut a corner.
/// @return empty if all points are equal.
std::vector<PathPiece> SmoothPath(const std::vector<std::vector<double>>& points,
                                  double max_deviation);

}  // namespace hires::manipulation
