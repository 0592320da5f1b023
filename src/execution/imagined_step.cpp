#include "execution/imagined_step.h"

#include <fmt/format.h>

#include "execution/alternatives.h"

namespace hires::execution {
namespace {

using temporal::kForever;

/// Where imagination has nothing to say.
std::string OutcomeText(ImagineAnswered::Outcome outcome) {
  switch (outcome) {
    case ImagineAnswered::Outcome::kNoWorker:
      return "no worker is there to imagine it";
    case ImagineAnswered::Outcome::kNothingFinished:
      return "nothing was finished in time";
    case ImagineAnswered::Outcome::kUndecided:
      return "imagination could not decide";
    case ImagineAnswered::Outcome::kUnavailable:
      return "imagination is not available";
    case ImagineAnswered::Outcome::kInvalid:
      return "it cannot be imagined";
    case ImagineAnswered::Outcome::kRanked:
    case ImagineAnswered::Outcome::kAllFailed:
      break;
  }
  return "no alternative is expected to succeed";
}

}  // namespace

Facts ProjectedTo(const Session& session, int step) {
  const PlanRun& run = session.progress().run();
  Facts facts = session.state().facts();
  for (const int active : run.Active()) {
    const StepRun& running = run.at(active);
    ApplyEffects(run.planned(active), running.disturbance, running.before, &facts);
  }
  for (int i = 0; i < step; ++i) {
    if (run.at(i).IsWaiting()) ApplyEffects(run.planned(i), run.at(i).disturbance, &facts);
  }
  return facts;
}

void ExpectAsImagined(const ImagineAnswered& answer, int step, Session* session) {
  planning::Duration duration{answer.duration_low, answer.duration_high, answer.duration};
  if (!(0.0 < duration.min && duration.min <= duration.max)) duration = {0.0, kForever, {}};
  if (answer.duration > 0.0) duration.expected = answer.duration;
  const auto conflict = session->progress().network().Tighten(step, duration);
  if (!conflict) return;
  session->outbox().Warning(
      fmt::format("how long {} lasts as imagined does not fit the plan and is not "
                  "used: {}",
                  base::ToString(Lowered(answer.recommended)), *conflict));
}

bool IsUnimagined(ImagineAnswered::Outcome outcome) {
  using Outcome = ImagineAnswered::Outcome;
  return outcome == Outcome::kNoWorker || outcome == Outcome::kNothingFinished ||
         outcome == Outcome::kUnavailable;
}

std::string WhyNothing(const ImagineAnswered& answer) {
  return OutcomeText(answer.outcome) + (answer.why.empty() ? "" : ": " + answer.why);
}

}  // namespace hires::execution
