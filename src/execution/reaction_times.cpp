#include "hires/execution/reaction_times.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::execution {

void ReactionTimes::Add(double seconds) {
  if (times_.size() < kMost) {
    times_.push_back(seconds);
  } else {
    times_[next_] = seconds;
    next_ = (next_ + 1) % kMost;
  }
}

double ReactionTimes::Quantile(double share) const {
  HIRES_CHECK(0.0 < share && share <= 1.0, "a share lies in (0, 1]");
  if (times_.empty()) return 0.0;
  std::vector<double> sorted = times_;
  const auto rank =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()) - 1e-9));
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

}  // namespace hires::execution
