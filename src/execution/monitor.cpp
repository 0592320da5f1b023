#include "hires/execution/monitor.h"

#include <algorithm>

#include "execution/duration_desk.h"
#include "execution/imagination_desk.h"
#include "execution/plan_quest.h"
#include "execution/repair.h"
#include "execution/session.h"
#include "execution/step_dispatch.h"
#include "execution/step_watch.h"
#include "hires/base/error.h"
#include "hires/base/overloaded.h"
#include "hires/base/text.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"

namespace hires::execution {

/// Goes from stage to stage; the parts do the work.
struct Monitor::Impl {
  enum class Stage {
    kIdle,
    kPlanning,  ///< of the first plan
    kExecuting,
    kRepairing,  ///< what runs goes on, nothing new begins
    kEnding,     ///< until every step has stopped
  };

  Impl(const planning::PlanningKnowledge* knowledge, const planning::OperatorData* operators,
       const MonitorParams& params)
      : session(knowledge, operators, params) {}

  void On(const TaskRequested& event);
  void On(const PlanArrived& event) { quest.OnAnswer(event); }
  void On(const StepFinished& event) { watch.OnFinished(event); }
  void On(const StateObserved& event) { session.state().Observe(event); }
  void On(const ObservedUntil& event) { session.state().ObserveUntil(event.time); }
  void On(const GeometryChanged& event) { desk.OnChanged(event); }
  void On(const ImagineAnswered& event);
  void On(const PreemptRequested&);
  void On(const ClockTicked&) {}

  void Advance();
  void Plan();
  void Execute();
  void EndDryRun();
  void Mend();
  void TakeUpViolation();
  void Conclude(Finish::Outcome outcome, const std::string& reason,
                const base::Failure& failure = {});
  void EndIfStill();

  Session session;
  StepWatch watch{&session};
  ImaginationDesk desk{&session};
  DurationDesk durations{&session};
  StepDispatch dispatch{&session, &desk};
  PlanQuest quest{&session};
  Repair repair{&session, &quest};
  Stage stage{Stage::kIdle};
  Finish ending;
};

void Monitor::Impl::On(const TaskRequested& event) {
  if (stage != Stage::kIdle) {
    return session.outbox().Warning("'" + event.task + "' is not taken up: '" +
                                    session.progress().task() +
                                    "' is being carried out; preempt it first");
  }
  session.progress().BeginTask(event.task);
  stage = Stage::kPlanning;
  planning::Problem problem;
  problem.source = "task";
  try {
    if (!session.state().is_known())
      throw base::ConfigError("nothing has been observed yet; try again");
    problem.tasks = planning::ReadTasks(event.task, "task");
    problem.facts = session.state().facts().Data();
    CheckTasks(problem, session.domain());
  } catch (const base::ConfigError& error) {
    return Conclude(Finish::Outcome::kFailed, error.what());
  }
  repair.BeginTask(problem);
  quest.Begin({{std::move(problem), event.task}}, session.state().facts());
}

void Monitor::Impl::On(const ImagineAnswered& event) {
  desk.OnAnswer(event);
  durations.OnAnswer(event);
}

void Monitor::Impl::On(const PreemptRequested&) {
  if (stage == Stage::kIdle || stage == Stage::kEnding) return;
  Conclude(Finish::Outcome::kPreempted, ToString(base::FailureCode::kPreempted),
           base::FailureCode::kPreempted);
}

/// Until nothing changes any more.
void Monitor::Impl::Advance() {
  for (bool again = true; again;) {
    const Stage stage_before = stage;
    const int revision_before = session.revision();
    switch (stage) {
      case Stage::kIdle:
        return;
      case Stage::kPlanning:
        Plan();
        break;
      case Stage::kExecuting:
        Execute();
        break;
      case Stage::kRepairing:
        Mend();
        break;
      case Stage::kEnding:
        EndIfStill();
        break;
    }
    again = stage != stage_before || session.revision() != revision_before;
  }
}

void Monitor::Impl::Plan() {
  quest.Update();
  if (quest.is_under_way()) return;
  if (quest.outcome() != PlanQuest::Outcome::kFound) {
    const bool is_none = quest.outcome() == PlanQuest::Outcome::kNoPlan;
    return Conclude(is_none ? Finish::Outcome::kNoPlan : Finish::Outcome::kFailed, quest.why());
  }
  try {
    PlanRun run(session.progress().next_plan(), quest.plan(), quest.problem(), session.domain(),
                session.operators());
    std::vector<int> informs = InformedSteps(run);
    session.progress().Adopt(std::move(run), std::move(informs), {});
  } catch (const base::ConfigError& error) {
    return Conclude(Finish::Outcome::kFailed,
                    std::string("the planner's plan is of no use: ") + error.what());
  }
  desk.Open();
  stage = Stage::kExecuting;
}

void Monitor::Impl::Execute() {
  watch.Check(true);
  if (!watch.lost().empty())
    return Conclude(Finish::Outcome::kFailed, watch.lost(), base::FailureCode::kDidNotStop);
  const bool is_dry_run = session.params().dry_run;
  if (session.progress().run().IsOver() && !is_dry_run)
    return Conclude(Finish::Outcome::kSucceeded, "");
  if (!session.has_violation()) desk.Update();
  if (session.has_violation()) return TakeUpViolation();
  if (is_dry_run) return EndDryRun();
  dispatch.Run();
}

/// As soon as all is known that would have been asked, and how long what comes of it lasts.
void Monitor::Impl::EndDryRun() {
  if (!desk.IsAnswered()) return;
  desk.SettleAll();
  durations.Update();
  if (!durations.IsAnswered()) return;
  durations.SayWhatIsUnknown();
  // In earnest such a step would be begun with its default, and most likely be refused.
  if (const std::vector<std::string> invalid = desk.Invalid(); !invalid.empty()) {
    return Conclude(Finish::Outcome::kFailed, base::Join(invalid, "; "),
                    base::FailureCode::kInvalidAction);
  }
  std::vector<std::string> unimagined = desk.Unimagined();
  unimagined.insert(unimagined.end(), durations.unimagined().begin(), durations.unimagined().end());
  if (!unimagined.empty()) {
    return Conclude(Finish::Outcome::kFailed,
                    "planned, but not imagined: " + base::Join(unimagined, "; ") +
                        "; start what imagines (roslaunch hires imagination.launch, and "
                        "translator.launch), or ask for no imagination (off); nothing was begun",
                    base::FailureCode::kUnavailable);
  }
  const bool is_off = session.params().imagination == MonitorParams::ImaginePolicy::kOff;
  Conclude(Finish::Outcome::kDryRun,
           is_off ? "planned; nothing was begun" : "planned and imagined; nothing was begun");
}

void Monitor::Impl::TakeUpViolation() {
  durations.Close();  // they were asked of the plan that is mended now
  const std::string useless = repair.Begin(*session.TakeViolation());
  if (!useless.empty()) {
    return Conclude(Finish::Outcome::kFailed, useless, repair.failure());
  }
  stage = Stage::kRepairing;
}

void Monitor::Impl::Mend() {
  watch.Check(false);
  if (!watch.lost().empty())
    return Conclude(Finish::Outcome::kFailed, watch.lost(), base::FailureCode::kDidNotStop);
  if (session.has_violation()) TakeUpViolation();
  if (stage != Stage::kRepairing) return;
  switch (repair.Update()) {
    case Repair::Result::kUnderWay:
      return;
    case Repair::Result::kMended:
      desk.Open();
      stage = Stage::kExecuting;
      return;
    case Repair::Result::kNoPlan:
      return Conclude(Finish::Outcome::kNoPlan, repair.why(), repair.failure());
    case Repair::Result::kFailed:
      return Conclude(Finish::Outcome::kFailed, repair.why(), repair.failure());
  }
}

void Monitor::Impl::Conclude(Finish::Outcome outcome, const std::string& reason,
                             const base::Failure& failure) {
  desk.Close();
  durations.Close();
  quest.Cancel();
  repair.Cancel();
  if (session.progress().has_plan()) {
    for (const int step : session.progress().run().Active()) session.progress().Stop(step);
  }
  ending = {outcome, reason, failure};
  stage = Stage::kEnding;
}

void Monitor::Impl::EndIfStill() {
  if (session.progress().has_plan()) {
    watch.Check(false);
    session.TakeViolation();  // it does not matter any more
    const PlanRun& run = session.progress().run();
    const std::vector<int> active = run.Active();
    const auto moves = [&](int step) { return run.at(step).phase == StepPhase::kRunning; };
    if (std::any_of(active.begin(), active.end(), moves)) return;
  }
  session.EndTask();
  session.outbox().Send(ending);
  stage = Stage::kIdle;
}

Monitor::Monitor(const planning::PlanningKnowledge* knowledge,
                 const planning::OperatorData* operators, const MonitorParams& params)
    : impl_(std::make_unique<Impl>(knowledge, operators, params)) {}

Monitor::~Monitor() = default;

std::vector<Command> Monitor::Handle(const Event& event, double now) {
  impl_->session.progress().SetNow(now);
  std::visit([&](const auto& e) { impl_->On(e); }, event);
  impl_->Advance();
  return impl_->session.outbox().Take();
}

std::optional<double> Monitor::WakeAt() const {
  if (impl_->stage == Impl::Stage::kIdle) return std::nullopt;
  std::optional<double> wake;
  for (const std::optional<double>& at : {impl_->watch.WakeAt(), impl_->desk.WakeAt(),
                                          impl_->durations.WakeAt(), impl_->quest.WakeAt()}) {
    if (at) wake = std::min(wake.value_or(*at), *at);
  }
  return wake;
}

bool Monitor::is_busy() const { return impl_->stage != Impl::Stage::kIdle; }

std::vector<StepStatus> Monitor::Steps() const { return impl_->session.progress().Steps(); }

}  // namespace hires::execution
