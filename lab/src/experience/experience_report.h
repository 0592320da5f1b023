#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hires/knowledge/experience.h"

namespace hires::lab {

/// What is in a store: parts by action and state, falls, episodes, time, size.
/// @param text  the same for people.
nlohmann::ordered_json StatsOf(const knowledge::ExperienceStore& store, std::string* text);

/// What filters do to noisy measurements of these motions, which feature of the base's dynamics
/// predicts a fall half a second ahead, and all that drawings of the dynamics need
/// (dissertation, sections 5.8 and 6.3.1; lab/docs/notes_experiences.md explains the fields).
/// @param seed  of the measurements' noise and of resampling.  @param text  for people.
/// @throws base::ConfigError if there are too few parts.
nlohmann::ordered_json AnalysisOf(const knowledge::ExperienceStore& store, std::uint64_t seed,
                                  std::string* text);

}  // namespace hires::lab
