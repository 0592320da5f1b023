#pragma once

#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace hires::loop {

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
  struct Due {
    double time;
    std::uint64_t number;
    std::function<void()> act;
    bool operator<(const Due& other) const {  // the queue's top is the largest
      return time != other.time ? time > other.time : number > other.number;
    }
  };
  double now_;
  std::uint64_t num_asked_{0};
  std::priority_queue<Due> due_;
};

}  // namespace hires::loop
