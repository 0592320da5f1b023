#include "navigation/velocity_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"

namespace hires::navigation {
namespace {

constexpr double kFollowed = 3.0;  // changes that a base may lag behind its commands

// Of a base that cannot move sideways, which has no samples of that: neighbours lie no farther
// apart, or it has so many.
constexpr double kFineSpacing = 0.05;  // [m/s, rad/s]
constexpr int kMostSpeeds = 20, kMostTurns = 40;

constexpr double kSlack = 1e-4;  // [m/s, rad/s] so that a limit itself is never rounded away

/// What is reachable from `now` by `gain` away from 0 and `loss` towards it, within lower..upper.
struct Range {
  double from, to;

  Range(double now, double gain, double loss, double lower, double upper)
      : from(std::clamp(now - (now > 0.0 ? loss : gain), lower, upper)),
        to(std::clamp(now + (now < 0.0 ? loss : gain), lower, upper)) {}

  std::vector<double> Samples(int count) const { return SampleAxis(from, to, count); }
  std::vector<double> FineSamples(int count, int most) const {
    const int fine =
        1 + static_cast<int>(std::ceil(std::min((to - from) / kFineSpacing, 1e3) - kSlack));
    return Samples(std::max(count, std::min(fine, most)));
  }
};

/// What counts as fast enough to be worth driving.
struct SmallestUseful {
  double linear, angular;

  SmallestUseful(const DwaParams& params, const robot::MotionSet& limits,
                 const geometry::Twist2& V_B)
      : linear(std::min(params.min_linear_velocity, limits.max_linear_velocity)),
        angular(std::min(params.min_angular_velocity, limits.max_angular_velocity)) {
    const double reachable_linear = std::min(
        std::hypot(V_B.vx, V_B.vy) + limits.max_linear_acceleration * params.control_period,
        limits.max_linear_velocity);
    const double reachable_angular =
        std::min(std::abs(V_B.wz) + limits.max_angular_acceleration * params.control_period,
                 limits.max_angular_velocity);
    if (reachable_linear >= linear || reachable_angular >= angular) return;
    linear = reachable_linear;
    angular = reachable_angular;
  }

  bool Allows(const geometry::Twist2& V) const {
    return std::hypot(V.vx, V.vy) + kSlack >= linear || std::abs(V.wz) + kSlack >= angular;
  }
};

}  // namespace

ArcIntegrals IntegralsAlong(double wz, double duration) {
  const double angle = wz * duration;
  if (std::abs(angle) <= 1e-9) return {duration, 0.0};
  return {std::sin(angle) / wz, (1.0 - std::cos(angle)) / wz};
}

geometry::Pose2 PoseAfter(const geometry::Pose2& X_MB, const geometry::Twist2& V_B,
                          double duration) {
  const auto [along, across] = IntegralsAlong(V_B.wz, duration);
  return X_MB * geometry::Pose2{V_B.vx * along - V_B.vy * across, V_B.vx * across + V_B.vy * along,
                                V_B.wz * duration};
}

std::vector<double> SampleAxis(double lower, double upper, int count) {
  HIRES_CHECK(lower <= upper, "a range of velocities begins with the lower one");
  if (lower == upper) return {lower};
  const int steps = std::max(count, 2) - 1;
  std::vector<double> samples;
  for (int i = 0; i <= steps; ++i) {
    const double value = i == steps ? upper : lower + (upper - lower) * i / steps;
    if (value > 0.0 && !samples.empty() && samples.back() < 0.0) samples.push_back(0.0);
    samples.push_back(value);
  }
  return samples;
}

std::vector<geometry::Twist2> ReachableVelocities(const DwaParams& params,
                                                  const robot::MotionSet& limits,
                                                  const geometry::Twist2& V_B) {
  const double linear_change = limits.max_linear_acceleration * params.control_period;
  const double angular_change = limits.max_angular_acceleration * params.control_period;
  const double braking = limits.linear_deceleration() * params.control_period;
  const double turn_braking = limits.angular_deceleration() * params.control_period;
  const double lateral = std::min(params.max_lateral_velocity, limits.max_linear_velocity);
  const double turning = limits.max_angular_velocity;
  const SmallestUseful smallest(params, limits, V_B);
  std::vector<geometry::Twist2> velocities;
  const Range forward(V_B.vx, linear_change, braking, 0.0, limits.max_linear_velocity);
  const Range turn(V_B.wz, angular_change, turn_braking, -turning, turning);
  const bool is_fine = lateral == 0.0;
  const auto ys =
      Range(V_B.vy, linear_change, braking, -lateral, lateral).Samples(params.vy_samples);
  const auto turns = is_fine ? turn.FineSamples(params.vtheta_samples, kMostTurns)
                             : turn.Samples(params.vtheta_samples);
  for (double vx : is_fine ? forward.FineSamples(params.vx_samples, kMostSpeeds)
                           : forward.Samples(params.vx_samples)) {
    for (double vy : ys) {
      if (std::hypot(vx, vy) > limits.max_linear_velocity + kSlack) continue;
      for (double wz : turns) {
        if (smallest.Allows({vx, vy, wz})) velocities.push_back({vx, vy, wz});
      }
    }
  }
  return velocities;
}

geometry::Twist2 Braked(const geometry::Twist2& V_B, const robot::MotionSet& limits,
                        double period) {
  const double speed = std::hypot(V_B.vx, V_B.vy);
  const double slower = std::max(0.0, speed - limits.linear_deceleration() * period);
  const double scale = speed > 0.0 ? slower / speed : 0.0;
  const double turning = std::max(0.0, std::abs(V_B.wz) - limits.angular_deceleration() * period);
  return {V_B.vx * scale, V_B.vy * scale, std::copysign(turning, V_B.wz)};
}

bool IsStopped(const geometry::Twist2& V_B, const DwaParams& params) {
  return std::hypot(V_B.vx, V_B.vy) <= params.stopped_linear_velocity &&
         std::abs(V_B.wz) <= params.stopped_angular_velocity;
}

double LinearRamp(const robot::MotionSet& limits) {
  return std::min(limits.max_linear_acceleration, limits.linear_deceleration());
}

double AngularRamp(const robot::MotionSet& limits) {
  return std::min(limits.max_angular_acceleration, limits.angular_deceleration());
}

double TimeToStop(double velocity, double acceleration) {
  return acceleration > 0.0 ? std::abs(velocity) / acceleration : 0.0;
}

double TimeToCover(const geometry::Twist2& V_B, const robot::MotionSet& limits, double period) {
  return period +
         0.5 * std::max(TimeToStop(std::hypot(V_B.vx, V_B.vy), limits.linear_deceleration()),
                        TimeToStop(V_B.wz, limits.angular_deceleration()));
}

double Approach(double now, double wanted, double change) {
  return std::clamp(wanted, now - change, now + change);
}

double Ramped(double commanded, double measured, double wanted, double change) {
  const double lag = kFollowed * change;
  const double now = std::clamp(commanded, measured - lag, measured + lag);
  return Approach(now, wanted, change);
}

}  // namespace hires::navigation
