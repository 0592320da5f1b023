#include "loop/virtual_clock.h"

#include <algorithm>
#include <utility>

namespace hires::loop {

void VirtualClock::At(double time, std::function<void()> act) {
  due_.push({std::max(time, now_), num_asked_++, std::move(act)});
}

bool VirtualClock::Step() {
  if (due_.empty()) return false;
  const Due next = due_.top();
  due_.pop();
  now_ = next.time;
  next.act();
  return true;
}

}  // namespace hires::loop
