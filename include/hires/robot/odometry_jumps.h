#pragma once

#include <algorithm>
#include <cmath>

#include "hires/robot/lent_time.h"
#include "hires/robot/odometry_jump.h"

namespace hires::robot {

/// Tells resets of odometry from motion, reading after reading, where readings may come late in a
/// burst (LentTime).
class OdometryJumps {
 public:
  /// @param max_linear_speed, max_angular_speed  [m/s], [rad/s] faster odometry was reset.
  OdometryJumps(double max_linear_speed, double max_angular_speed)
      : max_linear_speed_(max_linear_speed), max_angular_speed_(max_angular_speed) {}

  /// Whether odometry was reset that says `X_AB` `duration` [s] after the reading before.
  bool IsJump(const geometry::Pose2& X_AB, double duration) {
    if (IsOdometryJump(X_AB, time_.For(duration), max_linear_speed_, max_angular_speed_)) {
      time_.Forget();
      return true;
    }
    time_.Take(duration, std::max(std::hypot(X_AB.x, X_AB.y) / max_linear_speed_,
                                  std::abs(geometry::WrapToPi(X_AB.yaw)) / max_angular_speed_));
    return false;
  }

 private:
  double max_linear_speed_, max_angular_speed_;
  LentTime time_;
};

}  // namespace hires::robot
