#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hires/evaluation/experiment.h"
#include "hires/perception/recogniser_config.h"
#include "hires/perception/recognition_score.h"
#include "hires/robot/robot_profile.h"

namespace hires::evaluation {

/// How well things on random tables are recognised (perception::RandomTables).
struct RecognitionOrder {
  int tables{500};
  std::uint64_t seed{2000};  ///< of the first table; each next one has the next
  robot::Robot robot;
  std::string objects;  ///< path of the catalogue that things are drawn from
  perception::RecogniserConfig recogniser;
};

struct RecognitionReport {
  int tables{0};
  std::uint64_t seed{0};
  perception::RecognitionScore score;
  double seconds{0.0};  ///< [s] of a core for each cloud, on average; the one number that varies
};

/// The same bits for any number of threads.
/// @return nothing when it was cancelled.  @throws base::ConfigError for a robot without a camera.
std::optional<RecognitionReport> TryRecogniser(const RecognitionOrder& order, const Crew& crew);

/// Over distance and torso posture, with 95 % intervals; what was confused; the goals beside.
std::string ReportText(const RecognitionReport& report);
nlohmann::ordered_json ToJson(const RecognitionReport& report);

/// Whether all of the goals are met: 98 % found, 95 % named rightly, unknown ones called so in 95
/// %, half of the poses within 5 mm.
bool MeetsGoals(const RecognitionReport& report);

}  // namespace hires::evaluation
