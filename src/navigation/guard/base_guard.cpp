#include "hires/navigation/base_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hires::navigation {
namespace {

using Code = base::FailureCode;

constexpr double kFresh = 0.1;               // [s] a younger speed is the speed now
constexpr double kSlope = 0.06;              // [s] of odometry that tell an acceleration ...
constexpr double kLeastSlope = 0.02;         // [s] ... at least
constexpr std::size_t kMostEnded = 1024;     // requests that are remembered
constexpr double kLeastDeceleration = 0.05;  // [m/s^2] less would take minutes
constexpr double kLeastJerk = 0.1;           // [m/s^3]
const char* const kPoseSources[] = {"odometry", "base_transform", "map_transform"};

bool IsFinite(const geometry::Twist2& V) {
  return std::isfinite(V.vx) && std::isfinite(V.vy) && std::isfinite(V.wz);
}

bool IsZero(const geometry::Twist2& V) { return V.vx == 0.0 && V.vy == 0.0 && V.wz == 0.0; }

/// The velocity within the limits' speeds, its direction kept.
geometry::Twist2 Clipped(const geometry::Twist2& V, const robot::MotionSet& limits) {
  const double speed = std::hypot(V.vx, V.vy), turning = std::abs(V.wz);
  double scale = 1.0;
  if (speed > limits.max_linear_velocity) scale = limits.max_linear_velocity / speed;
  if (turning > limits.max_angular_velocity) {
    scale = std::min(scale, limits.max_angular_velocity / turning);
  }
  return {scale * V.vx, scale * V.vy, scale * V.wz};
}

/// From `V` as far towards `told` as `most` allows, speed and turning each.
geometry::Twist2 Towards(const geometry::Twist2& V, const geometry::Twist2& told, double most) {
  const double x = told.vx - V.vx, y = told.vy - V.vy, w = told.wz - V.wz;
  const double change = std::max(std::hypot(x, y), std::abs(w));
  const double share = change > most ? most / change : 1.0;
  return {V.vx + share * x, V.vy + share * y, V.wz + share * w};
}

base::Failure BadRequest(const DriveRequest& request) {
  const std::string defect = Defect(request);
  return defect.empty() ? base::Failure() : base::Failure(Code::kBadRequest, {}, defect);
}

/// @param limit  [s] up to which it is good, `key` of the guard's parameters.
/// @param advice  what to look at
base::Failure Late(Code code, double age, double limit, const char* key, const char* advice) {
  return {code, {}, fmt::format("{:.2f} s, at most {:g} s ({}); {}", age, limit, key, advice)};
}

constexpr char kOverloaded[] =
    "look whether its computer is overloaded or the network slow (faq: stale codes)";

}  // namespace

std::string Defect(const DriveRequest& request) {
  const std::pair<const char*, double> speeds[] = {
      {"max_linear_velocity", request.limits.max_linear_velocity},
      {"max_angular_velocity", request.limits.max_angular_velocity},
      {"max_linear_acceleration", request.limits.max_linear_acceleration},
      {"max_angular_acceleration", request.limits.max_angular_acceleration}};
  for (const auto& [name, value] : speeds) {
    if (!std::isfinite(value) || value < 0.0) {
      return fmt::format("{} is {}, wanted a number that is not negative", name, value);
    }
  }
  const std::tuple<const char*, double, double> braking[] = {
      {"max_braking", request.braking.max_deceleration, kLeastDeceleration},
      {"max_braking_jerk", request.braking.max_jerk, kLeastJerk}};
  for (const auto& [name, value, least] : braking) {
    if (value != 0.0 && !(std::isfinite(value) && value >= least)) {
      return fmt::format("{} is {}, wanted {} or more, or 0 where it is unknown", name, value,
                         least);
    }
  }
  return "";
}

BaseGuard::BaseGuard(const BaseGuardParams& params) : params_(params) {}

void BaseGuard::OnCommand(const geometry::Twist2& V_B, double now) {
  if (state_ == GuardState::kPassing) command_ = Velocity{V_B, now};
}

void BaseGuard::OnRequest(const DriveRequest& request, double now) {
  if (HasEnded(request.id)) return;
  request_ = request;
  request_time_ = now;
}

void BaseGuard::OnMotorsHalted(bool halted) { motors_halted_ = halted; }

void BaseGuard::OnOdometry(const geometry::Twist2& V_B, double stamp, double now) {
  const double time = std::min(stamp, now);
  if (!IsFinite(V_B) || (!odometry_.empty() && time <= odometry_.back().time)) return;
  pose_stamps_[0] = time;
  odometry_.push_back({V_B, time});
  while (odometry_.front().time < time - kSlope) odometry_.pop_front();
}

void BaseGuard::OnTransform(PoseSource source, double stamp, double now) {
  auto& newest = pose_stamps_[static_cast<std::size_t>(source)];
  const double time = std::min(stamp, now);
  newest = std::max(newest.value_or(time), time);
}

void BaseGuard::OnLocalisation(double position_sd, double yaw_sd) {
  localisation_ = Localisation{position_sd, yaw_sd};
}

void BaseGuard::OnScan(double stamp, double now) {
  const double time = std::min(stamp, now);
  scan_stamp_ = std::max(scan_stamp_.value_or(time), time);
}

std::optional<geometry::Twist2> BaseGuard::Update(double now) {
  const double gap = now - last_update_;
  last_update_ = now;
  if (state_ == GuardState::kPassing) {
    const base::Failure why =
        gap > params_.update_patience
            ? Late(Code::kLateGuard, gap, params_.update_patience, "update_patience", kOverloaded)
            : WhyStop(now);
    why ? Begin(why, now) : FollowRequest();
  }
  if (state_ == GuardState::kStanding) Wait(now);
  auto velocity = state_ == GuardState::kPassing ? Pass(now) : Brake(now);
  if (velocity) sent_ = Velocity{*velocity, now};
  return velocity;
}

std::optional<geometry::Twist2> BaseGuard::Pass(double now) {
  if (!command_) return std::nullopt;
  // A driver that wants to stand may fall silent; one that moves is stopped by then.
  if (now - command_->time > params_.command_patience) return std::nullopt;
  return Clipped(command_->V, active_.limits);
}

std::optional<geometry::Twist2> BaseGuard::Brake(double now) {
  const double elapsed = now - since_;
  if (state_ == GuardState::kBraking && elapsed < stop_->duration()) {
    return stop_->VelocityAt(elapsed);
  }
  if (state_ == GuardState::kBraking) {
    state_ = GuardState::kStanding;
    since_ = now;
  }
  if (stop_ && now - since_ <= params_.zero_time) return geometry::Twist2{};
  return std::nullopt;
}

std::uint64_t BaseGuard::Applicant(double now) const {
  const bool is_alive = now - request_time_ <= params_.request_patience;
  return is_alive && !HasEnded(request_.id) ? request_.id : 0;
}

/// Standing: does somebody want to drive, and may he?
void BaseGuard::Wait(double now) {
  if (is_held_ || Applicant(now) == 0) return;
  base::Failure wrong = BadRequest(request_);
  if (!wrong) wrong = WhatForbidsDriving(now);
  if (!wrong) {
    state_ = GuardState::kPassing;
    active_ = request_;
    command_.reset();
    stop_.reset();
  }
  // Ages grow from update to update; that is no news.
  if (!wrong || current_ != request_.id || wrong != failure_) failure_ = wrong;
  current_ = request_.id;
}

/// Passing: limits may change, and one request may take over from another.
void BaseGuard::FollowRequest() {
  if (request_.id != current_) End(current_);
  current_ = request_.id;
  active_ = request_;
}

base::Failure BaseGuard::WhyNoPose(double now) const {
  std::size_t oldest = 0;
  for (std::size_t i = 0; i < pose_stamps_.size(); ++i) {
    if (!pose_stamps_[i]) return {Code::kNoPose, {}, kPoseSources[i]};
    if (*pose_stamps_[i] < *pose_stamps_[oldest]) oldest = i;
  }
  const double age = now - *pose_stamps_[oldest];
  if (age <= params_.pose_patience) return {};
  return {Code::kStalePose,
          {},
          fmt::format("{:.2f} s, {}; at most {:g} s (pose_patience)", age, kPoseSources[oldest],
                      params_.pose_patience)};
}

base::Failure BaseGuard::WhatForbidsDriving(double now) const {
  if (motors_halted_.value_or(false)) return Code::kMotorsHalted;
  if (hindrance_) return hindrance_;
  if (params_.needs_motors_state && !motors_halted_) return Code::kNoMotorsState;
  if (base::Failure missing = WhyNoPose(now); missing) return missing;
  if (params_.needs_scan && !scan_stamp_) return Code::kNoScan;
  if (params_.needs_scan && now - *scan_stamp_ > params_.scan_patience) {
    return Late(Code::kStaleScan, now - *scan_stamp_, params_.scan_patience, "scan_patience",
                "look at the base laser's topic: `rostopic hz`, `hires doctor --robot`");
  }
  if (!params_.needs_localisation) return {};
  if (!localisation_) return Code::kNoLocalisation;
  if (!(localisation_->position_sd >= 0.0 &&
        localisation_->position_sd <= params_.max_position_sd)) {
    return {Code::kLocalisationLost, {}, fmt::format("sd {:.2f} m", localisation_->position_sd)};
  }
  if (!(localisation_->yaw_sd >= 0.0 && localisation_->yaw_sd <= params_.max_yaw_sd)) {
    return {Code::kLocalisationLost, {}, fmt::format("sd {:.2f} rad", localisation_->yaw_sd)};
  }
  return {};
}

base::Failure BaseGuard::WhyStop(double now) const {
  if (base::Failure wrong = WhatForbidsDriving(now); wrong) return wrong;
  if (now - request_time_ > params_.request_patience) {
    return Late(Code::kSilentMiddleLayer, now - request_time_, params_.request_patience,
                "request_patience", kOverloaded);
  }
  const bool must_wait = is_held_ && request_.id != current_;  // somebody else takes over
  if (request_.id == 0 || must_wait) return Code::kRequestOver;
  if (base::Failure bad = BadRequest(request_); bad) return bad;
  if (!command_) return {};
  if (!IsFinite(command_->V)) return Code::kBadCommand;
  if (!IsZero(command_->V) && now - command_->time > params_.command_patience) {
    return Late(Code::kSilentCommands, now - command_->time, params_.command_patience,
                "command_patience", kOverloaded);
  }
  return {};
}

void BaseGuard::Begin(base::Failure failure, double now) {
  state_ = GuardState::kBraking;
  failure_ = std::move(failure);
  since_ = now;
  End(current_);
  command_.reset();
  geometry::Twist2 V = Clipped(MotionNow(now), active_.limits);
  if (std::hypot(V.vx, V.vy) <= params_.still_speed && std::abs(V.wz) <= params_.still_speed) {
    V = {};
  }
  stop_.emplace(V, AccelerationNow(now), LimitsInForce(), params_.braking);
}

void BaseGuard::End(std::uint64_t id) {
  ended_.push_back(id);
  if (ended_.size() > kMostEnded) ended_.pop_front();
}

bool BaseGuard::HasEnded(std::uint64_t id) const {
  return id != 0 && std::find(ended_.begin(), ended_.end(), id) != ended_.end();
}

/// The measured speed as long as it is fresh, and what the wheels still have to make up; else what
/// the base was told last.
geometry::Twist2 BaseGuard::MotionNow(double now) const {
  const double age = odometry_.empty() ? HUGE_VAL : now - odometry_.back().time;
  const bool was_told = sent_ && now - sent_->time <= params_.command_patience;
  if (age <= kFresh && was_told) return Towards(odometry_.back().V, sent_->V, params_.trailing);
  if (age <= kFresh) return odometry_.back().V;
  if (was_told) return sent_->V;
  return age <= 2.0 * params_.pose_patience ? odometry_.back().V : geometry::Twist2{};
}

geometry::Twist2 BaseGuard::AccelerationNow(double now) const {
  if (odometry_.empty() || now - odometry_.back().time > kFresh) return {};
  const Velocity &first = odometry_.front(), &last = odometry_.back();
  const double dt = last.time - first.time;
  if (dt < kLeastSlope) return {};
  return {(last.V.vx - first.V.vx) / dt, (last.V.vy - first.V.vy) / dt,
          (last.V.wz - first.V.wz) / dt};
}

BrakingLimits BaseGuard::LimitsInForce() const {
  const BrakingLimits &asked = active_.braking, &unknown = params_.braking.unknown_load,
                      &hardest = params_.braking.hardest;
  const auto choose = [](double value, double otherwise, double most) {
    return std::min(value > 0.0 ? value : otherwise, most);
  };
  return {choose(asked.max_deceleration, unknown.max_deceleration, hardest.max_deceleration),
          choose(asked.max_jerk, unknown.max_jerk, hardest.max_jerk)};
}

}  // namespace hires::navigation
