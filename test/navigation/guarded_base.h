#pragma once

#include <optional>

#include "hires/navigation/base_guard.h"

namespace hires::navigation::test_support {

constexpr double kTick = 0.02;  // [s] of the guard's updates

/// A guard with everything around it in order, ticked at 50 Hz; single things can be silenced.
struct GuardedBase {
  explicit GuardedBase(const BaseGuardParams& params = {}) : guard(params) {
    request.id = 1;
    request.limits = {0.55, 1.0, 2.5, 3.2};
    request.braking = {1.2, 3.5};
    guard.OnMotorsHalted(false);
    guard.OnLocalisation(0.05, 0.03);
  }

  /// One tick: what is not silenced speaks, then the guard says what goes to the base.
  std::optional<geometry::Twist2> Tick() {
    now += kTick;
    if (has_odometry) guard.OnOdometry(measured, now, now);
    if (has_base_transform) guard.OnTransform(PoseSource::kBaseTransform, now, now);
    if (has_map_transform) guard.OnTransform(PoseSource::kMapTransform, now, now);
    if (has_scan) guard.OnScan(now, now);
    if (has_request) guard.OnRequest(request, now);
    if (command) guard.OnCommand(*command, now);
    sent = guard.Update(now);
    if (sent) measured = *sent;  // a base that follows at once
    return sent;
  }

  void TickFor(double duration) {
    for (const double end = now + duration; now < end - 0.5 * kTick;) Tick();
  }

  /// Until it drives at `V`.
  void Drive(const geometry::Twist2& V) {
    command = V;
    TickFor(0.5);
  }

  BaseGuard guard;
  double now{100.0};
  DriveRequest request;
  std::optional<geometry::Twist2> command;
  geometry::Twist2 measured;
  std::optional<geometry::Twist2> sent;
  bool has_odometry{true}, has_base_transform{true}, has_map_transform{true}, has_scan{true},
      has_request{true};
};

}  // namespace hires::navigation::test_support
