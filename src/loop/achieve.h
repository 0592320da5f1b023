#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/execution/monitor.h"
#include "hires/imagination/report.h"

namespace hires::loop {

std::string ToString(execution::StepPhase phase);  ///< "waiting", "running", ...

/// How such a request went, or that it runs.
enum class ImaginedOutcome {
  kRunning,
  kRanked,
  kAllFailed,
  kUndecided,
  kNoWorker,
  kNothingFinished,
  kInvalid,
  kUnavailable,
  kCancelled
};
std::string ToString(ImaginedOutcome outcome);  ///< "running", "ranked", "all_failed", ...
/// "" is kRunning.  @throws base::ConfigError for any other word.
ImaginedOutcome ParseImaginedOutcome(const std::string& word);

/// One request of the execution monitor to imagine a step. Times are main ROS time [s].
struct ImaginedStep {
  int plan{0};  ///< number of the plan, and
  int step{0};  ///< index of the step in it that it is about
  base::ActionTemplate action;
  double requested{0.0};
  std::optional<double> answered;
  std::optional<double> dispatch;  ///< when that step began
  double deadline{std::numeric_limits<double>::infinity()};
  double wall_seconds{0.0};       ///< [s] that the imagination took
  double simulated_seconds{0.0};  ///< [s] of all its rollouts
  ImaginedOutcome outcome{ImaginedOutcome::kRunning};
  std::vector<imagination::Prediction> predictions;  ///< in order of merit
  int recommended{-1};                               ///< index into `predictions`, or -1
  std::string why;
};

/// How far a task is.
struct AchieveStatus {
  double now{0.0};  ///< [s] main ROS time
  std::vector<execution::StepStatus> steps;
  std::vector<ImaginedStep> imaginations;
  int replans{0};
  std::vector<std::string> warnings;  ///< all so far, in order
};

/// First moment that a status speaks of [s]: when its first step or imagination began, else now.
double BeginOf(const AchieveStatus& status);

enum class AchieveOutcome { kSucceeded, kNoPlan, kFailed, kPreempted, kInvalid, kBusy, kDryRun };
std::string ToString(AchieveOutcome outcome);  ///< "succeeded", "no_plan", ...

struct AchieveReport {
  std::string task;
  AchieveOutcome outcome{AchieveOutcome::kFailed};
  std::string reason;       ///< one sentence
  base::Failure failure;    ///< what ended it, where a single failure did
  std::int64_t episode{0};  ///< of the Blackboard; 0: unknown
  AchieveStatus status;     ///< at the end
};

/// What `hires achieve` was asked.
struct AchieveQuery {
  std::string task;
  std::string imagination;  ///< domain, thesis, off; empty: as the execution monitor is configured
  double wait{10.0};        ///< [s] for the execution monitor to be there
};

using OnAchieveStatus = std::function<void(const AchieveStatus&)>;
/// Has the running execution monitor do a task; when `cancelled`, ends it and waits for its end.
/// @throws base::ConfigError where there is no execution monitor, or it goes away.
using AchieveRemotely = std::function<AchieveReport(const AchieveQuery&, const OnAchieveStatus&,
                                                    const std::function<bool()>& cancelled)>;

}  // namespace hires::loop
