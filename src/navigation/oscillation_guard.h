#pragma once

#include "hires/geometry/pose.h"

namespace hires::navigation {

/// Forbids to go back the way one came until the robot has got away from where it turned round: the
/// oscillation critic of base_local_planner. Forward and backward always count; left and right,
/// sideways and turning, only while the robot hardly drives forward.
class OscillationGuard {
 public:
  /// @param reset_distance [m], reset_angle [rad]: past either one everything is allowed again.
  /// @param hardly_forward [m/s] up to which sideways motion and turning are watched.
  OscillationGuard(double reset_distance, double reset_angle, double hardly_forward);

  bool Allows(const geometry::Twist2& velocity) const;
  void Chosen(const geometry::Twist2& velocity, const geometry::Pose2& X_MB);
  void Reset();

 private:
  /// One direction of motion: the sign that was driven last, and the only one still allowed.
  struct Axis {
    int last{0};
    int only{0};
    bool Allows(double value) const { return only == 0 || value * only >= 0.0; }
    bool Drive(double value);  ///< Was the direction reversed, so that only this one is allowed?
  };

  double reset_distance_, reset_angle_, hardly_forward_;
  Axis forward_, sideways_, turning_;
  geometry::Pose2 X_MTurn_;  // where the robot last reversed
};

}  // namespace hires::navigation
