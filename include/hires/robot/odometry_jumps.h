#pragma once

#include <algorithm>
#include <cmath>

#include "hires/robot/odometry_jump.h"

namespace hires::robot {

/// Tells resets of odometry from motion, reading after reading, where readings may come late in a
/// burst, stamped when they were sent: their steps may take time of the hole before the burst.
class OdometryJumps {
 public:
  /// @param max_linear_speed, max_angular_speed  [m/s], [rad/s] faster odometry was reset.
  OdometryJumps(double max_linear_speed, double max_angular_speed)
      : max_linear_speed_(max_linear_speed), max_angular_speed_(max_angular_speed) {}

  /// Whether odometry was reset that says `X_AB` `duration` [s] after the reading before. No step
  /// of a burst holds more than readings that come in time do.
  bool IsJump(const geometry::Pose2& X_AB, double duration) {
    const double usual = num_ > 0 ? 2.0 * sum_ / num_ : duration;
    const double lent = std::min(left_, usual);
    if (IsOdometryJump(X_AB, duration + lent, max_linear_speed_, max_angular_speed_)) {
      left_ = 0.0;
      return true;
    }
    const double needed = std::max(std::hypot(X_AB.x, X_AB.y) / max_linear_speed_,
                                   std::abs(geometry::WrapToPi(X_AB.yaw)) / max_angular_speed_);
    if (duration > usual) left_ += duration - usual;
    left_ = std::clamp(left_ - std::max(needed - duration, 0.0), 0.0, kLongest);
    sum_ += duration;
    ++num_;
    return false;
  }

 private:
  static constexpr double kLongest = 10.0;  // [s] of holes that count

  double max_linear_speed_, max_angular_speed_;
  double sum_{0.0};   // [s] between readings so far
  int num_{0};        // of them
  double left_{0.0};  // [s] of holes, that no motion has used
};

}  // namespace hires::robot
