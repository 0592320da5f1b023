#include "loop/achieve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::loop {
namespace {

using execution::StepPhase;
using execution::StepStatus;

/// In the order of ImaginedOutcome.
const std::array<std::string, 9> kImaginedOutcomes{"running",   "ranked",      "all_failed",
                                                   "undecided", "no_worker",   "nothing_finished",
                                                   "invalid",   "unavailable", "cancelled"};

}  // namespace

std::string ToString(StepPhase phase) {
  switch (phase) {
    case StepPhase::kWaiting:
      return "waiting";
    case StepPhase::kReady:
      return "ready";
    case StepPhase::kRunning:
      return "running";
    case StepPhase::kChecking:
      return "checking";
    case StepPhase::kDone:
      return "done";
    case StepPhase::kFailed:
      return "failed";
    case StepPhase::kSkipped:
      return "skipped";
  }
  HIRES_CHECK(false, "a phase without a name");
  return "";
}

std::string ToString(ImaginedOutcome outcome) {
  return kImaginedOutcomes.at(static_cast<std::size_t>(outcome));
}

ImaginedOutcome ParseImaginedOutcome(const std::string& word) {
  if (word.empty()) return ImaginedOutcome::kRunning;
  const auto found = std::find(kImaginedOutcomes.begin(), kImaginedOutcomes.end(), word);
  if (found == kImaginedOutcomes.end()) {
    throw base::ConfigError(fmt::format(
        "outcome of an imagination is '{}', wanted one of {}; are both programs of one version?",
        word, fmt::join(kImaginedOutcomes, ", ")));
  }
  return static_cast<ImaginedOutcome>(found - kImaginedOutcomes.begin());
}

double BeginOf(const AchieveStatus& status) {
  double begin = status.now;
  for (const StepStatus& step : status.steps) begin = std::min(begin, step.started.value_or(begin));
  for (const ImaginedStep& step : status.imaginations) begin = std::min(begin, step.requested);
  return begin;
}

std::string ToString(AchieveOutcome outcome) {
  switch (outcome) {
    case AchieveOutcome::kSucceeded:
      return "succeeded";
    case AchieveOutcome::kNoPlan:
      return "no_plan";
    case AchieveOutcome::kFailed:
      return "failed";
    case AchieveOutcome::kPreempted:
      return "preempted";
    case AchieveOutcome::kInvalid:
      return "invalid";
    case AchieveOutcome::kBusy:
      return "busy";
    case AchieveOutcome::kDryRun:
      return "dry_run";
  }
  HIRES_CHECK(false, "an outcome without a name");
  return "";
}

}  // namespace hires::loop
