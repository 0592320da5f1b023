#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "lab/src/verbs/experiment_decision_command.h"
#include "lab/src/verbs/experiment_detector_command.h"
#include "lab/src/verbs/experiment_hypothesis_command.h"
#include "lab/src/verbs/experiment_ladder_command.h"
#include "lab/src/verbs/experiment_localisation_command.h"
#include "lab/src/verbs/experiment_recognition_command.h"
#include "lab/src/verbs/experiment_torso_poses_command.h"
#include "base/parallel.h"
#include "cli/report_output.h"
#include "lab/src/experiment/experiment.h"

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment`.
struct ExperimentOptions {
  std::string file, map, csv, junit, experiences;
  cli::ReportOptions report;
  std::uint64_t seed{0};
  int threads{0}, runs{0};
  bool quiet{false}, only_hashes{false};
  CLI::App* verb{nullptr};         ///< tells what was given
  HypothesisOptions hypothesis;    ///< of `hires_lab experiment hypothesis`
  DecisionOptions decision;        ///< of `hires_lab experiment decision`
  RecognitionOptions recognition;  ///< of `hires_lab experiment recognition`
  DetectorFitOptions detector;     ///< of `hires_lab experiment detector`
  PoseErrorOptions pose_error;     ///< of `hires_lab experiment localisation`
  LadderOptions ladder;            ///< of `hires_lab experiment ladder`
  TorsoPosesOptions torso_poses;   ///< of `hires_lab experiment torso_poses`
};

/// Adds the verb to the program, with `hypothesis`, `decision` and so on below it.  @pre `options`
/// outlives `app`.
void AddExperimentVerb(CLI::App* app, ExperimentOptions* options);

/// Reads, plays, prints, writes.
/// @return kExitRecommended when all that the file expects holds, kExitAllFailed when not,
/// kExitCancelled.  @throws base::ConfigError for bad input, before anything is played.
int RunExperimentVerb(const ExperimentOptions& options, const std::function<bool()>& cancelled);

/// Below a printed result that other configuration may change: which one it is of.
/// @param hash  by reports::ConfigurationHash.
std::string FilesLine(const std::string& hash);

}  // namespace hires::lab
