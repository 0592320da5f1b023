#include "navigation/oscillation_guard.h"

#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::navigation {

OscillationGuard::OscillationGuard(double reset_distance, double reset_angle, double hardly_forward)
    : reset_distance_(reset_distance), reset_angle_(reset_angle), hardly_forward_(hardly_forward) {}

bool OscillationGuard::Axis::Drive(double value) {
  if (value == 0.0) return false;
  const int sign = value > 0.0 ? 1 : -1;
  const bool reversed = last == -sign;
  if (reversed) only = sign;
  last = sign;
  return reversed;
}

bool OscillationGuard::Allows(const geometry::Twist2& velocity) const {
  return forward_.Allows(velocity.vx) && sideways_.Allows(velocity.vy) &&
         turning_.Allows(velocity.wz);
}

void OscillationGuard::Chosen(const geometry::Twist2& velocity, const geometry::Pose2& X_MB) {
  bool reversed = forward_.Drive(velocity.vx);
  if (std::abs(velocity.vx) <= hardly_forward_) {
    reversed = sideways_.Drive(velocity.vy) || reversed;
    reversed = turning_.Drive(velocity.wz) || reversed;
  }
  if (reversed) X_MTurn_ = X_MB;
  if (forward_.only == 0 && sideways_.only == 0 && turning_.only == 0) return;
  const double moved = (X_MB.position() - X_MTurn_.position()).norm();
  const double turned = std::abs(geometry::WrapToPi(X_MB.yaw - X_MTurn_.yaw));
  if (moved > reset_distance_ || turned > reset_angle_) Reset();
}

void OscillationGuard::Reset() { forward_ = sideways_ = turning_ = Axis{}; }

}  // namespace hires::navigation
