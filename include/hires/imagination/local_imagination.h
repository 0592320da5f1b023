#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/scheduler.h"

namespace hires::imagination {

/// Plays rollout `index` of an alternative, as PlayRollout does.  @return nothing when cancelled.
using PlayOne = std::function<std::optional<RolloutResult>(int alternative, int index,
                                                           const RolloutHooks& hooks)>;

/// Imagines in this process: `num_threads` workers, each with simulators of its own. The answer
/// does not depend on their number.
/// @param cancelled  asked a few times a second; may be empty.
/// @throws base::ConfigError as CheckSetup, before anything is played.
Report ImagineLocally(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                      const SchedulerParams& params, int num_threads,
                      const OnInterim& on_interim = {},
                      const std::function<bool()>& cancelled = {});

/// The same with rollouts that somebody else plays, for example once for several requests.
/// @param play  called by `num_threads` threads at once.
Report ImagineLocally(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                      const SchedulerParams& params, int num_threads, const PlayOne& play,
                      const OnInterim& on_interim = {},
                      const std::function<bool()>& cancelled = {});

}  // namespace hires::imagination
