#include "execution/imagination_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "execution/alternatives.h"
#include "execution/imagined_step.h"

namespace hires::execution {
namespace {

using temporal::kForever;
constexpr double kShift = 0.5;      // [s] by which a deadline moves before it is published
constexpr double kForesight = 0.8;  // [s] before a deadline it is looked at again

double MinSuccessOf(const planning::OperatorData& operators, const std::string& name) {
  const auto& imagine = EntryOf(operators, name).imagine;
  return imagine ? imagine->min_success.value_or(0.0) : 0.0;
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
  for (int i = 0; i < session_.progress().run().size(); ++i) {
    if (session_.progress().run().at(i).kind != StepRun::Kind::kImagine) continue;
    Question question;
    question.step = i;
    question.target = session_.progress().informs()[i];
    question.action = TemplateOf(session_.progress().run().planned(i).task);
    if (!IsWorthAsking(question)) {
      session_.progress().run().at(i).phase = StepPhase::kSkipped;
      session_.progress().network().Forget(i);
      continue;
    }
    const auto& entry = EntryOf(session_.operators(), question.action.name);
    if (entry.imagine) question.on_late = entry.imagine->on_late;
    TakeOver(&old, &question);
    questions_.push_back(std::move(question));
    if (questions_.back().answer) {
      TakeRanked(&questions_.back());
    } else {
      TakeChosen(questions_.back());
    }
  }
  for (Question& question : old) Cancel(&question);
}

bool ImaginationDesk::IsWorthAsking(const Question& question) {
  if (question.target < 0) {
    session_.outbox().Warning(
        fmt::format("{} informs no later step and is left out",
                    ToString(session_.progress().run().planned(question.step).task)));
    return false;
  }
  if (!session_.progress().run().at(question.target).IsWaiting()) return false;
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
  StepRun& step = session_.progress().run().at(question->step);
  step.phase = StepPhase::kRunning;
  step.started = question->asked;
}

void ImaginationDesk::Close() {
  for (Question& question : questions_) Cancel(&question);
  questions_.clear();
  chosen_.clear();
}

ImaginationDesk::Question* ImaginationDesk::FindTarget(int step) {
  for (Question& question : questions_) {
    if (question.is_open && question.target == step) return &question;
  }
  return nullptr;
}

void ImaginationDesk::Cancel(Question* question) {
  if (question->request != 0) session_.outbox().Send(CancelImagination{question->request});
  question->request = 0;
}

// ----------------------------------------------------------------------------------------- asking

std::set<std::string> ImaginationDesk::StartOf(const Facts& projected) const {
  std::set<std::string> start;
  for (const auto& [text, atom] : projected.all()) {
    if (session_.state().IsChanging(std::string(atom.Head()))) start.insert(text);
  }
  return start;
}

/// Where the robot waits for the answer, one is due before its patience ends: what was played by
/// then says more than nothing.
/// @pre it was asked.
double ImaginationDesk::DeadlineOf(const Question& question) {
  const MonitorParams& params = session_.params();
  const bool is_patient = question.on_late == planning::OnLate::kWait || params.dry_run;
  const double latest = is_patient ? *question.asked + params.max_wait
                                   : question.limit.value_or(LimitOf(question));
  return std::max(session_.now(), latest - params.arrival_margin);
}

/// [s] Until when the step waits for an answer: its latest start, or `late_wait` after the question
/// where that is later and the plan's bounds allow it. A start that keeps changing delays the step
/// by at most `max_wait`.
double ImaginationDesk::LimitOf(const Question& question) const {
  const MonitorParams& params = session_.params();
  const PlanNetwork& network = session_.progress().network();
  const double ready = session_.progress().run().at(question.target).ready.value_or(session_.now());
  const double wait = std::min({question.since + params.late_wait, ready + params.max_wait,
                                network.StartOf(question.target).latest});
  return std::max(network.LatestStart(question.target), wait);
}

void ImaginationDesk::Ask(Question* question) {
  const Facts projected = ProjectedTo(session_, question->target);
  question->start = StartOf(projected);
  question->known = session_.state().instances();
  question->request = session_.outbox().NewRequest();
  if (!question->asked) question->asked = question->since = session_.now();
  question->deadline = DeadlineOf(*question);
  question->retry.reset();
  question->differs.reset();
  StepRun& step = session_.progress().run().at(question->step);
  step.phase = StepPhase::kRunning;
  step.started = session_.now();
  step.finished.reset();
  session_.outbox().Send(StartImagination{question->request, session_.progress().plan_index(),
                                          question->target, question->action, projected.Atoms(),
                                          question->deadline,
                                          MinSuccessOf(session_.operators(), question->action.name),
                                          FirstRequestFor(question->action, question->request)});
}

/// Of this task, for the same action; this one, if it is the first.
int ImaginationDesk::FirstRequestFor(const base::ActionTemplate& action, int request) {
  return first_requests_.emplace(ToString(action), request).first->second;
}

void ImaginationDesk::AskAgain(Question* question, const std::string& why) {
  Cancel(question);
  question->answer.reset();
  question->retry.reset();
  question->is_hopeless = question->is_invalid = false;
  question->undecided.reset();
  question->why_not = why;
  question->since = session_.now();
  question->limit.reset();
  Ask(question);
}

/// Whether the step will start in another state than the one that was imagined, and not just while
/// observations follow each other.
bool ImaginationDesk::HasChanged(Question* question) {
  if (StartOf(ProjectedTo(session_, question->target)) == question->start) {
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
  session_.outbox().Send(MoveDeadline{question->request, deadline});
}

void ImaginationDesk::Update() {
  for (Question& question : questions_) {
    if (!question.is_open || question.is_hopeless) continue;
    const bool is_asked = question.request != 0 || question.answer || question.undecided;
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

}  // namespace hires::execution
