#pragma once

#include <algorithm>
#include <optional>

namespace hires::base {

/// For how long somebody has said nothing, as far as one listened: while the listener was held up
/// itself, by a long request or a full machine, what was said waits to be heard, and is no silence.
class Silence {
 public:
  /// @param limit  [s] of silence after which the other one counts as gone. Nobody is there before
  ///   the first word.
  explicit Silence(double limit) : limit_(limit), silent_(limit) {}

  void Hear() { silent_ = 0.0; }

  /// Call often; a quarter of the limit counts between two calls at most.
  /// @param now  [s] of a steady clock.
  /// @return whether the other one is there.
  bool Look(double now) {
    if (last_look_) silent_ += std::clamp(now - *last_look_, 0.0, limit_ / 4.0);
    last_look_ = now;
    return silent_ < limit_;
  }

 private:
  double limit_, silent_;  // [s]
  std::optional<double> last_look_;
};

}  // namespace hires::base
