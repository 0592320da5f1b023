#include "turn_towards.h"

#include <algorithm>
#include <cmath>

#include "hires/base/failure.h"

namespace own_action {
namespace {

using hires::skills::Progress;

constexpr double kTolerance = 0.03;     // [rad]
constexpr double kStanding = 0.01;      // [rad/s] counts as standing
constexpr double kReactionTime = 0.15;  // [s] from what is seen to what the wheels do of it
constexpr double kBraking = 0.5;        // share of the acceleration limit: the base follows late
constexpr double kPatience = 2.0;       // [s] without coming nearer

/// [rad/s] from which the base comes to a stand within `angle`, braking at `deceleration` once it
/// reacts.
double SpeedFor(double angle, double deceleration) {
  const double late = deceleration * kReactionTime;
  return std::sqrt(late * late + 2.0 * deceleration * angle) - late;
}

}  // namespace

TurnTowards::TurnTowards(const Eigen::Vector2d& p_M, const hires::robot::MotionSet& motion_set)
    : p_M_(p_M), motion_set_(motion_set) {}

hires::skills::Status TurnTowards::Update(const hires::robot::Observation& observation,
                                          hires::robot::Command* command) {
  const Eigen::Vector2d p_B = observation.X_MB.Inverse() * p_M_;
  const double left = std::atan2(p_B.y(), p_B.x());  // (-pi, pi]
  command->motion_set = motion_set_;
  command->base_velocity = hires::geometry::Twist2{};
  if (std::abs(left) <= kTolerance) {
    const bool stands = std::abs(observation.V_B.wz) < kStanding;
    return {stands ? Progress::kSucceeded : Progress::kRunning, {}};
  }
  if (std::abs(left) < least_ - 0.01) {
    least_ = std::abs(left);
    last_progress_ = observation.time;
  }
  if (observation.time - last_progress_ > kPatience) {
    return hires::skills::Failed(hires::base::FailureCode::kStuck);
  }
  const double braking = kBraking * motion_set_.max_angular_acceleration;
  const double speed =
      std::min(motion_set_.max_angular_velocity, SpeedFor(std::abs(left), braking));
  command->base_velocity->wz = std::copysign(speed, left);
  return {};
}

}  // namespace own_action
