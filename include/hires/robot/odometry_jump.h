#pragma once

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/geometry/pose.h"

namespace hires::robot {

constexpr double kFastestDrive = 2.0;  ///< [m/s] where nobody says how fast the robot drives
constexpr double kFastestTurn = 6.0;   ///< [rad/s] likewise

/// [s] A reading that is older than the one before by less is late; one by more is of a clock that
/// began again.
constexpr double kClockReset = 1.0;

/// Whether odometry that says `X_AB` after `duration` [s] was reset, since no robot with these
/// limits [m/s], [rad/s] drives so fast. A slack of 0.1 m and 0.1 rad allows for rounding and slip.
inline bool IsOdometryJump(const geometry::Pose2& X_AB, double duration, double max_linear_speed,
                           double max_angular_speed) {
  constexpr double kSlack = 0.1;
  return std::hypot(X_AB.x, X_AB.y) > max_linear_speed * duration + kSlack ||
         std::abs(geometry::WrapToPi(X_AB.yaw)) > max_angular_speed * duration + kSlack;
}

}  // namespace hires::robot
