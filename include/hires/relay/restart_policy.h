#pragma once

#include <optional>

namespace hires::relay {

struct RestartLimits {
  double first_delay{0.1};     ///< [s] before the first restart; doubles with each one that follows
  double longest_delay{10.0};  ///< [s] where the doubling ends
  double stable_after{30.0};   ///< [s] of life after which earlier deaths are forgiven
  int most_in_a_row{10};       ///< restarts without a stable life between them; then it gives up
};

/// When to start again what died: soon at first, then later and later, and only so many times.
class RestartPolicy {
 public:
  explicit RestartPolicy(const RestartLimits& limits);

  void OnStarted(double now);  ///< @param now [s] on a clock that never jumps

  /// The time at which to start again, or nothing: too many deaths in a row.
  std::optional<double> OnDied(double now);

  int num_restarts() const { return num_restarts_; }  ///< all that OnDied granted

 private:
  RestartLimits limits_;
  double started_at_{0.0};
  int num_in_a_row_{0};
  int num_restarts_{0};
};

}  // namespace hires::relay
