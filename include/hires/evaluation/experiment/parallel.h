#pragma once

#include <functional>

#include "hires/evaluation/experiment/experiment.h"

namespace hires::evaluation {

/// How a task says that it got on, in units of its own choice.
using Advance = std::function<void(double units)>;

/// Does tasks 0 .. num_tasks - 1 on the crew's threads, each task on one of them, in any order.
/// @param total_units  what all tasks together will have advanced by; a guess is good enough.
/// @return false if the crew was cancelled: some tasks were then left out or cut short.
/// @throws what a task threw, that of the lowest number if several did, after all threads ended.
bool DoInParallel(int num_tasks, double total_units, const Crew& crew,
                  const std::function<void(int task, const Advance& advance)>& work);

}  // namespace hires::evaluation
