#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hires/evaluation/experiment_hypothesis.h"

namespace hires_ros {

/// Plays one run of `hires experiment hypothesis` in a process of its own, which starts the whole
/// system (hypothesis_run.launch) under a new master on loopback, and ends it in whatever way the
/// run ends. A run whose process dies or hangs is recorded as one that broke down. Call it from
/// main().
/// @return nothing when cancelled.
/// @throws hires::base::ConfigError if no run can be started at all.
std::optional<hires::evaluation::HypothesisRun> PlayHypothesisRun(
    const hires::evaluation::HypothesisOrder& order, const std::function<bool()>& cancelled);

/// That process: `hires hypothesis_run ORDER.json RECORD.json FIRST_PORT`. Plays what the first
/// file orders and writes the second one. Runs under a master of its own on FIRST_PORT, its workers
/// on the ports above. SIGTERM, or the end of the process that started it, ends it and its system.
/// @return exit code: 0 if there is a record.
int RunHypothesisProcess(const std::vector<std::string>& words, const std::string& package_folder);

/// Orders as text, to hand them over.
std::string HypothesisOrderText(const hires::evaluation::HypothesisOrder& order);
/// @throws hires::base::ConfigError naming `where` and the field.
hires::evaluation::HypothesisOrder ParseHypothesisOrder(const std::string& text,
                                                        const std::string& where);

constexpr char kHypothesisRunVerb[] = "hypothesis_run";

}  // namespace hires_ros
