#include "hires/imagination/imagine_answer.h"

#include <algorithm>
#include <set>

#include "hires/base/text.h"

namespace hires::imagination {
namespace {

using execution::ImagineAnswered;
using Told = ImagineAnswered::Outcome;

Told OutcomeOf(const Report& report, bool is_late) {
  const bool is_cancelled = report.outcome == ImaginationOutcome::kCancelled;
  switch (is_cancelled && is_late ? report.found : report.outcome) {
    case ImaginationOutcome::kRanked:
    case ImaginationOutcome::kClose:
      return Told::kRanked;
    case ImaginationOutcome::kAllFailed:
      return Told::kAllFailed;
    case ImaginationOutcome::kUndecided:
      return Told::kUndecided;
    case ImaginationOutcome::kNoWorker:
      return Told::kNoWorker;
    case ImaginationOutcome::kNothingFinished:
      return Told::kNothingFinished;
    case ImaginationOutcome::kCancelled:
      return is_late ? Told::kNothingFinished : Told::kUnavailable;
  }
  return Told::kInvalid;
}

/// What made most rollouts fail; nothing where none did.
base::Failure MainFailure(const Prediction& prediction) {
  const auto& failures = prediction.evidence.failures;
  const auto most =
      std::max_element(failures.begin(), failures.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == failures.end() ? base::Failure() : most->first;
}

void SetRecommended(const Report& report, ImagineAnswered* answer) {
  if (report.recommended < 0 || report.recommended >= static_cast<int>(report.ranking.size())) {
    answer->outcome = Told::kInvalid;
    answer->why = "the ranking recommends nothing: " + report.why;
    return;
  }
  const Prediction& best = report.ranking[static_cast<std::size_t>(report.recommended)];
  const auto& duration = best.evidence.duration;
  const std::vector<double>& durations = best.evidence.durations;
  answer->recommended = best.action;
  answer->duration = duration.mean;
  answer->duration_low = durations.empty() ? 0.0 : Quantile(durations, 5);
  answer->duration_high = std::max(duration.p95, duration.mean);
}

}  // namespace

ImagineAnswered AnswerOf(int request, const Report& report, bool is_late,
                         const std::vector<std::string>& things) {
  ImagineAnswered answer;
  answer.request = request;
  answer.outcome = OutcomeOf(report, is_late);
  answer.why = report.why;
  if (is_late && !report.complete && !report.ranking.empty()) answer.why += " at its deadline";
  std::set<std::string> instances;
  for (const std::string& thing : things) instances.insert(base::ToLower(thing));
  answer.depends_on.assign(instances.begin(), instances.end());
  if (answer.outcome == Told::kRanked) SetRecommended(report, &answer);
  if (answer.outcome == Told::kAllFailed) {
    for (const Prediction& prediction : report.ranking) {
      answer.failed.push_back(prediction.action);
      answer.failures.push_back(MainFailure(prediction));
    }
  }
  return answer;
}

std::optional<double> DispatchOf(const std::vector<execution::StepStatus>& steps, int plan,
                                 int step, const base::ActionTemplate& action) {
  const auto begun = [&](const execution::StepStatus& status) {
    if (!status.started) return false;
    if (status.plan == plan) return status.index == step;
    return status.plan > plan && base::IsAmong(status.action, action);
  };
  const auto found = std::find_if(steps.begin(), steps.end(), begun);
  return found == steps.end() ? std::nullopt : found->started;
}

}  // namespace hires::imagination
