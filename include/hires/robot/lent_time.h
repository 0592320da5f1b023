#pragma once

#include <algorithm>

namespace hires::robot {

/// How long readings of a motion may have taken that may come late in a burst, stamped when they
/// were sent: their steps may take time of the hole before the burst.
class LentTime {
 public:
  /// [s] that a step may have taken of which stamps say `duration` [s]. No step of a burst holds
  /// more than readings that come in time do.
  double For(double duration) const { return duration + std::min(left_, UsualFor(duration)); }

  /// @param needed  [s] by the fastest robot, for the same step.
  void Take(double duration, double needed) {
    left_ += std::max(duration - UsualFor(duration), 0.0);
    left_ = std::clamp(left_ - std::max(needed - duration, 0.0), 0.0, kLongest);
    sum_ += duration;
    ++num_;
  }

  void Forget() { left_ = 0.0; }  ///< all holes so far

 private:
  static constexpr double kLongest = 10.0;  // [s] of holes that count

  double UsualFor(double duration) const { return num_ > 0 ? 2.0 * sum_ / num_ : duration; }

  double sum_{0.0};   // [s] between readings so far
  int num_{0};        // of them
  double left_{0.0};  // [s] of holes, that no motion has used
};

}  // namespace hires::robot
