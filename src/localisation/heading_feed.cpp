#include "hires/localisation/heading_feed.h"

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/robot/odometry_jump.h"

namespace hires::localisation {
namespace {

using Inertia = RobotLog::Inertia;

constexpr double kLongestStep = 0.25;  // [s] over which a rate is integrated

bool IsSameZero(const Inertia& before, const Inertia& now) {
  if (before.yaw || now.yaw) return before.yaw && now.yaw;
  return now.time - before.time <= kLongestStep;
}

}  // namespace

FilterOutcome HeadingFeed::Take(const Inertia& now) {
  if (!std::isfinite(now.time) || !std::isfinite(now.yaw.value_or(now.yaw_rate)))
    return FilterOutcome::kNotFinite;
  if (before_ && now.time < before_->time) {
    if (now.time > before_->time - robot::kClockReset) return FilterOutcome::kLate;
    before_.reset();
    filter_.BeginNewZero();
  }
  const bool is_same_zero = before_ && IsSameZero(*before_, now);
  if (before_ && !is_same_zero) filter_.BeginNewZero();
  if (now.yaw) {
    yaw_ = *now.yaw;
  } else if (is_same_zero) {
    const double turn = 0.5 * (before_->yaw_rate + now.yaw_rate) * (now.time - before_->time);
    yaw_ = geometry::WrapToPi(yaw_ + turn);
  }
  before_ = now;
  return filter_.OnInertia(now.time, {yaw_, now.yaw_rate});
}

}  // namespace hires::localisation
