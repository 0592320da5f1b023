#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "lab/src/experiment/experiment.h"
#include "hires/perception/detector_errors.h"
#include "hires/perception/recogniser_config.h"
#include "lab/src/trial/recognition_score.h"
#include "hires/robot/robot_profile.h"

namespace hires::lab {

/// How a recogniser errs on random tables (perception::RandomTables): farther away, more hidden and
/// more crowded than those of RecognitionOrder, and each looked at twice.
struct DetectorFitOrder {
  int tables{1000};
  int held_out{500};         ///< more tables, to try the fit on
  std::uint64_t seed{5000};  ///< of the first table; each next one has the next
  robot::Robot robot;
  perception::RecogniserConfig recogniser;  ///< things are drawn from its catalogue
};

/// Two looks at one thing.
struct TwoLooks {
  perception::ThingVerdict first, second;
};

/// How well the fit says what happens on tables that it was not made from.
struct FitCheck {
  std::string part;  ///< of the things
  int num_looks{0};
  int num_found{0}, num_named{0};  ///< as it happened
  double found{0.0}, named{0.0};   ///< as many were expected by the fit
  /// [m] medians, of known ones named rightly; these three are not a number where there are none.
  double median_error{0.0}, expected{0.0};
  double beyond{0.0};  ///< share of these beyond the fit's 95 % quantile
};

struct DetectorFitReport {
  int tables{0}, held_out{0};
  std::uint64_t seed{0};
  std::string objects, recogniser;  ///< names of what was tried
  std::string hash;                 ///< FitHashOf
  int num_things{0};                ///< looks at, of the fit
  int num_found{0}, num_named{0}, num_merged{0};
  perception::DetectorErrors errors;
  std::vector<FitCheck> checks;
  std::vector<std::string> empty_parts;  ///< of the things, at which no look was: without a check
  /// Per look of the held-out tables: log likelihood of the fit less that of constant shares.
  double gain_found{0.0}, gain_named{0.0};
};

/// What tables of the fit are like.
perception::TableVariety FitVariety();

/// Of all that a fit depends on but the code: models, robot, parameters of the recogniser and the
/// sensor, and what tables are like. A fit of another hash is out of date.
std::string FitHashOf(const DetectorFitOrder& order);

/// @throws base::ConfigError where nothing was found or nothing named rightly.
perception::DetectorErrors FitDetector(const std::vector<TwoLooks>& things,
                                       const perception::RecognitionScore& kinds);

/// The same bits for any number of threads.
/// @return nothing when it was cancelled.  @throws base::ConfigError for a robot without a camera,
/// and as FitDetector.
std::optional<DetectorFitReport> FitDetector(const DetectorFitOrder& order, const base::Crew& crew);

std::string ReportText(const DetectorFitReport& report);
nlohmann::ordered_json ToJson(const DetectorFitReport& report);
/// A file like config/detector.yaml, with a head that says where it comes from.
std::string ToYaml(const DetectorFitReport& report);

}  // namespace hires::lab
