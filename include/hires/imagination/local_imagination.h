#pragma once

#include <functional>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/scheduler.h"

namespace hires::imagination {

/// Imagines in this process: `num_threads` workers, each with simulators of its own. The answer
/// does not depend on their number.
/// @param cancelled  asked a few times a second; may be empty.
/// @throws base::ConfigError as CheckSetup, before anything is played.
Report ImagineLocally(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                      const SchedulerParams& params, int num_threads,
                      const OnInterim& on_interim = {},
                      const std::function<bool()>& cancelled = {});

}  // namespace hires::imagination
