#include <fmt/format.h>

#include <algorithm>

#include "execution/alternatives.h"
#include "execution/imagination_desk.h"
#include "execution/imagined_step.h"
#include "execution/records.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"

// What becomes of the answers to the questions that ImaginationDesk asks.

namespace hires::execution {
namespace {

using temporal::kForever;

/// The configured value of a parameter, else the domain's, else the most cautious motion set: the
/// first of them that is among the alternatives. Nothing where none is.
std::optional<std::string> DefaultOf(const std::string& parameter,
                                     const planning::ImagineData& domain,
                                     const MonitorParams& params,
                                     const std::vector<std::string>& alternatives) {
  std::vector<std::string> values;
  for (const auto* defaults : {&params.defaults, &domain.defaults}) {
    const auto value = defaults->find(parameter);
    if (value != defaults->end()) values.push_back(value->second);
  }
  values.insert(values.end(), params.motion_sets.begin(), params.motion_sets.end());
  const auto found = std::find_first_of(values.begin(), values.end(), alternatives.begin(),
                                        alternatives.end());
  if (found == values.end()) return std::nullopt;
  return *found;
}

}  // namespace

// ---------------------------------------------------------------------------------------- answers

void ImaginationDesk::OnAnswer(const ImagineAnswered& answer) {
  const auto question = std::find_if(questions_.begin(), questions_.end(), [&](const auto& open) {
    return open.request != 0 && open.request == answer.request;
  });
  if (question == questions_.end()) return;  // an answer to what is not asked any more
  question->request = 0;
  session_.progress().run().at(question->step).finished = session_.now();
  using Outcome = ImagineAnswered::Outcome;
  if (answer.outcome == Outcome::kRanked) {
    question->answer = answer;
    return TakeRanked(&*question);
  }
  if (!IsUnimagined(answer.outcome)) chosen_.erase(ToString(question->action));
  if (answer.outcome == Outcome::kAllFailed) return TakeFailed(&*question, answer);
  question->why_not = WhyNothing(answer);
  question->is_hopeless = question->is_invalid = answer.outcome == Outcome::kInvalid;
  if (answer.outcome == Outcome::kUndecided) question->undecided = answer;
  if (!question->is_hopeless && !question->undecided)
    question->retry = session_.now() + session_.params().retry_period;
}

void ImaginationDesk::TakeRanked(Question* question) {
  const ImagineAnswered& answer = *question->answer;
  const base::ActionCall best = Lowered(answer.recommended);
  PlanRun& run = session_.progress().run();
  std::string wrong = Fits(question->action, best)
                          ? run.Instantiate(question->target, best.arguments, session_.domain(),
                                            session_.operators())
                          : "it is not among the alternatives";
  if (!wrong.empty()) {
    question->why_not =
        fmt::format("the recommended {} cannot be taken: {}", base::ToString(best), wrong);
    question->answer.reset();
    question->is_hopeless = true;
    return;
  }
  if (session_.params().imagination != MonitorParams::ImaginePolicy::kThesis) {
    chosen_[ToString(question->action)] = best;
  }
  ExpectAsImagined(answer, question->target, &session_);
  StepRun& step = run.at(question->step);
  step.phase = StepPhase::kDone;
  step.note = fmt::format("recommended: {}; {}", base::ToString(best), answer.why);
  run.at(question->target).note = "imagined: " + answer.why;
  session_.outbox().Send(TaskChanged(run.number(), question->target, best));
  session_.outbox().Send(Predicted(session_.outbox().NewRecord(), run.number(), question->target,
                                   best, answer.duration));
  session_.progress().Changed();
}

void ImaginationDesk::TakeFailed(Question* question, const ImagineAnswered& answer) {
  question->why_not = WhyNothing(answer);
  question->is_hopeless = true;
  if (session_.params().imagination == MonitorParams::ImaginePolicy::kThesis) return;
  std::vector<base::ActionCall> failed;
  for (const base::ActionCall& call : answer.failed) failed.push_back(Lowered(call));
  if (failed.empty()) failed = base::Combinations(question->action);
  base::Failure first;
  for (std::size_t i = 0; i < failed.size(); ++i) {
    const base::Failure why = i < answer.failures.size() ? answer.failures[i] : base::Failure();
    if (!first) first = why;
    session_.Exclude({failed[i], why, LoweredSet(answer.depends_on), 0}, question->target);
  }
  StepRun& step = session_.progress().run().at(question->step);
  step.phase = StepPhase::kDone;
  step.note = question->why_not;
  StepRun& target = session_.progress().run().at(question->target);
  target.note = "imagined to fail: " + ToString(first);
  target.failure = {base::FailureCode::kImaginedFailure, first.subjects, ToString(first)};
  session_.Report({Violation::Kind::kImagined, target.action, target.failure}, 0);
}

// --------------------------------------------------------------------------------------- deciding

bool ImaginationDesk::MayStart(int step) {
  Question* question = FindTarget(step);
  if (question == nullptr || question->answer || question->is_hopeless) return true;
  const MonitorParams& params = session_.params();
  if (question->on_late == planning::OnLate::kWait) {
    return question->asked && session_.now() >= *question->asked + params.max_wait;
  }
  if (question->undecided) return true;  // nothing more is on its way
  if (!question->limit) {
    question->limit = std::max(session_.now(), LimitOf(*question));
    MoveTo(question, DeadlineOf(*question));
  }
  if (session_.now() < *question->limit) return false;
  return question->request == 0 || session_.now() >= *question->limit + params.answer_grace;
}

void ImaginationDesk::Settle(int step) {
  Question* question = FindTarget(step);
  if (question == nullptr) return;
  question->is_open = false;
  session_.progress().network().Forget(question->step);
  if (!question->answer) TakeDefaults(question);
  Cancel(question);
}

bool ImaginationDesk::IsAnswered() const {
  return std::all_of(questions_.begin(), questions_.end(), [this](const Question& question) {
    if (!question.is_open || question.answer || question.is_hopeless) return true;
    if (!question.asked) return false;
    const bool has_heard = question.request == 0 && !question.why_not.empty();
    return has_heard || session_.now() >= *question.asked + session_.params().max_wait;
  });
}

void ImaginationDesk::SettleAll() {
  std::vector<int> targets;
  for (const Question& question : questions_) {
    if (question.is_open) targets.push_back(question.target);
  }
  for (const int target : targets) Settle(target);
}

std::vector<std::string> ImaginationDesk::Invalid() const {
  std::vector<std::string> texts;
  for (const Question& question : questions_) {
    if (!question.is_invalid) continue;
    texts.push_back(fmt::format("{}: {}", ToString(question.action), question.why_not));
  }
  return texts;
}

std::vector<std::string> ImaginationDesk::Unimagined() const {
  std::vector<std::string> texts;
  for (const Question& question : questions_) {
    if (question.answer || question.is_hopeless || question.undecided) continue;
    const StepRun& step = session_.progress().run().at(question.step);
    texts.push_back(fmt::format("{}: {}", ToString(question.action), step.note));
  }
  return texts;
}

/// The step takes what was recommended for the same action and alternatives before.
/// @return false: there is no such choice, and nothing has changed.
bool ImaginationDesk::TakeChosen(const Question& question) {
  const auto chosen = chosen_.find(ToString(question.action));
  if (chosen == chosen_.end()) return false;
  PlanRun& run = session_.progress().run();
  const std::string wrong = run.Instantiate(question.target, chosen->second.arguments,
                                            session_.domain(), session_.operators());
  if (!wrong.empty()) {
    session_.outbox().Warning(fmt::format("the choice of the last answer, {}, cannot be kept: {}",
                                          base::ToString(chosen->second), wrong));
    return false;
  }
  session_.progress().network().Tighten(question.target,
                                        {0.0, kForever, run.at(question.target).expected});
  return true;
}

void ImaginationDesk::TakeDefaults(Question* question) {
  const bool is_kept = TakeChosen(*question);
  if (!is_kept) SetDefaults(*question);
  StepRun& target = session_.progress().run().at(question->target);
  std::string why = question->why_not;
  if (question->request != 0 || why.empty()) {
    why = "there was no answer in time" + (why.empty() ? "" : "; " + why);
  }
  session_.outbox().Warning(fmt::format(
      is_kept ? "{} keeps what was imagined for an earlier start, from this one it was not: {}"
              : "{} is carried out without imagination, how likely it succeeds is unknown: {}",
      base::ToString(target.action), why));
  target.note = (is_kept ? "imagined for an earlier start: " : "not imagined: ") + why;
  StepRun& step = session_.progress().run().at(question->step);
  step.phase = StepPhase::kSkipped;
  step.note = why;
}

void ImaginationDesk::SetDefaults(const Question& question) {
  PlanRun& run = session_.progress().run();
  const planning::OperatorEntry& entry = EntryOf(session_.operators(), question.action.name);
  if (!entry.imagine) return;
  std::vector<std::string> arguments = run.at(question.target).action.arguments;
  for (std::size_t i = 0; i < arguments.size() && i < entry.arguments.size(); ++i) {
    const std::string& name = entry.arguments[i];
    const auto& parameters = entry.imagine->parameters;
    if (std::count(parameters.begin(), parameters.end(), name) == 0) continue;
    const auto& list = question.action.alternatives[i];
    arguments[i] = DefaultOf(name, *entry.imagine, session_.params(), list).value_or(arguments[i]);
    const auto wanted = session_.params().defaults.find(name);
    if (wanted == session_.params().defaults.end() || wanted->second == arguments[i]) continue;
    session_.outbox().Warning(
        fmt::format("{}: default {}={} is not among the alternatives {}; {} is used",
                    question.action.name, name, wanted->second, base::Join(list, ", "),
                    arguments[i]));
  }
  const std::string wrong =
      run.Instantiate(question.target, arguments, session_.domain(), session_.operators());
  if (!wrong.empty()) session_.outbox().Warning("the default cannot be taken: " + wrong);
  session_.progress().network().Tighten(question.target,
                                        {0.0, kForever, run.at(question.target).expected});
}

// ----------------------------------------------------------------------------------------- change

/// What the robot carries moves with it, and that changes nothing that was imagined.
bool ImaginationDesk::IsCarried(const std::string& instance) const {
  const PlanRun& run = session_.progress().run();
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
    if (session_.state().facts().HasMatch(patterns[0])) return true;
  }
  return false;
}

bool ImaginationDesk::IsAffected(const Question& question,
                                 const std::set<std::string>& changed) const {
  if (question.request != 0) return true;
  const auto& answer = question.answer ? question.answer : question.undecided;
  if (!answer) return false;
  const std::set<std::string> depends_on = LoweredSet(answer->depends_on);
  return std::any_of(changed.begin(), changed.end(), [&](const std::string& instance) {
    return depends_on.count(instance) > 0 || question.known.count(instance) == 0;
  });
}

void ImaginationDesk::OnChanged(const GeometryChanged& change) {
  std::set<std::string> changed = LoweredSet(change.instances);
  for (auto instance = changed.begin(); instance != changed.end();) {
    instance = session_.progress().has_plan() && IsCarried(*instance) ? changed.erase(instance)
                                                                      : std::next(instance);
  }
  session_.exclusions().Forget(changed, session_.state().instances());
  std::vector<Question*> affected;
  for (Question& question : questions_) {
    if (!changed.empty() && question.is_open && IsAffected(question, changed)) {
      affected.push_back(&question);
    }
  }
  session_.state().Know(changed);
  for (Question* question : affected) {
    if (question->answer) chosen_.erase(ToString(question->action));  // it rests on what changed
    AskAgain(question, base::Join({changed.begin(), changed.end()}, ", ") + " changed");
  }
}

}  // namespace hires::execution
