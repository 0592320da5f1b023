#include "imagination_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "records.h"

namespace hires::execution {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kShift = 0.5;      // [s] by which a deadline moves before anybody is told
constexpr double kForesight = 0.8;  // [s] before a deadline it is looked at again

std::string WithoutMarks(const std::string& name) {
  return name.substr(std::min(name.find_first_not_of('!'), name.size()));
}

/// (!imagine !drive (a) (slow fast)): drive with those lists.
base::ActionTemplate TemplateOf(const Datum& task) {
  base::ActionTemplate action;
  if (task.items.size() < 2) return action;
  action.name = WithoutMarks(ToString(task.items[1]));
  for (std::size_t i = 2; i < task.items.size(); ++i) {
    action.alternatives.emplace_back();
    if (!task.items[i].IsList()) {
      action.alternatives.back().push_back(ToString(task.items[i]));
      continue;
    }
    for (const Datum& item : task.items[i].items) {
      action.alternatives.back().push_back(ToString(item));
    }
  }
  return action;
}

bool Fits(const base::ActionTemplate& action, const base::ActionCall& call) {
  if (action.name != call.name || action.alternatives.size() != call.arguments.size()) return false;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const auto& list = action.alternatives[i];
    if (std::find(list.begin(), list.end(), call.arguments[i]) == list.end()) return false;
  }
  return true;
}

bool IsSame(const base::ActionTemplate& a, const base::ActionTemplate& b) {
  return a.name == b.name && a.alternatives == b.alternatives;
}

base::ActionCall Lowered(const base::ActionCall& call) {
  base::ActionCall lowered{base::ToLower(WithoutMarks(call.name)), {}};
  for (const std::string& argument : call.arguments) {
    lowered.arguments.push_back(base::ToLower(argument));
  }
  return lowered;
}

std::set<std::string> LoweredSet(const std::vector<std::string>& names) {
  std::set<std::string> lowered;
  for (const std::string& name : names) lowered.insert(base::ToLower(name));
  return lowered;
}

/// Where imagination has nothing to say.
std::string OutcomeText(ImagineAnswered::Outcome outcome) {
  switch (outcome) {
    case ImagineAnswered::Outcome::kNoWorker:
      return "nobody is there to imagine it";
    case ImagineAnswered::Outcome::kNothingFinished:
      return "nothing was finished in time";
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

std::vector<int> InformedSteps(const PlanRun& run) {
  std::vector<int> informed(static_cast<std::size_t>(run.size()), -1);
  for (int i = 0; i < run.size(); ++i) {
    if (run.at(i).kind != StepRun::Kind::kImagine) continue;
    const base::ActionTemplate action = TemplateOf(run.planned(i).task);
    for (int later = i + 1; later < run.size() && informed[i] < 0; ++later) {
      if (Fits(action, run.at(later).action)) informed[i] = later;
    }
  }
  return informed;
}

// ------------------------------------------------------------------------------- coming and going

void ImaginationDesk::Open() {
  std::vector<Question> old = std::exchange(questions_, {});
  for (int i = 0; i < session_.run().size(); ++i) {
    if (session_.run().at(i).kind != StepRun::Kind::kImagine) continue;
    Question question;
    question.step = i;
    question.target = session_.informs()[i];
    question.action = TemplateOf(session_.run().planned(i).task);
    if (!IsWorthAsking(question)) {
      session_.run().at(i).phase = StepPhase::kSkipped;
      session_.network().Forget(i);
      continue;
    }
    const auto& entry = EntryOf(session_.operators(), question.action.name);
    if (entry.imagine) question.on_late = entry.imagine->on_late;
    TakeOver(&old, &question);
    questions_.push_back(std::move(question));
    if (questions_.back().answer) TakeRanked(&questions_.back());
  }
  for (Question& question : old) Cancel(&question);
}

bool ImaginationDesk::IsWorthAsking(const Question& question) {
  if (question.target < 0) {
    session_.Warning(fmt::format("{} informs no later step and is left out",
                                 ToString(session_.run().planned(question.step).task)));
    return false;
  }
  if (!session_.run().at(question.target).IsWaiting()) return false;
  if (session_.params().imagination != MonitorParams::ImaginePolicy::kOff) return true;
  SetDefaults(question);
  return false;
}

/// A question that is asked already, or answered, goes on.
void ImaginationDesk::TakeOver(std::vector<Question>* old, Question* question) {
  const auto same = std::find_if(old->begin(), old->end(), [&](const Question& other) {
    return other.is_open && !other.is_hopeless && IsSame(other.action, question->action);
  });
  if (same == old->end()) return;
  std::swap(same->step, question->step);
  std::swap(same->target, question->target);
  std::swap(*same, *question);
  question->limit.reset();
  if (question->request == 0) return;
  StepRun& step = session_.run().at(question->step);
  step.phase = StepPhase::kRunning;
  step.started = question->asked;
}

void ImaginationDesk::Close() {
  for (Question& question : questions_) Cancel(&question);
  questions_.clear();
}

ImaginationDesk::Question* ImaginationDesk::FindTarget(int step) {
  for (Question& question : questions_) {
    if (question.is_open && question.target == step) return &question;
  }
  return nullptr;
}

void ImaginationDesk::Cancel(Question* question) {
  if (question->request != 0) session_.Send(CancelImagination{question->request});
  question->request = 0;
}

// ----------------------------------------------------------------------------------------- asking

/// The present state with the effects of what runs and of what comes before the step in the plan.
Facts ImaginationDesk::Projected(int target) const {
  const PlanRun& run = session_.run();
  Facts facts = session_.facts();
  for (const int active : run.Active()) {
    const StepRun& step = run.at(active);
    ApplyEffects(run.planned(active), step.disturbance, step.before, &facts);
  }
  for (int i = 0; i < target; ++i) {
    if (run.at(i).IsWaiting()) ApplyEffects(run.planned(i), &facts);
  }
  return facts;
}

std::set<std::string> ImaginationDesk::StartOf(const Facts& projected) const {
  std::set<std::string> start;
  for (const auto& [text, atom] : projected.all()) {
    if (session_.IsChanging(std::string(atom.Head()))) start.insert(text);
  }
  return start;
}

double ImaginationDesk::DeadlineOf(const Question& question) {
  if (question.on_late == planning::OnLate::kWait) return kForever;
  const double latest = question.limit.value_or(session_.network().LatestStart(question.target));
  return std::max(session_.now(), latest - session_.params().arrival_margin);
}

void ImaginationDesk::Ask(Question* question) {
  const Facts projected = Projected(question->target);
  question->start = StartOf(projected);
  question->known = session_.instances();
  question->request = session_.NewRequest();
  question->deadline = DeadlineOf(*question);
  if (!question->asked) question->asked = session_.now();
  question->retry.reset();
  question->differs.reset();
  StepRun& step = session_.run().at(question->step);
  step.phase = StepPhase::kRunning;
  step.started = session_.now();
  step.finished.reset();
  session_.Send(StartImagination{question->request, session_.plan_index(), question->target,
                                 question->action, projected.Atoms(), question->deadline});
}

void ImaginationDesk::AskAgain(Question* question, const std::string& why) {
  Cancel(question);
  question->answer.reset();
  question->retry.reset();
  question->is_hopeless = false;
  question->why_not = why;
  Ask(question);
}

/// Whether the step will start in another state than the one that was imagined, and not just while
/// observations follow each other.
bool ImaginationDesk::HasChanged(Question* question) {
  if (StartOf(Projected(question->target)) == question->start) {
    question->differs.reset();
    return false;
  }
  if (!question->differs) question->differs = session_.now();
  return session_.now() >= *question->differs + session_.params().break_delay;
}

void ImaginationDesk::MoveTo(Question* question, double deadline) {
  if (question->request == 0 || !std::isfinite(deadline)) return;
  if (std::abs(deadline - question->deadline) <= kShift) return;
  question->deadline = deadline;
  session_.Send(MoveDeadline{question->request, deadline});
}

void ImaginationDesk::Update() {
  for (Question& question : questions_) {
    if (!question.is_open || question.is_hopeless) continue;
    const bool is_asked = question.request != 0 || question.answer;
    if (is_asked && HasChanged(&question)) {
      AskAgain(&question, "the state in which it will start has changed");
    } else if (!is_asked && session_.now() >= question.retry.value_or(session_.now())) {
      Ask(&question);
    } else {
      MoveTo(&question, DeadlineOf(question));
    }
  }
}

std::optional<double> ImaginationDesk::WakeAt() const {
  std::optional<double> wake;
  const auto at = [&](std::optional<double> time) {
    if (time && *time > session_.now()) wake = std::min(wake.value_or(*time), *time);
  };
  const MonitorParams& params = session_.params();
  for (const Question& question : questions_) {
    if (!question.is_open) continue;
    at(question.retry);
    if (question.differs) at(*question.differs + params.break_delay);
    if (question.limit) at(*question.limit);
    if (question.limit) at(*question.limit + params.answer_grace);
    if (question.asked) at(*question.asked + params.max_wait);
    if (question.request != 0 && std::isfinite(question.deadline)) {
      at(question.deadline - kForesight);
    }
  }
  return wake;
}

// ---------------------------------------------------------------------------------------- answers

void ImaginationDesk::OnAnswer(const ImagineAnswered& answer) {
  const auto question = std::find_if(questions_.begin(), questions_.end(), [&](const auto& open) {
    return open.request != 0 && open.request == answer.request;
  });
  if (question == questions_.end()) return;  // an answer to what is not asked any more
  question->request = 0;
  session_.run().at(question->step).finished = session_.now();
  using Outcome = ImagineAnswered::Outcome;
  if (answer.outcome == Outcome::kRanked) {
    question->answer = answer;
    return TakeRanked(&*question);
  }
  if (answer.outcome == Outcome::kAllFailed) return TakeFailed(&*question, answer);
  question->why_not = OutcomeText(answer.outcome);
  if (!answer.why.empty()) question->why_not += ": " + answer.why;
  question->is_hopeless = answer.outcome == Outcome::kInvalid;
  if (!question->is_hopeless) question->retry = session_.now() + session_.params().retry_period;
}

void ImaginationDesk::TakeRanked(Question* question) {
  const ImagineAnswered& answer = *question->answer;
  const base::ActionCall best = Lowered(answer.recommended);
  PlanRun& run = session_.run();
  std::string wrong = Fits(question->action, best)
                          ? run.Instantiate(question->target, best.arguments, session_.domain(),
                                            session_.operators())
                          : "it is none of the alternatives";
  if (!wrong.empty()) {
    question->why_not =
        fmt::format("the recommended {} cannot be taken: {}", base::ToString(best), wrong);
    question->answer.reset();
    question->is_hopeless = true;
    return;
  }
  planning::Duration duration{answer.duration_low, answer.duration_high, answer.duration};
  if (!(0.0 < duration.min && duration.min <= duration.max)) duration = {0.0, kForever, {}};
  if (answer.duration > 0.0) duration.expected = answer.duration;
  const auto conflict = session_.network().Tighten(question->target, duration);
  if (conflict) {
    session_.Warning(
        fmt::format("how long {} lasts as imagined does not fit the plan and is not "
                    "used: {}",
                    base::ToString(best), *conflict));
  }
  StepRun& step = run.at(question->step);
  step.phase = StepPhase::kDone;
  step.note = fmt::format("recommended: {}; {}", base::ToString(best), answer.why);
  run.at(question->target).note = "imagined: " + answer.why;
  session_.Send(TaskChanged(run.number(), question->target, best));
  session_.Send(
      Predicted(session_.NewRecord(), run.number(), question->target, best, answer.duration));
  session_.Changed();
}

void ImaginationDesk::TakeFailed(Question* question, const ImagineAnswered& answer) {
  question->why_not = OutcomeText(answer.outcome) + (answer.why.empty() ? "" : ": " + answer.why);
  question->is_hopeless = true;
  if (session_.params().imagination == MonitorParams::ImaginePolicy::kThesis) return;
  std::vector<base::ActionCall> failed;
  for (const base::ActionCall& call : answer.failed) failed.push_back(Lowered(call));
  if (failed.empty()) failed = base::Combinations(question->action);
  std::string reason;
  for (std::size_t i = 0; i < failed.size(); ++i) {
    const std::string why = i < answer.failure_reasons.size() ? answer.failure_reasons[i] : "";
    if (reason.empty()) reason = why;
    session_.Exclude({failed[i], LoweredSet(answer.depends_on), 0}, question->target, why);
  }
  StepRun& step = session_.run().at(question->step);
  step.phase = StepPhase::kDone;
  step.note = question->why_not;
  session_.run().at(question->target).note = "imagined to fail: " + reason;
  session_.Report({Trouble::Kind::kImagined, session_.run().at(question->target).action,
                   "imagined to fail" + (reason.empty() ? "" : ": " + reason)},
                  0);
}

// --------------------------------------------------------------------------------------- deciding

bool ImaginationDesk::MayStart(int step) {
  Question* question = FindTarget(step);
  if (question == nullptr || question->answer || question->is_hopeless) return true;
  const MonitorParams& params = session_.params();
  if (question->on_late == planning::OnLate::kWait) {
    return question->asked && session_.now() >= *question->asked + params.max_wait;
  }
  if (!question->limit) {
    question->limit = std::max(session_.now(), session_.network().LatestStart(step));
    MoveTo(question, DeadlineOf(*question));
  }
  if (session_.now() < *question->limit) return false;
  return question->request == 0 || session_.now() >= *question->limit + params.answer_grace;
}

void ImaginationDesk::Settle(int step) {
  Question* question = FindTarget(step);
  if (question == nullptr) return;
  question->is_open = false;
  session_.network().Forget(question->step);
  if (!question->answer) TakeDefaults(question);
  Cancel(question);
}

void ImaginationDesk::TakeDefaults(Question* question) {
  SetDefaults(*question);
  StepRun& target = session_.run().at(question->target);
  std::string why = question->why_not;
  if (question->request != 0 || why.empty()) {
    why = "there was no answer in time" + (why.empty() ? "" : "; " + why);
  }
  session_.Warning(fmt::format(
      "{} is carried out without imagination, and nobody knows how likely it succeeds: {}",
      base::ToString(target.action), why));
  target.note = "not imagined: " + why;
  StepRun& step = session_.run().at(question->step);
  step.phase = StepPhase::kSkipped;
  step.note = why;
}

void ImaginationDesk::SetDefaults(const Question& question) {
  PlanRun& run = session_.run();
  const planning::OperatorEntry& entry = EntryOf(session_.operators(), question.action.name);
  if (!entry.imagine) return;
  std::vector<std::string> arguments = run.at(question.target).action.arguments;
  for (std::size_t i = 0; i < arguments.size() && i < entry.arguments.size(); ++i) {
    const auto value = entry.imagine->defaults.find(entry.arguments[i]);
    if (value == entry.imagine->defaults.end()) continue;
    const auto& list = question.action.alternatives[i];
    if (std::find(list.begin(), list.end(), value->second) != list.end()) {
      arguments[i] = value->second;
    }
  }
  const std::string wrong =
      run.Instantiate(question.target, arguments, session_.domain(), session_.operators());
  if (!wrong.empty()) session_.Warning("the default cannot be taken: " + wrong);
  session_.network().Tighten(question.target, {0.0, kForever, run.at(question.target).expected});
}

// ----------------------------------------------------------------------------------------- change

/// What the robot carries moves with it, and that changes nothing that was imagined.
bool ImaginationDesk::IsCarried(const std::string& instance) const {
  const PlanRun& run = session_.run();
  for (const int active : run.Active()) {
    const auto& arguments = run.at(active).action.arguments;
    if (std::find(arguments.begin(), arguments.end(), instance) != arguments.end()) return true;
  }
  for (const std::string& text : session_.params().carried) {
    std::vector<Datum> patterns = planning::ReadData(text, "carried");
    for (Datum& item : patterns.at(0).items) {
      if (item.kind == Datum::Kind::kVariable && item.text == "?object") {
        item = planning::MakeSymbol(instance);
      }
    }
    if (session_.facts().HasMatch(patterns[0])) return true;
  }
  return false;
}

bool ImaginationDesk::IsAffected(const Question& question,
                                 const std::set<std::string>& changed) const {
  if (question.request == 0 && !question.answer) return false;
  if (question.request != 0) return true;
  const std::set<std::string> depends_on = LoweredSet(question.answer->depends_on);
  return std::any_of(changed.begin(), changed.end(), [&](const std::string& instance) {
    return depends_on.count(instance) > 0 || question.known.count(instance) == 0;
  });
}

void ImaginationDesk::OnChanged(const GeometryChanged& change) {
  std::set<std::string> changed = LoweredSet(change.instances);
  for (auto instance = changed.begin(); instance != changed.end();) {
    instance =
        session_.has_plan() && IsCarried(*instance) ? changed.erase(instance) : std::next(instance);
  }
  session_.ForgetExclusions(changed);
  std::vector<Question*> affected;
  for (Question& question : questions_) {
    if (!changed.empty() && question.is_open && IsAffected(question, changed)) {
      affected.push_back(&question);
    }
  }
  session_.instances().insert(changed.begin(), changed.end());
  for (Question* question : affected) {
    AskAgain(question, base::Join({changed.begin(), changed.end()}, ", ") + " changed");
  }
}

}  // namespace hires::execution
