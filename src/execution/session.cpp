#include "execution/session.h"

#include <fmt/format.h>

#include <algorithm>

#include "execution/records.h"
#include "hires/base/text.h"

namespace hires::execution {
namespace {

constexpr double kLead = 1.0;  // [s] see PlanNetwork

const char* ConceptOf(Violation::Kind kind) {
  switch (kind) {
    case Violation::Kind::kPrecondition:
      return "PreconditionFailure";
    case Violation::Kind::kEffect:
      return "EffectFailure";
    case Violation::Kind::kTimeout:
      return "TimeoutFailure";
    case Violation::Kind::kActivity:
    case Violation::Kind::kImagined:
      break;
  }
  return "ActivityFailure";
}

void CollectNames(const base::Atom& atom, std::set<std::string>* names) {
  for (const std::string& argument : atom.arguments) names->insert(base::ToLower(argument));
}

}  // namespace

std::string ToString(const Violation& violation) {
  return fmt::format("{}: {}", base::ToString(violation.action), ToString(violation.failure));
}

bool IsSame(const Violation& a, const Violation& b) {
  return a.action == b.action && a.failure == b.failure;
}

Exclusion ExclusionFor(const base::ActionCall& action, const base::Failure& failure) {
  return {action, failure, {failure.subjects.begin(), failure.subjects.end()}, 0};
}

Session::Session(const planning::PlanningKnowledge* knowledge,
                 const planning::OperatorData* operators, const MonitorParams& params)
    : knowledge_(knowledge),
      operators_(operators),
      params_(params),
      changing_(ChangingPredicates(knowledge->domain)) {}

void Session::SetNow(double now) {
  now_ = std::max(now_, now);
  if (network_) network_->SetNow(now_);
}

void Session::Observe(const StateObserved& state) {
  observed_ = Facts(state.atoms);
  facts_ = observed_;
  for (const planning::PlanStep& step : bookkeeping_) ApplyEffects(step, &facts_);
  for (const base::Atom& atom : state.atoms) CollectNames(atom, &instances_);
  has_state_ = true;
  Changed();
}

void Session::ObserveUntil(double time) {
  observed_until_ = std::max(observed_until_.value_or(time), time);
}

void Session::Note(const planning::PlanStep& bookkeeping) {
  bookkeeping_.push_back(bookkeeping);
  ApplyEffects(bookkeeping, &facts_);
  Changed();
}

void Session::BeginTask(const std::string& task) {
  task_ = task;
  first_plan_ = last_plan_ + 1;
  past_.clear();
}

void Session::EndTask() {
  if (run_) {
    RecordEndOfPlan("the task is over");
    for (int i = 0; i < run_->size(); ++i) past_.push_back(StatusOf(i));
  }
  for (const Exclusion& exclusion : exclusions_) {
    Send(FailureForgotten(exclusion.record, exclusion.action));
  }
  exclusions_.clear();
  run_.reset();
  network_.reset();
  violation_.reset();
  bookkeeping_.clear();
  facts_ = observed_;
}

void Session::Adopt(PlanRun run, std::vector<int> informs,
                    const std::vector<std::pair<int, int>>& taken_over) {
  std::set<int> taken;
  for (const auto& [index, old] : taken_over) {
    StepRun& step = run.at(index);
    const StepRun& running = run_->at(old);
    step.phase = running.phase;
    step.activity = running.activity;
    step.before = running.before;
    step.is_stopping = running.is_stopping;
    step.started = running.started;
    step.finished = running.finished;
    step.stopped = running.stopped;
    step.stop_reason = running.stop_reason;
    step.time_limit = running.time_limit;
    step.note = running.note;
    step.failure = running.failure;
    taken.insert(old);
  }
  if (run_) {
    RecordEndOfPlan("another plan took its place");
    for (int i = 0; i < run_->size(); ++i) {
      if (run_->at(i).IsWaiting()) run_->at(i).phase = StepPhase::kSkipped;
      if (taken.count(i) == 0) past_.push_back(StatusOf(i));
    }
  }
  run_ = std::move(run);
  informs_ = std::move(informs);
  last_plan_ = run_->number();
  network_.emplace(*run_, informs_, now_, kLead + params_.arrival_margin);
  for (const auto& [index, old] : taken_over) {
    for (int i = 0; i < run_->size(); ++i) {
      if (informs_[i] == index) network_->Forget(i);
    }
    network_->Begin(index, *run_->at(index).started);
    if (run_->at(index).finished) network_->End(index, *run_->at(index).finished);
  }
  RecordPlan();
  Changed();
}

void Session::RecordPlan() {
  Send(PlanBegun(run_->number(), task_, run_->plan().cost));
  for (int i = 0; i < run_->size(); ++i) {
    Send(TaskPlanned(run_->number(), i, run_->at(i).action));
  }
}

void Session::RecordEndOfPlan(const std::string& outcome) {
  Send(PlanEnded(run_->number(), outcome));
}

StepStatus Session::StatusOf(int index) const {
  const StepRun& step = run_->at(index);
  StepStatus status;
  status.plan = plan_index();
  status.index = index;
  status.action = step.action;
  status.phase = step.phase;
  status.started = step.started;
  status.finished = step.finished;
  status.start = network_->StartOf(index);
  status.finish = network_->FinishOf(index);
  status.expected_start = network_->ExpectedStart(index);
  status.expected_finish = network_->ExpectedFinish(index);
  status.note = step.note;
  status.failure = step.failure;
  return status;
}

std::vector<StepStatus> Session::Steps() const {
  std::vector<StepStatus> steps = past_;
  for (int i = 0; run_ && i < run_->size(); ++i) steps.push_back(StatusOf(i));
  return steps;
}

void Session::Start(int index, double time_limit) {
  StepRun& step = run_->at(index);
  step.activity = ++last_activity_;
  step.phase = StepPhase::kRunning;
  step.started = now_;
  step.time_limit = time_limit;
  step.before = TouchedBy(step.disturbance, facts_);
  network_->Begin(index, now_);
  Send(ActivityBegun(step.activity, run_->number(), index, step.action));
  Send(StartStep{step.activity, step.action, time_limit});
  Changed();
}

void Session::Stop(int index, const base::Failure& why) {
  StepRun& step = run_->at(index);
  if (step.phase != StepPhase::kRunning || step.is_stopping) return;
  step.is_stopping = true;
  step.stopped = now_;
  step.stop_reason = why;
  Send(StopStep{step.activity});
}

void Session::Blame(int index, const base::Failure& loss) {
  StepRun& step = run_->at(index);
  step.failure = loss;
  step.note = ToString(loss);
  Changed();
}

void Session::End(int index, StepPhase phase, const std::string& result,
                  const base::Failure& failure) {
  StepRun& step = run_->at(index);
  step.phase = phase;
  step.finished = now_;
  step.failure = failure;
  if (failure) step.note = ToString(failure);
  network_->End(index, now_);
  Send(ActivityEnded(step.activity, step.action, result, failure));
  Changed();
}

void Session::Confirm(int index) {
  run_->at(index).phase = StepPhase::kDone;
  Changed();
}

bool Session::IsAnyActive() const { return run_ && !run_->Active().empty(); }

void Session::Report(Violation violation, int activity) {
  if (violation.kind != Violation::Kind::kImagined) {
    Send(Failed(NewRecord(), ConceptOf(violation.kind), activity, violation.action,
                violation.failure));
  }
  if (!violation_) violation_ = std::move(violation);
}

void Session::Exclude(Exclusion exclusion, int step) {
  for (const Exclusion& known : exclusions_) {
    if (known.action == exclusion.action) return;
  }
  exclusion.record = NewRecord();
  Send(
      FailureImagined(exclusion.record, run_->number(), step, exclusion.action, exclusion.failure));
  exclusions_.push_back(std::move(exclusion));
}

void Session::ForgetExclusions(const std::set<std::string>& changed) {
  const auto rests_on = [&](const Exclusion& exclusion) {
    return std::any_of(changed.begin(), changed.end(), [&](const std::string& instance) {
      // What is seen for the first time was in the way before it had a pose.
      return exclusion.depends_on.count(instance) > 0 && instances_.count(instance) > 0;
    });
  };
  for (auto exclusion = exclusions_.begin(); exclusion != exclusions_.end();) {
    if (!rests_on(*exclusion)) {
      ++exclusion;
      continue;
    }
    Send(FailureForgotten(exclusion->record, exclusion->action));
    exclusion = exclusions_.erase(exclusion);
  }
}

std::vector<base::Atom> Session::ExclusionAtoms() const {
  std::vector<base::Atom> atoms;
  for (const Exclusion& exclusion : exclusions_) {
    atoms.push_back({"imagined_failure", {exclusion.action.name}});
    const auto& arguments = exclusion.action.arguments;
    atoms.back().arguments.insert(atoms.back().arguments.end(), arguments.begin(), arguments.end());
  }
  return atoms;
}

}  // namespace hires::execution
