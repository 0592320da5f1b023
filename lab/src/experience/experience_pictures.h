#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "lab/src/experience/experience_runs.h"

namespace hires::lab {

/// All that drawings of the dynamics need (Figures 5.16 to 5.18, A.2 to A.14): distributions,
/// points of tilt over motion, stretches around a fall and a shaking, the places of falls.
nlohmann::ordered_json PicturesOf(const std::vector<ExperienceRun>& runs);

}  // namespace hires::lab
