#include "nodes/execution_monitor/execution_monitor_node.h"

#include <fmt/format.h>
#include <ros/package.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/atoms.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/execution/record_fluent.h"
#include "hires/imagination/imagine_answer.h"
#include "hires/knowledge/state_view.h"
#include "hires/planning/request.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/execution/step_messages.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "nodes/execution_monitor/execution_messages.h"
#include "robot/profile/motion_set_order.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;
namespace knowledge = hires::knowledge;
namespace planning = hires::planning;
using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;

constexpr double kTickPeriod = 0.02;  // [s] steady
constexpr double kClockJump = 1.0;    // [s] backwards: the robot's clock began again
constexpr double kViewPeriod = 0.5;   // [s] between two looks whether something was missed

ActionLinkParams LinkParams(const execution::ServerParams& servers) {
  return {servers.server_wait, servers.server_loss, servers.silence, servers.cancel_wait};
}

double RosNow() { return ros::Time::now().toSec(); }

/// A task that the domain does not know is refused before anything is begun.
void CheckTask(const std::string& text, const planning::Domain& domain) {
  planning::Problem problem;
  planning::SetTasks(text, domain, &problem);
}

/// What people would see differ; bounds in time change all the while.
bool LooksSame(const hires::AchieveFeedback& a, const hires::AchieveFeedback& b) {
  const auto same_step = [](const hires::StepStatus& x, const hires::StepStatus& y) {
    return x.plan == y.plan && x.phase == y.phase && x.note == y.note &&
           x.action.name == y.action.name && x.action.arguments == y.action.arguments;
  };
  const auto same_imagination = [](const auto& x, const auto& y) { return x.outcome == y.outcome; };
  return a.warnings.size() == b.warnings.size() && a.replans == b.replans &&
         std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(), same_step) &&
         std::equal(a.imaginations.begin(), a.imaginations.end(), b.imaginations.begin(),
                    b.imaginations.end(), same_imagination);
}

}  // namespace

execution::MonitorConfig LoadExecutionMonitorParams() {
  RejectUnknownPrivate({"config", "domain", "operators", "robot", "default", "imagination", "seed",
                         "dry_run"});
  const auto path = PrivateText("config");
  execution::MonitorConfig config = execution::ReadMonitorConfig(
      path && !path->empty() ? *path
                             : ros::package::getPath("hires") + "/config/execution_monitor.yaml");
  const auto domain = PrivateText("domain");
  if (domain && !domain->empty()) config.domain = *domain;
  const auto operators = PrivateText("operators");
  if (operators && !operators->empty()) config.operators = *operators;
  const auto robot = PrivateText("robot");
  if (robot && !robot->empty()) config.robot = *robot;
  if (const auto word = PrivateWord("imagination", execution::ImaginePolicyWord()))
    config.monitor.imagination = execution::ReadImaginePolicy(*word);
  config.monitor.dry_run = PrivateBool("dry_run").value_or(config.monitor.dry_run);
  int seed = static_cast<int>(config.imagining.seed);
  Override("seed", PrivateInt("seed"), hires::base::Between(0, 2'147'483'647), &seed);
  config.imagining.seed = static_cast<std::uint64_t>(seed);
  return config;
}

ExecutionKnowledge LoadExecutionKnowledge(const execution::MonitorConfig& config) {
  planning::PlannerConfig planner;
  planner.domain = config.domain;
  ExecutionKnowledge knowledge;
  knowledge.planning = planning::LoadPlanningKnowledge(planner);
  knowledge.operators = planning::LoadOperatorData(config.operators, knowledge.planning.domain);
  knowledge.ontology =
      std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(config.ontology));
  return knowledge;
}

void LoadDefaults(const planning::OperatorData& operators, execution::MonitorConfig* config) {
  config->monitor.defaults =
      execution::ReadDefaults(PrivateText("default").value_or(""), operators);
  if (!LacksDefaults(operators)) return;
  if (config->robot.empty()) {
    throw ConfigError(config->operators +
                      ": an imagined motion set has no default and there is no robot profile to "
                      "find the most cautious one; add `default` there, or set ~robot");
  }
  const auto robot = hires::robot::LoadAnyRobot(config->robot);
  config->monitor.motion_sets = hires::robot::MostCautiousFirst(robot.profile.motion_sets);
}

ExecutionMonitorNode::ExecutionMonitorNode(const execution::MonitorConfig& config,
                                           const ExecutionKnowledge& knowledge, ros::NodeHandle* nh)
    : config_(config),
      knowledge_(knowledge),
      poses_(knowledge.ontology.get(), {config.pose_distance, config.pose_angle}),
      records_(knowledge.ontology),
      planning_(
          &knowledge.planning, config.monitor.planning_timeout, LinkParams(config.servers), nh,
          [this](auto run) { Post(std::move(run)); },
          [this](const execution::PlanArrived& answer) { Feed(answer); }),
      imagination_(
          config.imagining, LinkParams(config.servers), nh,
          [this](auto run) { Post(std::move(run)); },
          [this](const execution::ImagineAnswered& answer) { Feed(answer); }),
      steps_(
          kExecuteAction, LinkParams(config.servers), nh,
          [this](auto run) { Post(std::move(run)); },
          [this](int key, const hires::ExecuteActionResultConstPtr& result, int,
                 const std::string& why) { OnStepEnd(key, result, why); }),
      view_(
          *nh, [this](const RemoteView::Update& update) { OnView(update); }, kViewPeriod),
      client_watch_(
          [this](const std::string& goal) { Post([this, goal] { OnClientGone(goal); }); }),
      server_(
          *nh, kAchieveAction, [this](GoalHandle goal) { Post([this, goal] { Accept(goal); }); },
          [this](GoalHandle goal) { Post([this, goal] { Preempt(goal); }); }, false) {
  updater_.setHardwareID("execution_monitor");
  updater_.add("execution", this, &ExecutionMonitorNode::Diagnose);
  thread_ = std::thread([this] { Run(); });
  progress_subscriber_ =
      nh->subscribe(kObservationProgress, 100, &ExecutionMonitorNode::OnProgress, this);
  server_.start();
}

ExecutionMonitorNode::~ExecutionMonitorNode() {
  is_ending_ = true;
  Post([] {});
  thread_.join();
}

void ExecutionMonitorNode::Post(std::function<void()> run) {
  mailbox_.Post({hires::base::SteadyNow(), std::move(run)});
}

/// On the view's thread.
void ExecutionMonitorNode::OnView(const RemoteView::Update& update) {
  execution::StateObserved state;
  execution::GeometryChanged geometry;
  view_.Read([&](const knowledge::FluentView& view) {
    state.atoms = knowledge::StateAtoms(view, *knowledge_.ontology);
    geometry.instances = poses_.Update(view);
  });
  state.sequence = update.sequence;
  if (!std::exchange(has_atoms_, true) || !hires::base::SameAtoms(state.atoms, atoms_)) {
    atoms_ = state.atoms;
    Post([this, state = std::move(state)] { OnState(state); });
  }
  if (!geometry.instances.empty()) {
    Post([this, geometry = std::move(geometry)] { Feed(geometry); });
  }
  Post([this, sequence = update.sequence, is_fresh = update.is_fresh] {
    if (is_fresh) progress_.clear();  // another store may have taken the place of the one before
    sequence_ = sequence;
    TellProgress();
  });
}

void ExecutionMonitorNode::OnProgress(const hires::ObservationProgress& progress) {
  Post([this, progress] {
    // Of equal numbers the newest says it all; higher ones are of a store that was replaced.
    while (!progress_.empty() && progress_.back().sequence >= progress.sequence) {
      progress_.pop_back();
    }
    progress_.push_back(progress);
    TellProgress();
  });
}

/// Counts as soon as what the Blackboard said then has been told.
void ExecutionMonitorNode::TellProgress() {
  bool is_reached = false;
  for (; !progress_.empty() && progress_.front().sequence <= sequence_; progress_.pop_front()) {
    observed_until_ = {progress_.front().header.stamp.toSec()};
    is_reached = true;
  }
  if (is_reached) Feed(*observed_until_);
}

void ExecutionMonitorNode::Run() {
  while (!is_ending_) {
    auto posted = mailbox_.WaitAndTake(std::chrono::duration<double>(kTickPeriod));
    while (posted && !is_ending_) {
      event_time_ = posted->time;
      posted->run();
      posted = mailbox_.Take();
    }
    event_time_ = 0.0;
    if (!is_ending_) Tick();
  }
  if (task_) FinishTask({execution::Finish::Outcome::kFailed, "the execution monitor ends"});
}

void ExecutionMonitorNode::Tick() {
  const double now = RosNow();
  planning_.Tick();
  imagination_.Tick(now);
  steps_.Tick();
  // A predecessor that crashed left the robot at work without a monitor.
  if (!has_cleared_ && !config_.monitor.dry_run) has_cleared_ = task_ || steps_.CancelLeftGoals();
  WatchClock(now);
  if (task_ && !task_->monitor) BeginWhenReady();
  if (task_ && task_->monitor) {
    const std::optional<double> wake = task_->monitor->WakeAt();
    if (wake && now >= *wake) Feed(execution::ClockTicked{});
  }
  if (task_) PublishFeedback();
  updater_.update();
}

void ExecutionMonitorNode::WatchClock(double now) {
  const bool has_jumped = now < last_now_ - kClockJump;
  last_now_ = now;
  if (has_jumped) {
    progress_.clear();
    observed_until_.reset();
  }
  if (!has_jumped || !task_ || !task_->monitor) return;
  FinishTask({execution::Finish::Outcome::kFailed,
              "the robot's clock jumped back: the robot was started again"});
}

void ExecutionMonitorNode::Accept(GoalHandle goal) {
  goal.setAccepted();
  const std::string& text = goal.getGoal()->task;
  if (task_) {
    return Refuse(goal, hires::AchieveResult::BUSY,
                  fmt::format("'{}' is being done; one task at a time",
                              hires::base::Shortened(task_->goal.getGoal()->task)));
  }
  try {
    CheckTask(text, knowledge_.planning.domain);
    task_ = MakeTask(goal);
  } catch (const ConfigError& error) {
    return Refuse(goal, hires::AchieveResult::INVALID, error.what());
  }
  ++num_tasks_;
  client_watch_.Watch(goal.getGoalID().id);
  Log(LogLevel::kInfo, fmt::format("task='{}' accepted", hires::base::Shortened(text)));
  BeginWhenReady();
}

void ExecutionMonitorNode::Refuse(GoalHandle goal, std::uint8_t code, const std::string& reason) {
  hires::AchieveResult result;
  result.code = code;
  result.reason = hires::base::Shortened(reason);
  Log(LogLevel::kWarn, fmt::format("task='{}' refused: {}",
                                   hires::base::Shortened(goal.getGoal()->task), result.reason));
  goal.setAborted(result, result.reason);
}

/// @throws ConfigError for an unknown policy.
ExecutionMonitorNode::Task ExecutionMonitorNode::MakeTask(const GoalHandle& goal) const {
  Task task;
  task.goal = goal;
  task.params = config_.monitor;
  const std::string& policy = goal.getGoal()->imagination;
  if (!policy.empty()) task.params.imagination = execution::ReadImaginePolicy(policy);
  task.accepted = hires::base::SteadyNow();
  return task;
}

/// What a task cannot be begun without; "": all is there.
std::string ExecutionMonitorNode::MissingForBegin() {
  if (last_now_ <= 0.0 && RosNow() <= 0.0) return "the robot's clock has not begun to run";
  if (!task_->is_state_current) return "the Blackboard does not answer, so the state is not known";
  if (!planning_.is_available()) return "the planner does not answer";
  const bool needs_robot = !task_->params.dry_run;
  if (needs_robot && !steps_.is_available()) return "the middle layer does not answer";
  return "";
}

/// What the Blackboard acknowledged before the task came may still be on its way here, and what the
/// task before this one left behind, that its end takes back, on its way there.
void ExecutionMonitorNode::CatchUp() {
  if (task_->is_state_current || records_.num_waiting() > 0) return;
  if (std::exchange(task_->is_catching_up, true)) return;
  catcher_.Post([this, goal = task_->goal] {
    const bool is_known = view_.CatchUp();
    Post([this, goal, is_known] {  // behind the state that it brought
      if (!task_ || !(task_->goal == goal)) return;
      task_->is_catching_up = false;
      task_->is_state_current = is_known && state_;
      if (task_->is_state_current && !task_->monitor) BeginWhenReady();
    });
  });
}

void ExecutionMonitorNode::BeginWhenReady() {
  CatchUp();
  const std::string missing = MissingForBegin();
  if (!missing.empty()) {
    if (hires::base::SteadyNow() - task_->accepted < config_.start_wait) return;
    return FinishTask({execution::Finish::Outcome::kFailed, missing});
  }
  task_->monitor = std::make_unique<execution::Monitor>(&knowledge_.planning, &knowledge_.operators,
                                                        task_->params);
  imagination_.Clear();
  const std::string text = task_->goal.getGoal()->task;
  records_.BeginEpisode(text, RosNow());
  Feed(*state_);
  if (observed_until_) Feed(*observed_until_);
  Feed(execution::TaskRequested{text});
}

void ExecutionMonitorNode::Preempt(const GoalHandle& goal) {
  if (!task_ || !(task_->goal == goal)) return;
  if (task_->monitor) return Feed(execution::PreemptRequested{});
  FinishTask({execution::Finish::Outcome::kPreempted, "preempted before it was begun"});
}

void ExecutionMonitorNode::OnClientGone(const std::string& goal_id) {
  if (!task_ || task_->goal.getGoalID().id != goal_id) return;
  Log(LogLevel::kWarn,
      fmt::format("task='{}' is preempted: {}, which asked for it, is gone",
                  hires::base::Shortened(task_->goal.getGoal()->task), ClientOf(goal_id)));
  Preempt(task_->goal);
}

void ExecutionMonitorNode::OnState(const execution::StateObserved& state) {
  state_ = state;
  Feed(state);
}

void ExecutionMonitorNode::Feed(const execution::Event& event) {
  if (!task_ || !task_->monitor || task_->finish) return;
  try {
    const auto commands = task_->monitor->Handle(event, RosNow());
    for (const execution::Command& command : commands) {
      std::visit([this](const auto& what) { CarryOut(what); }, command);
    }
  } catch (const std::exception& error) {
    Log(LogLevel::kError, fmt::format("internal: {}", error.what()));
    task_->finish = execution::Finish{execution::Finish::Outcome::kFailed,
                                      std::string("internal: ") + error.what()};
  }
  if (task_->finish) FinishTask(*task_->finish);
}

void ExecutionMonitorNode::CarryOut(const execution::StartPlanning& command) {
  planning_.Start(command);
}

void ExecutionMonitorNode::CarryOut(const execution::CancelPlanning& command) {
  planning_.Cancel(command);
}

void ExecutionMonitorNode::CarryOut(const execution::StartStep& command) {
  HIRES_CHECK(!config_.monitor.dry_run, "a dry run begins no step");
  const int key = next_key_++;
  activities_[key] = command.activity;
  steps_.Send(key, GoalOf(command));
  if (event_time_ > 0.0) reactions_.Add(hires::base::SteadyNow() - event_time_);
  Log(LogLevel::kInfo, fmt::format("activity={} begins {}", command.activity,
                                   hires::base::ToString(command.action)));
}

void ExecutionMonitorNode::CarryOut(const execution::StopStep& command) {
  for (const auto& [key, activity] : activities_) {
    if (activity == command.activity) steps_.Cancel(key);
  }
}

void ExecutionMonitorNode::CarryOut(const execution::StartImagination& command) {
  imagination_.Start(command, RosNow());
}

void ExecutionMonitorNode::CarryOut(const execution::MoveDeadline& command) {
  imagination_.Move(command);
}

void ExecutionMonitorNode::CarryOut(const execution::CancelImagination& command) {
  imagination_.Cancel(command, RosNow());
}

void ExecutionMonitorNode::CarryOut(const execution::Record& command) {
  records_.Write(command, RosNow());
}

void ExecutionMonitorNode::CarryOut(const execution::Warn& command) {
  Log(LogLevel::kWarn, command.text);
  task_->warnings.push_back(command.text);
}

void ExecutionMonitorNode::CarryOut(const execution::Finish& command) { task_->finish = command; }

void ExecutionMonitorNode::OnStepEnd(int key, const hires::ExecuteActionResultConstPtr& result,
                                     const std::string& why) {
  const auto found = activities_.find(key);
  if (found == activities_.end()) return;  // of a task that is over
  const int activity = found->second;
  activities_.erase(found);
  const execution::StepFinished finished =
      result ? AnswerOf(activity, *result)
             : execution::StepFinished{
                   activity, execution::StepFinished::Result::kUnavailable,
                   hires::base::Failure(hires::base::FailureCode::kUnavailable, {}, why)};
  Log(LogLevel::kInfo, fmt::format("activity={} ended {}", activity, ToString(finished.failure)));
  Feed(finished);
}

/// Nothing that the task began goes on.
void ExecutionMonitorNode::EndAll() {
  for (const auto& [key, activity] : std::exchange(activities_, {})) steps_.Cancel(key);
  planning_.CancelAll();
  imagination_.CancelAll(RosNow());
}

void ExecutionMonitorNode::FinishTask(const execution::Finish& finish) {
  EndAll();
  if (task_->monitor) {
    records_.EndEpisode(
        hires::execution::EpisodeOutcome(OutcomeName(finish.outcome), finish.reason), RosNow());
  }
  PublishFeedback();
  Conclude(finish);
  task_.reset();
  client_watch_.Watch("");
}

void ExecutionMonitorNode::Conclude(const execution::Finish& finish) {
  const hires::AchieveFeedback status = Status();
  hires::AchieveResult result;
  result.code = CodeOf(finish.outcome);
  result.failure = ToMsg(finish.failure);
  result.reason = hires::base::Shortened(finish.reason);
  result.episode = task_->monitor ? records_.episode() : 0;
  result.replans = status.replans;
  result.steps = status.steps;
  result.imaginations = status.imaginations;
  result.warnings = task_->warnings;
  Log(LogLevel::kInfo,
      fmt::format("task='{}' {} replans={} {}", hires::base::Shortened(task_->goal.getGoal()->task),
                  OutcomeName(finish.outcome), result.replans, result.reason));
  const bool is_cancelled =
      task_->goal.getGoalStatus().status == actionlib_msgs::GoalStatus::PREEMPTING;
  if (finish.outcome == execution::Finish::Outcome::kSucceeded ||
      finish.outcome == execution::Finish::Outcome::kDryRun) {
    task_->goal.setSucceeded(result, result.reason);
  } else if (finish.outcome == execution::Finish::Outcome::kPreempted && is_cancelled) {
    task_->goal.setCanceled(result, result.reason);
  } else {
    task_->goal.setAborted(result, result.reason);
  }
}

hires::AchieveFeedback ExecutionMonitorNode::Status() const {
  hires::AchieveFeedback status;
  if (!task_->monitor) return status;
  const std::vector<execution::StepStatus> steps = task_->monitor->Steps();
  for (const execution::StepStatus& step : steps) {
    status.steps.push_back(ToMsg(step));
    status.replans = std::max(status.replans, step.plan);  // each repair has the next number
  }
  status.imaginations = imagination_.Statuses();
  for (hires::ImaginationStatus& imagined : status.imaginations) {
    const auto dispatch =
        hires::imagination::DispatchOf(steps, static_cast<int>(imagined.plan),
                                       static_cast<int>(imagined.step), FromMsg(imagined.action));
    imagined.dispatch = dispatch.value_or(kNever);
  }
  return status;
}

/// At its period, and whenever something changed.
void ExecutionMonitorNode::PublishFeedback() {
  hires::AchieveFeedback feedback = Status();
  feedback.warnings = task_->warnings;
  const double now = hires::base::SteadyNow();
  if (now < task_->next_feedback && task_->told && LooksSame(*task_->told, feedback)) return;
  task_->next_feedback = now + config_.feedback_period;
  task_->goal.publishFeedback(feedback);
  task_->told = std::move(feedback);
}

void ExecutionMonitorNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  const bool has_robot = config_.monitor.dry_run || steps_.is_available();
  const bool is_complete =
      planning_.is_available() && has_robot && imagination_.is_available() && view_.is_connected();
  const std::string task = task_ ? hires::base::Shortened(task_->goal.getGoal()->task) : "no task";
  status.summary(is_complete ? Level::OK : Level::WARN, task);
  const auto word = [](bool is_there) { return is_there ? "there" : "away"; };
  status.add("planner", word(planning_.is_available()));
  status.add("middle_layer", word(steps_.is_available()));
  status.add("imagination_client", word(imagination_.is_available()));
  status.add("translator", word(imagination_.is_translator_available()));
  status.add("blackboard", word(view_.is_connected()));
  status.add("dry_run", config_.monitor.dry_run);
  status.add("tasks", num_tasks_);
  status.add("records_waiting", records_.num_waiting());
  status.add("records_written", records_.num_written());
  status.add("records_refused", records_.num_refused());
  status.add("reactions", reactions_.size());
  status.add("reaction_p50_ms", 1e3 * reactions_.Quantile(0.5));
  status.add("reaction_p99_ms", 1e3 * reactions_.Quantile(0.99));
  status.add("reaction_max_ms", 1e3 * reactions_.Quantile(1.0));
}

}  // namespace hires_ros
