#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "lab/src/experience/experience_runs.h"
#include "hires/base/rng.h"

namespace hires::lab {

/// Which feature of a window that ends half a second before predicts a fall: area under the ROC
/// curve over runs, and a threshold chosen on every other run and judged on the rest; with the
/// numbers of falls and of windows without, by motion set.
nlohmann::ordered_json PredictFalls(const std::vector<ExperienceRun>& runs, const base::Rng& rng);

}  // namespace hires::lab
