#include "hires/simulation/base_drive.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::simulation {
namespace {

/// The rate of turning that is left of `wz` at a speed [m/s]: all, but for a car-like base, which
/// does not turn more sharply than its steering allows.
double Steered(double wz, double speed, const robot::BaseControllerParams& params) {
  if (params.drive != robot::Drive::kCarLike) return wz;
  const double most = std::abs(speed) / params.min_turning_radius;
  return std::clamp(wz, -most, most);
}

/// As pr2_base_controller: translation keeps its direction, turning is clipped by itself.
geometry::Twist2 ClippedApart(const geometry::Twist2& v, const robot::MotionSet& limits) {
  const double linear = std::hypot(v.vx, v.vy);
  const double scale =
      linear > limits.max_linear_velocity ? limits.max_linear_velocity / linear : 1.0;
  return {scale * v.vx, scale * v.vy,
          std::clamp(v.wz, -limits.max_angular_velocity, limits.max_angular_velocity)};
}

/// What the base can follow: no sideways part where its wheels cannot, no turning but on an arc
/// where it steers like a car; clipped to the controller's limits, the direction kept.
geometry::Twist2 Feasible(geometry::Twist2 v, const robot::BaseControllerParams& params) {
  if (params.casters) return ClippedApart(v, params.limits);
  if (params.drive != robot::Drive::kOmnidirectional) v.vy = 0.0;
  v.wz = Steered(v.wz, v.vx, params);
  const robot::MotionSet& limits = params.limits;
  const double linear = std::hypot(v.vx, v.vy);
  const double scale = std::min({1.0, linear > 0.0 ? limits.max_linear_velocity / linear : 1.0,
                                 v.wz != 0.0 ? limits.max_angular_velocity / std::abs(v.wz) : 1.0});
  return {scale * v.vx, scale * v.vy, scale * v.wz};
}

/// Rate of change of a ramp with limited jerk: never faster than what still lets the acceleration
/// come down to 0 when the target is met, step by step: r dt + (r - jerk dt) dt + ... = distance.
double JerkLimitedRate(double rate, double wanted_rate, double distance, double jerk, double dt) {
  const double half_step = 0.5 * jerk * dt;
  const double bound =
      std::sqrt(half_step * half_step + 2.0 * jerk * std::abs(distance)) - half_step;
  const double reachable = std::clamp(wanted_rate, -bound, bound);
  return std::clamp(reachable, rate - jerk * dt, rate + jerk * dt);
}

/// Steps of at most `step` that a change takes; no change takes none, even if `step` is 0.
double StepsFor(double change, double step) {
  return change == 0.0 ? 0.0 : std::abs(change) / step;
}

}  // namespace

BaseDrive::BaseDrive(const robot::BaseControllerParams& params, const geometry::Pose2& X_MB)
    : params_(params) {
  motion_.X_MB = X_MB;
  if (params.casters) casters_.emplace(*params.casters);
}

void BaseDrive::Send(const geometry::Twist2& velocity, double time) {
  HIRES_CHECK(sent_.empty() || time + params_.command_lag >= sent_.back().effective,
              "a command was sent before an earlier one");
  sent_.push_back({time + params_.command_lag, Feasible(velocity, params_)});
}

void BaseDrive::Receive(double time) {
  while (!sent_.empty() && sent_.front().effective <= time) {
    target_ = sent_.front().velocity;
    last_command_ = sent_.front().effective;
    sent_.pop_front();
  }
}

void BaseDrive::StandAtOnce() {
  for (Axis* axis : {&x_, &y_, &yaw_}) axis->ramp = axis->ramp_rate = 0.0;
}

void BaseDrive::StepRamp(const geometry::Twist2& target, bool is_late, double dt) {
  const double dx = target.vx - x_.ramp, dy = target.vy - y_.ramp, dw = target.wz - yaw_.ramp;
  const robot::MotionSet& limits = params_.limits;
  const double braking = is_late && params_.emergency_deceleration > 0.0
                             ? params_.emergency_deceleration
                             : limits.linear_deceleration();
  const bool slows = x_.ramp * dx + y_.ramp * dy < 0.0, slows_turning = yaw_.ramp * dw < 0.0;
  const double linear = slows ? braking : limits.max_linear_acceleration;
  const double angular =
      slows_turning ? limits.angular_deceleration() : limits.max_angular_acceleration;
  const double steps_needed = std::max(
      {StepsFor(dx, linear * dt), StepsFor(dy, linear * dt), StepsFor(dw, angular * dt), 1.0});
  const auto advance = [&](Axis* axis, double distance, double jerk) {
    double rate = distance / (steps_needed * dt);
    if (jerk > 0.0) rate = JerkLimitedRate(axis->ramp_rate, rate, distance, jerk, dt);
    axis->ramp_rate = rate;
    axis->ramp += rate * dt;
  };
  advance(&x_, dx, params_.max_linear_jerk);
  advance(&y_, dy, params_.max_linear_jerk);
  advance(&yaw_, dw, 0.0);
}

void BaseDrive::StepAxis(Axis* axis, double grip, double dt) const {
  const double wanted = grip * axis->ramp;
  if (params_.loop_frequency == 0.0) {
    axis->acceleration = (wanted - axis->velocity) / dt;
    axis->velocity = wanted;
    return;
  }
  const double w = params_.loop_frequency;
  axis->acceleration += dt * (w * w * (wanted - axis->velocity) -
                              2.0 * params_.loop_damping * w * axis->acceleration);
  axis->velocity += dt * axis->acceleration;
}

/// A wheel that slips rolls farther than the base comes: what is asked of the base is so much less.
void BaseDrive::StepCasters(double grip, double traction, double dt) {
  geometry::Twist2 V_B{x_.velocity, y_.velocity, yaw_.velocity};
  casters_->Step({grip * x_.ramp, grip * y_.ramp, grip * yaw_.ramp}, traction, dt, &V_B);
  const auto take = [dt](Axis* axis, double velocity) {
    axis->acceleration = (velocity - axis->velocity) / dt;
    axis->velocity = velocity;
  };
  take(&x_, V_B.vx);
  take(&y_, V_B.vy);
  take(&yaw_, V_B.wz);
}

/// Between two commands, too: a ramp from an arc forward to one backward would turn on the spot
/// halfway, and a loop that oscillates would overshoot the arc.
void BaseDrive::KeepToArc(const Axis& yaw_before, double dt) {
  yaw_.ramp = Steered(yaw_.ramp, x_.ramp, params_);
  const double most = Steered(yaw_.velocity, x_.velocity, params_);
  if (most == yaw_.velocity) return;
  yaw_.velocity = most;
  yaw_.acceleration = (most - yaw_before.velocity) / dt;
}

/// Wheels that lose their grip still roll as the ramp asks for, but the base does not follow.
void BaseDrive::SlideAxes(const Axes& before, double traction, double dt) {
  const double linear = std::hypot(x_.acceleration, y_.acceleration);
  const double angular = kTurningArm * std::abs(yaw_.acceleration);
  const auto slide = [&](Axis* axis, const Axis& old, double wanted) {
    if (wanted <= traction) return;
    axis->acceleration *= traction / wanted;
    axis->velocity = old.velocity + dt * axis->acceleration;
  };
  slide(&x_, before[0], linear);
  slide(&y_, before[1], linear);
  slide(&yaw_, before[2], angular);
}

void BaseDrive::AddPush(double dt) {
  x_.velocity += dt * push_->vx;
  y_.velocity += dt * push_->vy;
  yaw_.velocity += dt * push_->wz;
}

geometry::Twist2 BaseDrive::Acceleration() const {
  const geometry::Twist2 own{x_.acceleration, y_.acceleration, yaw_.acceleration};
  if (!push_) return own;
  return {own.vx + push_->vx, own.vy + push_->vy, own.wz + push_->wz};
}

double BaseDrive::StepLean(Lean* lean, double acceleration, double dt) const {
  const double w = params_.sway_frequency;
  const double rest = params_.sway_compliance * acceleration;
  lean->rate += dt * (w * w * (rest - lean->angle) - 2.0 * params_.sway_damping * w * lean->rate);
  lean->angle += dt * lean->rate;
  return lean->angle;
}

void BaseDrive::Step(double time, double dt, double slip, double traction) {
  Receive(time);
  const bool is_late = time - last_command_ > params_.command_timeout;
  // Once it stands there is nothing left to brake.
  motion_.timed_out = is_late && (x_.ramp != 0.0 || y_.ramp != 0.0 || yaw_.ramp != 0.0);
  if (is_late && params_.stops_at_timeout) {
    StandAtOnce();
  } else {
    StepRamp(is_late ? geometry::Twist2{} : target_, is_late, dt);
  }
  const Axes before{x_, y_, yaw_};
  if (casters_) {
    StepCasters(1.0 - slip, traction, dt);
  } else {
    for (Axis* axis : {&x_, &y_, &yaw_}) StepAxis(axis, 1.0 - slip, dt);
  }
  if (params_.drive == robot::Drive::kCarLike) KeepToArc(before[2], dt);
  if (traction < std::numeric_limits<double>::infinity()) SlideAxes(before, traction, dt);
  if (push_) AddPush(dt);
  motion_.V_B = {x_.velocity, y_.velocity, yaw_.velocity};
  motion_.A_B = Acceleration();
  // Braking (negative acceleration) leans the nose down; accelerating to the left leans the body
  // to the right.
  motion_.pitch = StepLean(&pitch_, -motion_.A_B.vx, dt);
  motion_.roll = StepLean(&roll_, motion_.A_B.vy, dt);

  const double yaw = motion_.X_MB.yaw + 0.5 * dt * motion_.V_B.wz;
  const double c = std::cos(yaw), s = std::sin(yaw);
  motion_.X_MB.x += dt * (c * motion_.V_B.vx - s * motion_.V_B.vy);
  motion_.X_MB.y += dt * (s * motion_.V_B.vx + c * motion_.V_B.vy);
  motion_.X_MB.yaw = geometry::WrapToPi(motion_.X_MB.yaw + dt * motion_.V_B.wz);
}

}  // namespace hires::simulation
