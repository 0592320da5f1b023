#pragma once

#include <optional>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "sim_robot/truth.h"

namespace hires::sim_robot {

/// When somebody bumps into the base, from where and how hard: independent of everything else.
class BumpSchedule {
 public:
  BumpSchedule(const Bumps& bumps, const base::Rng& rng);

  /// What the base's velocity gains [m/s^2] at `time` [s], in its own frame: half a sine wave.
  /// Nothing between bumps.  @pre times do not decrease.
  std::optional<geometry::Twist2> PushAt(double time);

 private:
  void DrawNext(double after);

  Bumps bumps_;
  base::Rng rng_;
  double begin_{0.0};    // [s] of the next bump, or of this one
  double speed_{0.0};    // [m/s]
  double bearing_{0.0};  // [rad]
};

}  // namespace hires::sim_robot
