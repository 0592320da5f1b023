#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lab/src/experiment/hypothesis.h"
#include "loop/task_loop.h"

namespace hires::lab {

/// Plays one run of `hires_lab experiment hypothesis --local` in this process, in virtual time; runs of
/// one setup may be played on several threads at once. Pace, workers and wall-clock limits of the
/// order are not heeded: config/loop.yaml says how long imagining takes.
/// @param truth  as LoopOrder::truth.
/// @return nothing when cancelled.
std::optional<HypothesisRun> PlayHypothesisLocally(
    const loop::LoopSetup& setup, const std::string& package_folder, const std::string& truth,
    const HypothesisOrder& order, const std::function<bool()>& cancelled);

}  // namespace hires::lab
