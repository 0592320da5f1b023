#include "loop/virtual_clock.h"

#include <algorithm>
#include <utility>

namespace hires::loop {

void VirtualClock::At(double time, std::function<void()> act) {
  due_.emplace(std::make_pair(std::max(time, now_), num_asked_++), std::move(act));
}

bool VirtualClock::Step() {
  if (due_.empty()) return false;
  const auto next = due_.extract(due_.begin());
  now_ = next.key().first;
  next.mapped()();
  return true;
}

}  // namespace hires::loop
