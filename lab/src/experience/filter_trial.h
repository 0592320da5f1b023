#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "lab/src/experience/experience_runs.h"
#include "hires/base/rng.h"

namespace hires::lab {

/// What filters do to a base's motion that is measured with noise (dissertation, section 6.3.1):
/// the window comes from the measured speed's autocorrelation, the truth judges.
nlohmann::ordered_json TryFilters(const std::vector<ExperienceRun>& runs, const base::Rng& rng);

}  // namespace hires::lab
