#include "loop/monitor_shell.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "hires/base/atoms.h"
#include "hires/execution/record_fluent.h"
#include "hires/imagination/imagine_answer.h"
#include "hires/knowledge/state_view.h"
#include "robot/profile/motion_set_order.h"

namespace hires::loop {
namespace {

using execution::Finish;

execution::MonitorParams ParamsOf(const LoopSetup::Parts& parts, const LoopOrder& order) {
  execution::MonitorParams params = parts.config.execution.monitor;
  if (!order.imagination.empty()) {
    params.imagination = execution::ReadImaginePolicy(order.imagination);
  }
  params.defaults = execution::ReadDefaults(order.defaults, parts.operators);
  params.motion_sets = robot::MostCautiousFirst(parts.world.scene->robot.profile.motion_sets);
  params.dry_run = params.dry_run || order.dry_run;
  return params;
}

execution::ImaginingParams ImaginingOf(const LoopSetup::Parts& parts, const LoopOrder& order) {
  execution::ImaginingParams params = parts.config.execution.imagining;
  params.seed = order.seed;
  if (order.rollouts > 0) params.rollouts = order.rollouts;
  return params;
}

AchieveOutcome OutcomeOf(Finish::Outcome outcome) {
  switch (outcome) {
    case Finish::Outcome::kSucceeded:
      return AchieveOutcome::kSucceeded;
    case Finish::Outcome::kNoPlan:
      return AchieveOutcome::kNoPlan;
    case Finish::Outcome::kFailed:
      return AchieveOutcome::kFailed;
    case Finish::Outcome::kPreempted:
      return AchieveOutcome::kPreempted;
    case Finish::Outcome::kDryRun:
      return AchieveOutcome::kDryRun;
  }
  return AchieveOutcome::kFailed;
}

}  // namespace

MonitorShell::MonitorShell(const LoopSetup::Parts& parts, const LoopOrder& order,
                           VirtualClock* clock, Blackboard* blackboard, RolloutPool* pool,
                           Hooks hooks)
    : task_(order.task),
      clock_(*clock),
      blackboard_(*blackboard),
      hooks_(std::move(hooks)),
      poses_(parts.ontology.get(),
             {parts.config.execution.pose_distance, parts.config.execution.pose_angle}),
      records_(blackboard),
      planning_(parts.planning, parts.config.planning_time, clock,
                [this](const execution::PlanArrived& answer) { Feed(answer); }),
      imagination_(parts.world, parts.context, parts.config.imagination, ImaginingOf(parts, order),
                   parts.config.pace, clock, blackboard, pool,
                   [this](const execution::ImagineAnswered& answer) { Feed(answer); }),
      monitor_(&parts.planning, &parts.operators, ParamsOf(parts, order)) {}

void MonitorShell::Begin() {
  records_.BeginEpisode(task_, clock_.now());
  has_begun_ = true;
  Feed(execution::StateObserved{atoms_, blackboard_.view().sequence()});
  if (observed_until_) Feed(execution::ObservedUntil{*observed_until_});
  Feed(execution::TaskRequested{task_});
}

void MonitorShell::OnView() {
  auto atoms = knowledge::StateAtoms(blackboard_.view(), blackboard_.ontology());
  const execution::GeometryChanged moved{poses_.Update(blackboard_.view())};
  if (!base::SameAtoms(atoms, atoms_)) {
    atoms_ = std::move(atoms);
    Feed(execution::StateObserved{atoms_, blackboard_.view().sequence()});
  }
  if (!moved.instances.empty()) Feed(moved);
}

void MonitorShell::OnObservedUntil(double time) {
  observed_until_ = time;
  Feed(execution::ObservedUntil{time});
}

void MonitorShell::Feed(const execution::Event& event) {
  if (!has_begun_ || finish_) return;
  for (const execution::Command& command : monitor_.Handle(event, clock_.now())) {
    std::visit([this](const auto& what) { CarryOut(what); }, command);
  }
  if (!finish_) return AskForWake();
  planning_.CancelAll();
  imagination_.CancelAll();
  const std::string outcome = ToString(OutcomeOf(finish_->outcome));
  records_.EndEpisode(execution::EpisodeOutcome(outcome, finish_->reason), clock_.now());
}

void MonitorShell::AskForWake() {
  const std::optional<double> wake = monitor_.WakeAt();
  if (!wake) return;
  clock_.At(*wake, [this] {
    const std::optional<double> due = monitor_.WakeAt();
    if (due && *due <= clock_.now()) Feed(execution::ClockTicked{});
  });
}

AchieveStatus MonitorShell::Status() const {
  AchieveStatus status;
  status.now = clock_.now();
  status.steps = monitor_.Steps();
  for (const execution::StepStatus& step : status.steps) {
    status.replans = std::max(status.replans, step.plan);
  }
  status.imaginations = imagination_.steps();
  for (ImaginedStep& imagined : status.imaginations) {
    imagined.dispatch =
        imagination::DispatchOf(status.steps, imagined.plan, imagined.step, imagined.action);
  }
  status.warnings = warnings_;
  return status;
}

AchieveReport MonitorShell::Report() const {
  AchieveReport report;
  report.task = task_;
  report.outcome = OutcomeOf(finish_->outcome);
  report.reason = finish_->reason;
  report.failure = finish_->failure;
  report.episode = records_.episode();
  report.status = Status();
  return report;
}

}  // namespace hires::loop
