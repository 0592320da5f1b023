#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lab/src/decision/decision.h"
#include "sim_robot/truth.h"
#include "loop/task_loop.h"

namespace hires::lab {

/// Plays one drive of `hires_lab experiment decision`, as it is judged there.
/// @return nothing when cancelled.
std::optional<TruthPlay> PlayDrive(const loop::LoopSetup& setup,
                                               const sim_robot::Truth& truth,
                                               const DecisionTask& task,
                                               const std::string& motion_set, std::uint64_t seed,
                                               const std::function<bool()>& cancelled = {});

}  // namespace hires::lab
