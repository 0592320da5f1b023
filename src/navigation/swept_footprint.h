#pragma once

#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"

namespace hires::navigation {

/// What the footprint comes to lie on while the base moves. Poses are checked so densely that no
/// corner moves by more than half a cell between two of them.
class SweptFootprint {
 public:
  /// @param linear_step [m], angular_step [rad]: upper bounds of the distance between two poses.
  SweptFootprint(Footprint footprint, double linear_step, double angular_step);

  /// How many steps a motion with V_B for `duration` [s] is cut into, >= 1.
  int NumSteps(const Costmap& costmap, const geometry::Twist2& V_B, double duration,
               double scale = 1.0) const;

  /// Highest cost below the footprint, enlarged by `scale`, what of it is at the heights of layers
  /// by as much as its nearest edge moves, on the way, both ends included;
  /// kLethalCost or more as soon as one pose touches an obstacle.
  std::uint8_t HighestCost(const Costmap& costmap, const geometry::Pose2& X_MB,
                           const geometry::Twist2& V_B, double duration, double scale = 1.0);

  bool IsFree(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B,
              double duration) {
    return HighestCost(costmap, X_MB, V_B, duration) < kLethalCost;
  }

 private:
  std::uint8_t CostAt(const Costmap& costmap, const geometry::Pose2& X_MB, double scale);

  Footprint footprint_;
  Footprint placed_;                         // scratch
  double inscribed_;                         // [m]
  std::vector<geometry::Polygon> outwards_;  // of the parts' corners: where to they grow
  double radius_;
  double linear_step_, angular_step_;
};

}  // namespace hires::navigation
