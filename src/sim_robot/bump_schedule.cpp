#include "sim_robot/bump_schedule.h"

#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::sim_robot {

using geometry::kPi;

BumpSchedule::BumpSchedule(const Bumps& bumps, const base::Rng& rng) : bumps_(bumps), rng_(rng) {
  if (bumps_.mean_interval > 0.0) DrawNext(0.0);
}

void BumpSchedule::DrawNext(double after) {
  begin_ = after - bumps_.mean_interval * std::log(1.0 - rng_.Uniform(0.0, 1.0));
  speed_ = rng_.Uniform(bumps_.least_speed, bumps_.greatest_speed);
  bearing_ = rng_.Uniform(-kPi, kPi);
}

std::optional<geometry::Twist2> BumpSchedule::PushAt(double time) {
  if (bumps_.mean_interval <= 0.0 || time < begin_) return std::nullopt;
  const double share = (time - begin_) / bumps_.duration;
  if (share >= 1.0) {
    DrawNext(begin_ + bumps_.duration);
    return std::nullopt;
  }
  const double push = speed_ * 0.5 * kPi / bumps_.duration * std::sin(kPi * share);
  return geometry::Twist2{push * std::cos(bearing_), push * std::sin(bearing_), 0.0};
}

}  // namespace hires::sim_robot
