#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lab/src/experiment/hypothesis.h"

namespace hires::lab {

/// The verb of `hires` that plays one run: `hires hypothesis_run ORDER.json RECORD.json
/// FIRST_PORT`.
constexpr char kHypothesisRunVerb[] = "hypothesis_run";

/// Plays one run of `hires_lab experiment hypothesis` in a process of its own, which starts the whole
/// system (hypothesis_run.launch) under a new master on loopback, and ends it in whatever way the
/// run ends. A run whose process dies or hangs is recorded as one that broke down. Call it from
/// main().
/// @return nothing when cancelled.
/// @throws base::ConfigError if no run can be started at all.
std::optional<HypothesisRun> PlayHypothesisRun(const HypothesisOrder& order,
                                                           const std::function<bool()>& cancelled);

/// Orders as text, to hand them over.
std::string HypothesisOrderText(const HypothesisOrder& order);
/// @throws base::ConfigError naming `where` and the field.
HypothesisOrder ParseHypothesisOrder(const std::string& text, const std::string& where);

}  // namespace hires::lab
