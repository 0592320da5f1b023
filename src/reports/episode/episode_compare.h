#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "hires/imagination/evidence.h"
#include "reports/episode/episode_steps.h"

namespace hires::reports {

/// What imagination says of a step.
struct ImaginedAction {
  imagination::Evidence evidence;
  std::string refusal;  ///< why it could not be imagined; empty: it was
};

/// What prediction and event say together.
enum class StepVerdict {
  kAsImagined,
  kFaster,            ///< than all but a `surprise` of what was imagined
  kSlower,            ///< likewise
  kTooFewDurations,   ///< success as imagined; none of so few durations could have been a surprise
  kFailedAgainst,     ///< it failed, and imagination was sure of more successes than failures
  kSucceededAgainst,  ///< likewise the other way round
  kUndecided,         ///< imagination was sure of neither
  kNotCompared        ///< see `why`
};
std::string ToString(StepVerdict verdict);  ///< "as imagined", "slower", ...

/// A step beside what was imagined of it.
struct ComparedStep {
  EpisodeStep step;
  ImaginedAction imagined;
  StepVerdict verdict{StepVerdict::kNotCompared};
  std::optional<double> percentile;  ///< of its duration among those imagined, 0 .. 100
  std::string why;                   ///< of kNotCompared
};

/// Puts both together. Success of an action is what the robot said of it; that of a rollout also
/// asks that nothing fell; void ones (physics_broke) are left out. The interval is sure of what it
/// has wholly on one side of 1/2. Durations are compared where it succeeded: the chance of so low
/// (or high) a rank among n imagined ones is that of a further one of them, (k + 1) / (n + 1), so
/// that few rollouts can show no surprise.
ComparedStep CompareStep(const EpisodeStep& step, const ImaginedAction& imagined, double surprise);

/// How a step is imagined.
struct ReplayParams {
  int rollouts{64};
  std::uint64_t seed{1};  ///< that of a step is this and the step's place
};

/// Plays all rollouts of one step in this process; the same for any number of threads.
/// @return nothing when it was cancelled.
std::optional<ImaginedAction> ImagineStep(const imagination::ImaginationSetup& setup,
                                          const EpisodeStep& step, const ReplayParams& params,
                                          std::uint64_t place, const base::Crew& crew);

/// One line for each step: what was imagined, what happened, verdict; below, why steps were not
/// compared, and of what most rollouts failed.
std::string EpisodeTable(const std::vector<ComparedStep>& steps);
/// Verdicts counted, and how far durations were off.
std::string EpisodeSummary(const std::vector<ComparedStep>& steps);
nlohmann::ordered_json EpisodeJson(const std::vector<ComparedStep>& steps);

}  // namespace hires::reports
