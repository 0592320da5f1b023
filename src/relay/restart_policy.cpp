#include "hires/relay/restart_policy.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::relay {

RestartPolicy::RestartPolicy(const RestartLimits& limits) : limits_(limits) {
  HIRES_CHECK(limits.first_delay > 0.0 && limits.longest_delay >= limits.first_delay,
              "restart delays are above 0 s and the longest is not the shortest");
}

void RestartPolicy::OnStarted(double now) { started_at_ = now; }

std::optional<double> RestartPolicy::OnDied(double now) {
  if (now - started_at_ >= limits_.stable_after) num_in_a_row_ = 0;
  if (num_in_a_row_ >= limits_.most_in_a_row) return std::nullopt;
  const double delay =
      std::min(std::ldexp(limits_.first_delay, num_in_a_row_), limits_.longest_delay);
  ++num_in_a_row_;
  ++num_restarts_;
  return now + delay;
}

}  // namespace hires::relay
