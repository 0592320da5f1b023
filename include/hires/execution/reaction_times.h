#pragma once

#include <cstddef>
#include <vector>

namespace hires::execution {

/// How long it takes from an event to what is done about it: of the latest thousand.
class ReactionTimes {
 public:
  void Add(double seconds);
  std::size_t size() const { return times_.size(); }
  /// The time [s] that `share` of them do not exceed (nearest rank); 0 where there are none.
  /// @pre 0 < share <= 1.
  double Quantile(double share) const;

 private:
  static constexpr std::size_t kMost = 1000;
  std::vector<double> times_;
  std::size_t next_{0};
};

}  // namespace hires::execution
