#include "hires/navigation/braking.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::navigation {
namespace {

double SpeedOf(const geometry::Twist2& V) { return std::hypot(V.vx, V.vy); }

/// Limits of a share that falls from 1 to 0 while it scales a twist.
BrakingLimits ShareLimits(const geometry::Twist2& V, const BrakingLimits& limits,
                          const BrakingParams& params) {
  const double turning = std::abs(V.wz);
  const double load_speed = SpeedOf(V) + turning * params.load_reach;
  if (load_speed == 0.0) return {1.0, 1.0};
  // What keeps the load on its arc is taken off; where that is nearly all, a third has to do.
  const double on_arc = turning * load_speed;
  const double a = limits.max_deceleration;
  const double along = std::sqrt(std::max(a * a - on_arc * on_arc, a * a / 9.0));
  BrakingLimits share{along / load_speed, limits.max_jerk / load_speed};
  if (turning > 0.0) {
    share.max_deceleration =
        std::min(share.max_deceleration, params.max_angular_deceleration / turning);
    share.max_jerk = std::min(share.max_jerk, params.max_angular_jerk / turning);
  }
  return share;
}

/// By how much of itself the twist shrinks per second already; 0 where it grows.
double ShrinkingRate(const geometry::Twist2& V, const geometry::Twist2& A, double reach,
                     double most) {
  const double turning = reach * reach;
  const double square = V.vx * V.vx + V.vy * V.vy + turning * V.wz * V.wz;
  if (square == 0.0) return 0.0;
  const double along = V.vx * A.vx + V.vy * A.vy + turning * V.wz * A.wz;
  return std::clamp(-along / square, 0.0, most);
}

StopProfile ShareProfile(const geometry::Twist2& V, const geometry::Twist2& A,
                         const BrakingLimits& limits, const BrakingParams& params) {
  const BrakingLimits share = ShareLimits(V, limits, params);
  const bool moves = SpeedOf(V) > 0.0 || V.wz != 0.0;
  return StopProfile(moves ? 1.0 : 0.0,
                     -ShrinkingRate(V, A, params.load_reach, share.max_deceleration), share);
}

}  // namespace

struct StopProfile::Moment {
  double distance{0.0}, speed{0.0}, acceleration{0.0};
};

StopProfile::Moment StopProfile::During(const Phase& phase, double time) {
  const double t = std::clamp(time - phase.begin, 0.0, phase.duration);
  Moment now;
  now.acceleration = phase.acceleration + phase.jerk * t;
  now.speed = phase.speed + (phase.acceleration + 0.5 * phase.jerk * t) * t;
  now.distance =
      phase.distance + (phase.speed + (0.5 * phase.acceleration + phase.jerk * t / 6.0) * t) * t;
  return now;
}

StopProfile::StopProfile(double speed, double acceleration, const BrakingLimits& limits) {
  const double a = limits.max_deceleration, j = limits.max_jerk;
  HIRES_CHECK(speed >= 0.0, "a stop begins with a speed that is not negative");
  HIRES_CHECK(a > 0.0 && j > 0.0, "limits of braking are positive");
  const double most = std::sqrt(2.0 * j * speed);  // can just be eased off until it stands
  const double d = std::min(-acceleration, most);
  // d falls or rises to `peak`, stays there, and falls to 0.
  const double peak = d > a ? a : std::max(d, std::min(a, std::sqrt(j * speed + 0.5 * d * d)));
  const double lost_first = d > a ? (d * d - a * a) / (2.0 * j) : (peak * peak - d * d) / (2.0 * j);
  const double left = speed - lost_first - peak * peak / (2.0 * j);
  phases_[0] = {std::abs(peak - d) / j, d > a ? j : -j, 0.0, 0.0, speed, -d};
  phases_[1] = {peak > 0.0 ? std::max(0.0, left) / peak : 0.0, 0.0};
  phases_[2] = {peak / j, j};
  for (std::size_t i = 1; i < phases_.size(); ++i) {
    const Phase& before = phases_[i - 1];
    const Moment handover = During(before, before.begin + before.duration);
    phases_[i].begin = before.begin + before.duration;
    phases_[i].distance = handover.distance;
    phases_[i].speed = handover.speed;
    phases_[i].acceleration = -peak;
  }
  duration_ = phases_[2].begin + phases_[2].duration;
  distance_ = During(phases_[2], duration_).distance;
}

StopProfile::Moment StopProfile::At(double time) const {
  const Phase* phase = &phases_[0];
  for (const Phase& later : phases_) {
    if (later.begin <= time) phase = &later;
  }
  return During(*phase, time);
}

double StopProfile::SpeedAt(double time) const {
  return time >= duration_ ? 0.0 : std::max(0.0, At(time).speed);
}

double StopProfile::AccelerationAt(double time) const {
  return time >= duration_ ? 0.0 : At(time).acceleration;
}

double StopProfile::DistanceAt(double time) const {
  return time >= duration_ ? distance_ : At(time).distance;
}

double StoppingTime(double speed, const BrakingLimits& limits) {
  const double a = limits.max_deceleration, j = limits.max_jerk;
  return speed * j < a * a ? 2.0 * std::sqrt(speed / j) : speed / a + a / j;
}

double StoppingDistance(double speed, const BrakingLimits& limits) {
  return 0.5 * speed * StoppingTime(speed, limits);  // the profile is symmetric about its middle
}

double OvershootShare(double frequency, double damping, double rise_time) {
  HIRES_CHECK(frequency > 0.0, "an oscillation has a frequency");
  HIRES_CHECK(damping >= 0.0 && rise_time >= 0.0, "damping and rise time are not negative");
  if (damping >= 1.0) return 0.0;
  const double of_step = std::exp(-geometry::kPi * damping / std::sqrt(1.0 - damping * damping));
  return rise_time > 0.0 ? std::min(of_step, 2.0 / (frequency * rise_time)) : of_step;
}

PlanarStop::PlanarStop(const geometry::Twist2& V_B, const geometry::Twist2& A_B,
                       const BrakingLimits& limits, const BrakingParams& params)
    : V_B_(V_B), scale_(ShareProfile(V_B, A_B, limits, params)) {}

geometry::Twist2 PlanarStop::VelocityAt(double time) const {
  const double share = scale_.SpeedAt(time);
  return {share * V_B_.vx, share * V_B_.vy, share * V_B_.wz};
}

double PlanarStop::distance() const { return SpeedOf(V_B_) * scale_.distance(); }

}  // namespace hires::navigation
