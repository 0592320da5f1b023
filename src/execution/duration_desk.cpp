#include "execution/duration_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "execution/imagined_step.h"

namespace hires::execution {
namespace {

/// The one alternative that it is.
base::ActionTemplate TemplateOf(const base::ActionCall& call) {
  base::ActionTemplate action;
  action.name = call.name;
  for (const std::string& argument : call.arguments) action.alternatives.push_back({argument});
  return action;
}

}  // namespace

bool DurationDesk::IsUnknown(int step) const {
  const PlanRun& run = session_.progress().run();
  const StepRun& planned = run.at(step);
  if (planned.kind != StepRun::Kind::kAction || !planned.IsWaiting()) return false;
  const auto& informs = session_.progress().informs();
  if (std::find(informs.begin(), informs.end(), step) != informs.end()) return false;
  return !planned.duration.expected &&
         EntryOf(session_.operators(), planned.action.name).imagine.has_value();
}

void DurationDesk::Update() {
  const PlanRun& run = session_.progress().run();
  if (plan_ == run.number()) return;
  Close();
  plan_ = run.number();
  const bool is_off = session_.params().imagination == MonitorParams::ImaginePolicy::kOff;
  for (int i = 0; i < run.size(); ++i) {
    if (!IsUnknown(i)) continue;
    is_off ? SayUnknown(i, "imagination is off") : Ask(i);
  }
}

void DurationDesk::SayUnknown(int step, const std::string& why) {
  session_.progress().run().at(step).note = "how long it lasts is not known: " + why;
  session_.progress().Changed();
}

void DurationDesk::SayWhatIsUnknown() {
  for (const Question& question : questions_)
    SayUnimagined(question.step, "no answer came in time");
}

void DurationDesk::SayUnimagined(int step, const std::string& why) {
  const base::ActionCall& action = session_.progress().run().at(step).action;
  unimagined_.push_back(fmt::format("{}: {}", base::ToString(action), why));
  SayUnknown(step, why);
}

void DurationDesk::Ask(int step) {
  const int request = session_.outbox().NewRequest();
  StartImagination start;
  start.request = start.first_request = request;
  start.plan = session_.progress().plan_index();
  start.step = step;
  start.action = TemplateOf(session_.progress().run().at(step).action);
  start.state = ProjectedTo(session_, step).Atoms();
  start.deadline = std::numeric_limits<double>::infinity();
  session_.outbox().Send(std::move(start));
  questions_.push_back({step, request, session_.now()});
}

void DurationDesk::OnAnswer(const ImagineAnswered& answer) {
  const auto question = std::find_if(questions_.begin(), questions_.end(), [&](const auto& open) {
    return open.request == answer.request;
  });
  if (question == questions_.end()) return;
  const int step = question->step;
  questions_.erase(question);
  if (IsUnimagined(answer.outcome)) return SayUnimagined(step, WhyNothing(answer));
  const bool is_known =
      answer.outcome == ImagineAnswered::Outcome::kRanked && answer.duration > 0.0;
  if (!is_known) {
    const bool is_ranked = answer.outcome == ImagineAnswered::Outcome::kRanked;
    return SayUnknown(step, is_ranked ? "imagination did not say" : WhyNothing(answer));
  }
  ExpectAsImagined(answer, step, &session_);
  session_.progress().run().at(step).note =
      fmt::format("lasts {:.1f} s as imagined", answer.duration);
  session_.progress().Changed();
}

void DurationDesk::Close() {
  for (const Question& question : questions_) {
    session_.outbox().Send(CancelImagination{question.request});
  }
  questions_.clear();
  unimagined_.clear();
  plan_.reset();
}

bool DurationDesk::IsAnswered() const {
  return std::all_of(questions_.begin(), questions_.end(), [this](const Question& question) {
    return session_.now() >= question.asked + session_.params().max_wait;
  });
}

std::optional<double> DurationDesk::WakeAt() const {
  std::optional<double> wake;
  for (const Question& question : questions_) {
    const double end = question.asked + session_.params().max_wait;
    if (end > session_.now()) wake = std::min(wake.value_or(end), end);
  }
  return wake;
}

}  // namespace hires::execution
