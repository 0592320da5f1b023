#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

namespace hires::loop {

constexpr double kStart = 1.0;  ///< [s] of a loop's clock

/// Time that passes as fast as what happens in it can be worked out. What is due is done in the
/// order of its time, and where that is the same in the order in which it was asked for.
class VirtualClock {
 public:
  /// @param start  [s]
  explicit VirtualClock(double start) : now_(start) {}

  double now() const { return now_; }  ///< [s]
  /// Not before now.
  void At(double time, std::function<void()> act);
  void In(double delay, std::function<void()> act) { At(now_ + delay, std::move(act)); }
  /// Does what is due next.  @return false: there is nothing.
  bool Step();

 private:
  double now_;
  std::uint64_t num_asked_{0};
  std::map<std::pair<double, std::uint64_t>, std::function<void()>> due_;  // by time and number
};

}  // namespace hires::loop
