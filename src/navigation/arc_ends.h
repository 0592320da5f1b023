#pragma once

#include <vector>

#include "hires/geometry/pose.h"

namespace hires::navigation {

/// Where arcs of one duration end that begin at one pose: as PoseAfter, to the last bit, for
/// thousands of velocities with few different turning rates. What depends on the rate alone is
/// worked out once.
class ArcEnds {
 public:
  /// @param ahead  [m] from the base to a point F in front of it, whose end is asked for too.
  ArcEnds(const geometry::Pose2& X_MB, double duration, double ahead);

  struct End {
    Eigen::Vector2d p_MB, p_MF;
  };
  End Of(const geometry::Twist2& V_B);

 private:
  struct Turn {
    double wz;
    double along, across;  // integrals of cos and sin of the heading
    Eigen::Vector2d p_BF;  // at the end, in map axes
  };
  const Turn& TurnOf(double wz);

  geometry::Pose2 X_MB_;
  double c_, s_;  // of its heading
  double duration_;
  double ahead_;
  std::vector<Turn> turns_;
  std::size_t next_{0};  // rates come in the same order again and again
};

}  // namespace hires::navigation
