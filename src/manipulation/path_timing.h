#pragma once

#include <Eigen/Core>
#include <vector>

#include "manipulation/smooth_path.h"

namespace hires::manipulation {

/// Largest |velocity| and |acceleration| of each joint.
struct JointBounds {
  Eigen::VectorXd velocity, acceleration;
};

/// A path is cut into cells; along each, u of its piece has one acceleration.
struct TimedCell {
  const PathPiece* piece;
  double u0, u1;
  double x0, x1;        ///< (du/dt)^2 at both ends
  double acceleration;  ///< d2u/dt2
  double duration;      ///< [s]
};

/// The fastest motion along the pieces within the bounds, at rest at both ends and where a piece
/// stops. Bounds hold at both ends of every cell.
std::vector<TimedCell> TimePieces(const std::vector<PathPiece>& pieces, const JointBounds& bounds);

}  // namespace hires::manipulation
