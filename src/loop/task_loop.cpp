#include "loop/task_loop.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "loop/area_fluents.h"
#include "loop/loop_parts.h"
#include "loop/middle_layer.h"
#include "loop/monitor_shell.h"
#include "loop/robot_side.h"
#include "loop/task_names.h"
#include "loop/virtual_clock.h"
#include "sim_robot/scenario.h"
#include "sim_robot/scenario_names.h"

namespace hires::loop {
namespace {

constexpr double kAllTold = 1.0;       // [s] until what is observed at first has been told
constexpr double kFarewell = 2.0;      // [s] in which all comes to rest after the end
constexpr double kStatusPeriod = 0.2;  // [s]
enum LineStreams : std::uint64_t {
  kSensorLine = 300,
  kLookLine,
  kGoalLine,
  kEndLine,
  kBlackboardLine
};

using control::ActionEnd;
using execution::StepFinished;

StepFinished FinishedAs(int activity, ActionEnd end, const base::Failure& failure) {
  switch (end) {
    case ActionEnd::kSucceeded:
      return {activity, StepFinished::Result::kSucceeded, {}};
    case ActionEnd::kPreempted:
      return {activity, StepFinished::Result::kPreempted, failure};
    case ActionEnd::kFailed:
      break;
  }
  return {activity, StepFinished::Result::kFailed, failure};
}

LoopOrder Completed(const LoopOrder& order, const sim_robot::Scenario& scenario,
                    const LoopSetup::Parts& parts) {
  LoopOrder complete = order;
  if (complete.task.empty()) complete.task = scenario.task;
  RequireKnownNames(parts, scenario, complete.task, StrangeArgument::kWarnedOf);
  return complete;
}

sim_robot::SimSensorParams SensorsIn(const std::string& scenario,
                                     sim_robot::SimSensorParams sensors) {
  sensors.cameras.temperatures = sim_robot::TemperaturesOf(scenario);
  return sensors;
}

/// Those that stand in no knowledge file.
std::vector<std::string> AreasOf(const LoopSetup& setup) {
  std::vector<std::string> names;
  for (const world::NamedArea& area : setup.parts().config.scene.areas) names.push_back(area.name);
  return names;
}

/// What is on its way between them.
struct Lines {
  Lines(const LoopMessages& messages, const base::Rng& rng, VirtualClock* clock)
      : sensors(messages.sensors, rng.Fork(kSensorLine), clock),
        looks(messages.looks, rng.Fork(kLookLine), clock),
        goals(messages.actions, rng.Fork(kGoalLine), clock),
        ends(messages.actions, rng.Fork(kEndLine), clock),
        blackboard(messages.blackboard, rng.Fork(kBlackboardLine), clock) {}

  MessageLine sensors, looks, goals, ends, blackboard;
};

/// All parts of one task, wired.
class TaskPlay {
 public:
  TaskPlay(const LoopSetup::Parts& parts, const LoopOrder& order,
           const sim_robot::Scenario& scenario, const LoopObserver& observer)
      : observer_(observer),
        order_(Completed(order, scenario, parts)),
        truth_(WithSensing(parts.ReadTruth(order.truth), order.sensing)),
        clock_(kStart),
        lines_(parts.config.messages, base::Rng(order.seed), &clock_),
        blackboard_(parts.ontology, order.store),
        pool_(order.threads),
        robot_(
            parts, sim_robot::StartOf(parts.world, order.scenario, ""), truth_,
            SensorsIn(order.scenario, parts.SensorsUnder(truth_)), order.seed, &clock_,
            {[this](const SensorNews& news) { Hear(news); }, [this](double stamp) { Look(stamp); },
             true, parts.world.sensing.ground.is_enabled}),
        middle_layer_(parts.world, FramesOf(parts.world.scene->robot), parts.config.runner,
                      parts.config.scan,
                      {[this](const robot::Command& command) { Send(command); },
                       [this](int activity, ActionEnd end, const base::Failure& failure) {
                         Tell(observer_.ended, clock_.now(), activity, end, failure);
                         tracker_.OnActions(middle_layer_.running());
                         lines_.ends.Send([this, activity, end, failure] {
                           monitor_.OnStepEnded(FinishedAs(activity, end, failure));
                         });
                       }}),
        tracker_(parts.world, parts.context, FramesOf(parts.world.scene->robot),
                 parts.config.tracker, &clock_, &blackboard_, TrackerHooks()),
        monitor_(parts, order_, &clock_, &blackboard_, &pool_,
                 {[this](const execution::StartStep& step) { Start(step); },
                  [this](int activity) {
                    lines_.goals.Send([this, activity] { middle_layer_.Cancel(activity); });
                  }}) {
    blackboard_.Load(scenario.knowledge, order.seed);
    blackboard_.Write(AreaFluents(parts.config.scene.areas, blackboard_.view(), *parts.ontology),
                      {}, {}, {knowledge::Source::kKnowledge, 0, -temporal::kForever});
    blackboard_.SetListener([this] { OnWritten(); });
    OnWritten();
  }

  LoopRun Run(const OnAchieveStatus& on_status, const std::function<bool()>& cancelled) {
    robot_.Begin();
    for (const double loss : order_.middle_layer_losses) {
      clock_.At(loss, [this] { middle_layer_.FailAll(base::FailureCode::kUnavailable); });
    }
    LoopRun run;
    double next_status = 0.0, end = order_.time_limit + kStart;
    bool is_stopping = false;
    while (clock_.Step() && clock_.now() < end) {
      if (monitor_.is_over() && !std::exchange(is_stopping, true)) {
        middle_layer_.CancelAll();
        tracker_.SetEpisode(0);  // it has ended: what is seen from now on is of none
        end = clock_.now() + kFarewell;
      }
      if (clock_.now() < next_status || is_stopping) continue;
      next_status = clock_.now() + kStatusPeriod;
      if (on_status && monitor_.has_begun()) on_status(monitor_.Status());
      if (cancelled && cancelled()) monitor_.Preempt();
    }
    if (!monitor_.is_over()) {
      run.is_timed_out = true;
      run.report.task = order_.task;
      run.report.reason = "its time was over";
      run.report.status = monitor_.Status();
    } else {
      run.report = monitor_.Report();
      if (run.report.outcome == AchieveOutcome::kDryRun) RefuseImpossibleSteps(&run.report);
    }
    run.truth_name = truth_.name;
    run.truth = {robot_.truth().objects(), robot_.truth().contact()};
    run.virtual_seconds = clock_.now() - kStart;
    return run;
  }

 private:
  template <typename... Args, typename... Values>
  static void Tell(const std::function<void(Args...)>& observe, const Values&... values) {
    if (observe) observe(values...);
  }

  /// In earnest these would be the steps at which the task ends.
  void RefuseImpossibleSteps(AchieveReport* report) const {
    std::vector<std::string> why;
    for (const execution::StepStatus& step : report->status.steps) {
      const bool is_to_begin = step.phase == execution::StepPhase::kWaiting ||
                               step.phase == execution::StepPhase::kReady;
      if (!step.is_of_robot || !is_to_begin) continue;
      const base::Failure refusal = middle_layer_.Refusal(step.action);
      if (!refusal) continue;
      if (!report->failure) report->failure = refusal;
      why.push_back(
          fmt::format("step {}, {}: {}", step.index + 1, ToString(step.action), ToString(refusal)));
    }
    if (why.empty()) return;
    report->outcome = AchieveOutcome::kFailed;
    report->reason = base::Join(why, "; ");
  }

  void Send(const robot::Command& command) {
    Tell(observer_.commanded, clock_.now(), command);
    robot_.Command(command);
  }

  Tracker::Hooks TrackerHooks() {
    return {
        [this](double stamp, world::WorldState known) {
          Tell(observer_.known, stamp, known);
          middle_layer_.OnKnownObjects(stamp, std::move(known));
        },
        [this](const robot::JointTrajectory& turn) {
          robot::Command command;
          command.trajectories["head"] = turn;
          Send(command);
        },
        [this](double time) { lines_.blackboard.Send([this, time] { OnObservedUntil(time); }); }};
  }

  void Hear(const SensorNews& news) {
    Tell(observer_.sensed, news);
    middle_layer_.Hear(news, robot_.laser());
    if (news.is_tick) monitor_.OnLocalised({news.readings.X_MB, news.readings.covariance});
    SensorNews rest = news;
    if (const auto seen = std::exchange(rest.seen, std::nullopt)) {
      lines_.looks.Send([this, stamp = news.stamp, seen = *seen] { tracker_.See(stamp, seen); });
    }
    if (news.heat) lines_.looks.Send([this, heat = news.heat] { tracker_.See(*heat); });
    lines_.sensors.Send([this, rest = std::move(rest)] { tracker_.Hear(rest, robot_.laser()); });
  }

  void Look(double stamp) { middle_layer_.Look(stamp); }

  void Start(const execution::StartStep& step) {
    lines_.goals.Send([this, step] {
      Tell(observer_.began, clock_.now(), step.activity, step.action);
      middle_layer_.Start(step.activity, step.action, step.time_limit);
      tracker_.OnActions(middle_layer_.running());
    });
  }

  /// Told once for all that is written until then.
  void OnWritten() {
    tracker_.OnView();
    if (std::exchange(is_view_due_, true)) return;
    lines_.blackboard.Send([this] {
      is_view_due_ = false;
      monitor_.OnView();
    });
  }

  void OnObservedUntil(double time) {
    monitor_.OnObservedUntil(time);
    if (monitor_.has_begun() || clock_.now() < kStart + kAllTold) return;
    monitor_.Begin();
    tracker_.SetEpisode(monitor_.episode());
  }

  const LoopObserver& observer_;
  const LoopOrder order_;
  const sim_robot::Truth truth_;
  VirtualClock clock_;
  Lines lines_;
  Blackboard blackboard_;
  RolloutPool pool_;
  RobotSide robot_;
  MiddleLayer middle_layer_;
  Tracker tracker_;
  MonitorShell monitor_;
  bool is_view_due_{false};
};

}  // namespace

void RequireTask(const LoopSetup& setup, const std::string& scenario, const std::string& task) {
  RequireKnownNames(setup.parts(), sim_robot::ReadScenario(scenario), task,
                    StrangeArgument::kRefused);
}

LoopRun PlayTask(const LoopSetup& setup, const LoopOrder& order, const OnAchieveStatus& on_status,
                 const std::function<bool()>& cancelled, const LoopObserver& observer) {
  if (!order.store.empty() && std::filesystem::exists(order.store)) {
    throw base::ConfigError(order.store +
                            ": is there already; name a new file, for the Blackboard is to know "
                            "what holds at first and nothing else");
  }
  const sim_robot::Scenario scenario = sim_robot::ReadScenario(order.scenario);
  const std::string& task = order.task.empty() ? scenario.task : order.task;
  for (const auto& misfit :
       sim_robot::NamesThatDoNotFit(scenario, order.scenario, task, AreasOf(setup))) {
    base::Log(base::LogLevel::kWarn, misfit);
  }
  return TaskPlay(setup.parts(), order, scenario, observer).Run(on_status, cancelled);
}

}  // namespace hires::loop
