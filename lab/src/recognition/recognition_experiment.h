#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "lab/src/experiment/experiment.h"
#include "hires/perception/recogniser_config.h"
#include "lab/src/trial/random_tables.h"
#include "lab/src/trial/recognition_score.h"
#include "hires/robot/robot_profile.h"

namespace hires::lab {

/// How well things on random tables are recognised (perception::RandomTables).
struct RecognitionOrder {
  int tables{500};
  std::uint64_t seed{2000};  ///< of the first table; each next one has the next
  robot::Robot robot;
  perception::RecogniserConfig recogniser;  ///< things are drawn from its catalogue
  perception::TableVariety variety;
  /// Told of each table's cloud, as the camera gives it, the robot's own parts in it; by many
  /// threads. Empty: nobody wants them.
  std::function<void(std::uint64_t seed, const perception::PointCloud& cloud)> on_cloud{};
};

struct RecognitionReport {
  int tables{0};
  std::uint64_t seed{0};
  perception::RecognitionScore score;
  perception::TableVariety variety;
  /// Things of the catalogue, looked at by a recogniser that does not know their form; a table
  /// gives those of one form, drawn from all that stand on it.
  std::vector<perception::ThingVerdict> left_out{};
  /// [s] of a core for each cloud, on average, cutting out the robot and its tray included; the one
  /// number that varies.
  double seconds{0.0};
};

/// The same bits for any number of threads.
/// @return nothing when it was cancelled.  @throws base::ConfigError for a robot without a camera.
std::optional<RecognitionReport> TryRecogniser(const RecognitionOrder& order,
                                               const base::Crew& crew);

/// Over distance and torso posture, with 95 % intervals (ClusteredShareInterval, by table); what
/// was confused; the goals beside. What nothing tells is "-", in JSON null.
std::string ReportText(const RecognitionReport& report);
nlohmann::ordered_json ToJson(const RecognitionReport& report);

/// Whether all of the goals are met, of all things, found or not: 98 % found, 95 % named rightly up
/// to equal geometry, unknown ones called so in 95 %; half of the poses within 5 mm, and of the
/// boxes of unknown things middle, both sides and height each within 10 mm for half of them and
/// within 25 mm for 95 %, by the sensor alone. A goal for which there is no value is not met, nor
/// is that of a share whose 95 % interval holds it.
bool MeetsGoals(const RecognitionReport& report);

/// Which goals are missed, undecided or without a value, and how many tables would decide; empty
/// where all are met.
std::string WhyGoalsAreNotMet(const RecognitionReport& report);

}  // namespace hires::lab
