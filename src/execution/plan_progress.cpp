#include "execution/plan_progress.h"

#include <algorithm>
#include <set>

#include "execution/records.h"

namespace hires::execution {
namespace {

constexpr double kLead = 1.0;  // [s] see PlanNetwork

/// What is known of a running step goes with it into another plan.
void TakeOver(const StepRun& running, StepRun* step) {
  step->phase = running.phase;
  step->activity = running.activity;
  step->before = running.before;
  step->is_stopping = running.is_stopping;
  step->started = running.started;
  step->finished = running.finished;
  step->stopped = running.stopped;
  step->stop_reason = running.stop_reason;
  step->time_limit = running.time_limit;
  step->note = running.note;
  step->failure = running.failure;
}

}  // namespace

void PlanProgress::SetNow(double now) {
  now_ = std::max(now_, now);
  if (network_) network_->SetNow(now_);
}

void PlanProgress::BeginTask(const std::string& task) {
  task_ = task;
  first_plan_ = last_plan_ + 1;
  past_.clear();
}

void PlanProgress::EndTask() {
  if (run_) {
    outbox_.Send(PlanEnded(run_->number(), "the task is over"));
    for (int i = 0; i < run_->size(); ++i) past_.push_back(StatusOf(i));
  }
  run_.reset();
  network_.reset();
}

void PlanProgress::Adopt(PlanRun run, std::vector<int> informs,
                         const std::vector<std::pair<int, int>>& taken_over) {
  for (const auto& [index, old] : taken_over) TakeOver(run_->at(old), &run.at(index));
  if (run_) LeavePlan(taken_over);
  run_ = std::move(run);
  informs_ = std::move(informs);
  last_plan_ = run_->number();
  PlaceInTime(taken_over);
  RecordPlan();
  Changed();
}

/// What goes over into the next plan is told of there.
void PlanProgress::LeavePlan(const std::vector<std::pair<int, int>>& taken_over) {
  std::set<int> taken;
  for (const auto& [index, old] : taken_over) taken.insert(old);
  outbox_.Send(PlanEnded(run_->number(), "another plan took its place"));
  for (int i = 0; i < run_->size(); ++i) {
    if (run_->at(i).IsWaiting()) run_->at(i).phase = StepPhase::kSkipped;
    if (taken.count(i) == 0) past_.push_back(StatusOf(i));
  }
}

void PlanProgress::PlaceInTime(const std::vector<std::pair<int, int>>& taken_over) {
  network_.emplace(*run_, informs_, now_, kLead + arrival_margin_);
  for (const auto& [index, old] : taken_over) {
    for (int i = 0; i < run_->size(); ++i) {
      if (informs_[i] == index) network_->Forget(i);
    }
    network_->Begin(index, *run_->at(index).started);
    if (run_->at(index).finished) network_->End(index, *run_->at(index).finished);
  }
}

void PlanProgress::RecordPlan() {
  outbox_.Send(PlanBegun(run_->number(), task_, run_->plan().cost));
  for (int i = 0; i < run_->size(); ++i) {
    outbox_.Send(TaskPlanned(run_->number(), i, run_->at(i).action));
  }
}

StepStatus PlanProgress::StatusOf(int index) const {
  const StepRun& step = run_->at(index);
  StepStatus status;
  status.plan = plan_index();
  status.index = index;
  status.action = step.action;
  status.is_of_robot = step.kind == StepRun::Kind::kAction;
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

std::vector<StepStatus> PlanProgress::Steps() const {
  std::vector<StepStatus> steps = past_;
  for (int i = 0; run_ && i < run_->size(); ++i) steps.push_back(StatusOf(i));
  return steps;
}

void PlanProgress::Start(int index, double time_limit, const Facts& facts) {
  StepRun& step = run_->at(index);
  step.activity = ++last_activity_;
  step.phase = StepPhase::kRunning;
  step.started = now_;
  step.time_limit = time_limit;
  step.before = TouchedBy(step.disturbance, facts);
  network_->Begin(index, now_);
  outbox_.Send(ActivityBegun(step.activity, run_->number(), index, step.action));
  outbox_.Send(StartStep{step.activity, step.action, time_limit});
  Changed();
}

void PlanProgress::Stop(int index, const base::Failure& why) {
  StepRun& step = run_->at(index);
  if (step.phase != StepPhase::kRunning || step.is_stopping) return;
  step.is_stopping = true;
  step.stopped = now_;
  step.stop_reason = why;
  outbox_.Send(StopStep{step.activity});
}

void PlanProgress::Blame(int index, const base::Failure& loss) {
  StepRun& step = run_->at(index);
  step.failure = loss;
  step.note = ToString(loss);
  Changed();
}

void PlanProgress::End(int index, StepPhase phase, const std::string& result,
                       const base::Failure& failure) {
  StepRun& step = run_->at(index);
  step.phase = phase;
  step.finished = now_;
  step.failure = failure;
  if (failure) step.note = ToString(failure);
  network_->End(index, now_);
  outbox_.Send(ActivityEnded(step.activity, step.action, result, failure));
  Changed();
}

void PlanProgress::Pass(int index) {
  StepRun& step = run_->at(index);
  step.phase = StepPhase::kDone;
  step.started = step.finished = now_;
  network_->Begin(index, now_);
  network_->End(index, now_);
  Changed();
}

void PlanProgress::Confirm(int index) {
  run_->at(index).phase = StepPhase::kDone;
  Changed();
}

}  // namespace hires::execution
