#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hires/evaluation/decision/decision.h"
#include "hires/evaluation/truth.h"
#include "hires/loop/task_loop.h"

namespace hires::cli {

/// Plays one drive of `hires experiment decision`, as it is judged there.
/// @return nothing when cancelled.
std::optional<evaluation::TruthPlay> PlayDrive(const loop::LoopSetup& setup,
                                               const evaluation::Truth& truth,
                                               const evaluation::DecisionTask& task,
                                               const std::string& motion_set, std::uint64_t seed,
                                               const std::function<bool()>& cancelled = {});

}  // namespace hires::cli
