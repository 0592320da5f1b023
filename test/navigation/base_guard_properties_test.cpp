#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "hires/navigation/base_guard.h"
#include "support/property.h"

// What holds for the guard of the base whatever comes in whatever order: lost messages, late ones,
// requests that change, a driver that asks for anything.

namespace hires::navigation::base_guard_properties_test {
namespace {

using geometry::Twist2;

constexpr hires::test_support::PropertyCases kPropertyCases{300};

constexpr double kSlack = 1e-9;

/// Everything that can happen between two updates.
struct Event {
  int kind{0};
  double value{0.0}, other{0.0};
  int id{0};
};
constexpr int kKinds = 9;

double InRange(double lower, double upper) {
  return lower + (upper - lower) * 1e-3 * *rc::gen::inRange(0, 1001);
}

Event AnyEvent() {
  return {*rc::gen::inRange(0, kKinds), InRange(-1.0, 1.0), InRange(-1.5, 1.5),
          *rc::gen::inRange(0, 4)};
}

/// A world that is well but for a few things that happen.
class Play {
 public:
  explicit Play(const BaseGuardParams& params) : params_(params), guard_(params) {
    guard_.OnMotorsHalted(false);
    guard_.OnLocalisation(0.05, 0.03);
  }

  void Run(int num_ticks) {
    for (int i = 0; i < num_ticks; ++i) {
      const bool is_quiet = i < 5;  // it drives before anything happens
      const double dt = *rc::gen::weightedElement<double>({{30, 0.02}, {3, 0.05}, {1, 0.4}});
      now_ += dt;
      if (!is_quiet && *rc::gen::inRange(0, 12) == 0) Happen(AnyEvent());
      Report();
      const GuardState before = guard_.state();
      const auto sent = guard_.Update(now_);
      Check(before, sent);
      if (sent) motion_ = *sent;
    }
  }

  bool has_driven() const { return !driven_.empty(); }

 private:
  void Happen(const Event& event) {
    switch (event.kind) {
      case 0:
        halted_ = !halted_;
        guard_.OnMotorsHalted(halted_);
        break;
      case 1:
        has_odometry_ = !has_odometry_;
        break;
      case 2:
        has_transforms_ = !has_transforms_;
        break;
      case 3:
        has_scan_ = !has_scan_;
        break;
      case 4:
        lost_ = !lost_;
        guard_.OnLocalisation(lost_ ? 1.0 : 0.1, 0.05);
        break;
      case 5:
        has_request_ = !has_request_;
        break;
      case 6:  // somebody wants to drive
        request_.id = static_cast<std::uint64_t>(event.id == 0 ? 0 : next_id_++);
        request_.limits = {std::abs(event.value), std::abs(event.other), 1.0, 1.0};
        request_.braking = {std::abs(event.value) + 0.1, std::abs(event.other) + 0.5};
        break;
      case 7:  // an old one comes again
        request_.id = static_cast<std::uint64_t>(1 + event.id);
        break;
      default:
        command_ = {event.value, 0.3 * event.value, event.other};
        has_command_ = event.id > 0;
    }
  }

  void Report() {
    if (has_odometry_) guard_.OnOdometry(motion_, odometry_ = now_ - 0.01, now_);
    if (has_transforms_) {
      guard_.OnTransform(PoseSource::kBaseTransform, transform_ = now_ - 0.02, now_);
      guard_.OnTransform(PoseSource::kMapTransform, now_ + 0.1, now_);
    }
    if (has_scan_) guard_.OnScan(scan_ = now_ - 0.03, now_);
    if (has_request_ && !IsOver(request_.id)) {
      asked_ = now_;
      heard_ = request_;
    }
    if (has_request_) guard_.OnRequest(request_, now_);
    if (has_command_) guard_.OnCommand(command_, now_);
  }

  /// Of a request that has driven and does no longer.
  bool IsOver(std::uint64_t id) const {
    const bool drives = guard_.state() == GuardState::kPassing && guard_.request() == id;
    return !drives && driven_.count(id) > 0;
  }

  bool AllIsWell() const {
    return !halted_ && !lost_ && now_ - odometry_ <= params_.pose_patience &&
           now_ - transform_ <= params_.pose_patience && now_ - scan_ <= params_.scan_patience &&
           now_ - asked_ <= params_.request_patience;
  }

  void Check(GuardState before, const std::optional<Twist2>& sent) {
    const GuardState after = guard_.state();
    if (after == GuardState::kPassing) CheckPassing(before, sent);
    if (after == GuardState::kBraking) CheckBraking(before, sent);
    if (after == GuardState::kStanding) CheckStanding(before, sent);
    if (after != GuardState::kBraking) braked_.clear();
  }

  void CheckPassing(GuardState before, const std::optional<Twist2>& sent) {
    RC_ASSERT(!guard_.failure());
    RC_ASSERT(guard_.request() == heard_.id && heard_.id != 0);
    if (before != GuardState::kPassing) {
      RC_ASSERT(before == GuardState::kStanding);  // never out of the middle of a ramp
      RC_ASSERT(AllIsWell());
      RC_ASSERT(driven_.count(guard_.request()) == 0u);  // only a request that is new
    }
    driven_.insert(guard_.request());
    if (sent) CheckSpeed(*sent);
    limits_ = heard_;
  }

  void CheckSpeed(const Twist2& V) const {
    RC_ASSERT(std::hypot(V.vx, V.vy) <= heard_.limits.max_linear_velocity + kSlack);
    RC_ASSERT(std::abs(V.wz) <= heard_.limits.max_angular_velocity + kSlack);
  }

  void CheckBraking(GuardState before, const std::optional<Twist2>& sent) {
    RC_ASSERT(sent.has_value());
    RC_ASSERT(bool(guard_.failure()));
    if (before != GuardState::kBraking) {
      RC_ASSERT(before == GuardState::kPassing);
      began_ = now_;
      stop_time_ = guard_.stop_time();
      RC_ASSERT(std::hypot(sent->vx, sent->vy) <= limits_.limits.max_linear_velocity + kSlack);
      RC_ASSERT(std::abs(sent->wz) <= limits_.limits.max_angular_velocity + kSlack);
    }
    RC_ASSERT(now_ - began_ < stop_time_);
    RC_ASSERT(guard_.stop_time() == stop_time_);
    braked_.push_back({now_, *sent});
    CheckRamp();
  }

  /// Of the last samples: slower all the time, within deceleration and jerk.
  void CheckRamp() const {
    const std::size_t n = braked_.size();
    if (n < 2) return;
    const double most =
        std::min(limits_.braking.max_deceleration, params_.braking.hardest.max_deceleration);
    const double jerk = std::min(limits_.braking.max_jerk, params_.braking.hardest.max_jerk);
    const double last = Slope(n - 2);
    RC_ASSERT(last >= -kSlack);
    RC_ASSERT(last <= most + 1e-6);
    if (n < 3) return;
    const double apart = 0.5 * (braked_[n - 1].time - braked_[n - 3].time);
    RC_ASSERT(std::abs(last - Slope(n - 3)) <= jerk * apart + 1e-6);
  }

  double Slope(std::size_t i) const {
    const Sample &a = braked_[i], &b = braked_[i + 1];
    return (std::hypot(a.V.vx, a.V.vy) - std::hypot(b.V.vx, b.V.vy)) / (b.time - a.time);
  }

  void CheckStanding(GuardState before, const std::optional<Twist2>& sent) {
    RC_ASSERT(bool(guard_.failure()));
    if (sent) RC_ASSERT(sent->vx == 0.0 && sent->vy == 0.0 && sent->wz == 0.0);
    if (before == GuardState::kBraking) RC_ASSERT(now_ - began_ >= stop_time_);
  }

  struct Sample {
    double time;
    Twist2 V;
  };
  BaseGuardParams params_;
  BaseGuard guard_;
  double now_{10.0}, odometry_{0.0}, transform_{0.0}, scan_{0.0}, asked_{0.0};
  DriveRequest request_{1, {0.55, 1.0, 2.5, 3.2}, {1.2, 3.5}};
  DriveRequest heard_, limits_;  // the last that counts, and when it drove last
  std::uint64_t next_id_{2};
  std::set<std::uint64_t> driven_;
  bool halted_{false}, lost_{false}, has_odometry_{true}, has_transforms_{true}, has_scan_{true},
      has_request_{true}, has_command_{true};
  Twist2 command_{0.5, 0.0, 0.2}, motion_;
  std::vector<Sample> braked_;
  double began_{0.0}, stop_time_{0.0};
};

HIRES_PROPERTY(BaseGuardProperties, WhateverHappensTheBaseIsGentleAndStops, ()) {
  Play play{BaseGuardParams{}};
  play.Run(400);
  RC_ASSERT(play.has_driven());
}

/// With everything gone for good, the base stands after patience and the stated time.
HIRES_PROPERTY(BaseGuardProperties, ItStandsWithinTheStatedTime, ()) {
  const BaseGuardParams params;
  BaseGuard guard(params);
  DriveRequest request{5, {InRange(0.05, 1.0), InRange(0.1, 2.0), 1.0, 1.0}, {}};
  request.braking = {InRange(0.1, 3.0), InRange(0.5, 20.0)};
  const Twist2 command{InRange(-1.0, 1.0), InRange(-1.0, 1.0), InRange(-2.0, 2.0)};
  guard.OnMotorsHalted(false);
  guard.OnLocalisation(0.1, 0.1);
  double now = 1.0;
  std::optional<Twist2> sent;
  for (; now < 2.0; now += 0.02) {
    guard.OnOdometry(sent.value_or(Twist2{}), now, now);
    guard.OnTransform(PoseSource::kBaseTransform, now, now);
    guard.OnTransform(PoseSource::kMapTransform, now, now);
    guard.OnScan(now, now);
    guard.OnRequest(request, now);
    guard.OnCommand(command, now);
    sent = guard.Update(now);
  }
  RC_ASSERT(guard.state() == GuardState::kPassing);
  const double died = now;
  while (guard.state() == GuardState::kPassing) {
    sent = guard.Update(now += 0.02);
    RC_ASSERT(now - died <= params.request_patience + 0.04);
  }
  const double bound = now + guard.stop_time() + 0.03;
  while (guard.state() == GuardState::kBraking) {
    sent = guard.Update(now += 0.02);
    RC_ASSERT(now <= bound);
  }
  RC_ASSERT(sent.has_value() && sent->vx == 0.0 && sent->vy == 0.0 && sent->wz == 0.0);
}

}  // namespace
}  // namespace hires::navigation::base_guard_properties_test
