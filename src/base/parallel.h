#pragma once

#include <functional>

namespace hires::base {

/// Who does a long work that falls into tasks, and who is told.
struct Crew {
  int threads{1};
  std::function<bool()> cancelled{};  ///< asked between tasks, and by tasks; may be empty
  /// Called a few times a second, and at the end, with the share that is done and the time since
  /// the start [s]. May be empty.
  std::function<void(double fraction, double elapsed)> on_progress{};
};

/// How a task says that it got on, in units of its own choice.
using Advance = std::function<void(double units)>;

/// Does tasks 0 .. num_tasks - 1 on the crew's threads, each task on one of them, in any order.
/// @param total_units  what all tasks together will have advanced by; a guess is good enough.
/// @return false if the crew was cancelled: some tasks were then left out or cut short.
/// @throws what a task threw, that of the lowest number if several did, after all threads ended.
bool DoInParallel(int num_tasks, double total_units, const Crew& crew,
                  const std::function<void(int task, const Advance& advance)>& work);

}  // namespace hires::base
