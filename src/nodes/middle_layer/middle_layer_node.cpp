#include "nodes/middle_layer/middle_layer_node.h"

#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>

#include <algorithm>

#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/ros/names/robot_topics.h"

namespace hires_ros {
namespace {

using Code = hires::base::FailureCode;
using hires::base::ActionCall;
using hires::base::Failure;
using hires::base::LogLevel;
using hires::control::ActionEnd;
using hires::control::ActionNews;

constexpr auto kBlindStop = std::chrono::seconds(3);  // that a stop may go on unseen
constexpr auto kFarewell = std::chrono::seconds(5);   // that the node takes to stop the robot

/// Runs a function in the thread that spins.
class Call : public ros::CallbackInterface {
 public:
  explicit Call(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

void PostToSpinner(std::function<void()> function) {
  ros::getGlobalCallbackQueue()->addCallback(boost::make_shared<Call>(std::move(function)));
}

}  // namespace

MiddleLayerNode::MiddleLayerNode(const MiddleLayerParams& params,
                                 hires::imagination::ImaginationSetup setup, ros::NodeHandle* nh)
    : params_(params),
      setup_(std::move(setup)),
      runner_(setup_.scene->robot, params.runner, RunnerHooks()),
      goals_({params.start_patience, params.feedback_period, params.dry_run}, GoalHooks(), nh),
      display_(params.names.map_frame, params.names.map_to_world, nh),
      inputs_(setup_, params.names, params.scan,
              {[this](const std::string& topic, double stamp) { OnArrived(topic, stamp); },
               [this] {
                 looked_ = -1.0;
                 if (lockstep_) lockstep_->ForgetArrivals();
               }},
              nh),
      last_look_(Steady::now()) {
  ConnectRobot(nh);
  updater_.setHardwareID(setup_.scene->robot.model.name);
  updater_.add("actions", this, &MiddleLayerNode::Diagnose);
  // Also while the robot's time stands, by which update() would wait.
  heartbeat_ = nh->createWallTimer(
      ros::WallDuration(1.0), boost::function<void(const ros::WallTimerEvent&)>(
                                  [this](const ros::WallTimerEvent&) { updater_.force_update(); }));
  goals_.Start();
}

void MiddleLayerNode::ConnectRobot(ros::NodeHandle* nh) {
  if (!params_.dry_run) {
    controllers_.emplace(params_.names,
                         params_.guard.is_there ? kGuardCommand : params_.names.base_command, nh);
    driving_ = std::make_unique<BaseDriving>(
        params_, setup_, &*controllers_,
        [this](const Failure& failure) { runner_.FailAll(failure); }, nh);
  }
  if (params_.lockstep) {
    lockstep_ = std::make_unique<LockstepClient>(nh, [this] { LookAtTick(); });
  }
  if (params_.names.motors_halted.empty()) return;
  motors_ = nh->subscribe<std_msgs::Bool>(
      params_.names.motors_halted, 10,
      boost::function<void(const std_msgs::BoolConstPtr&)>(
          [this](const std_msgs::BoolConstPtr& msg) { OnMotorsHalted(msg->data != 0); }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

// Actions -----------------------------------------------------------------------------------------

hires::control::ActionRunner::Hooks MiddleLayerNode::RunnerHooks() {
  return {[this](const hires::robot::Command& command) { Send(command); },
          [this](const ActionNews& news, ActionEnd end, const Failure& failure) {
            OnEnded(news, end, failure);
          },
          [this] {
            PostToSpinner([this] {
              runner_.Collect();
              PublishFeedback();
              AnswerTick();
            });
          },
          [this](const ActionNews& news) {
            if (news.has_base) driving_->BreakOff();
          }};
}

ActionGoals::Hooks MiddleLayerNode::GoalHooks() {
  return {[this](const ActionCall& action) { hires::skills::MakeSkill(*setup_.skills, action); },
          [this](const ActionCall& action) { return WhyNotReady(action); },
          [this](int id, const ActionCall& action, double time_limit) {
            return Start(id, action, time_limit);
          },
          [this](int id, const ActionCall& action) {
            if (GroupsOf(action).count("base") > 0) driving_->Begin(id, action);
          },
          [this](int id) { runner_.Cancel(id); }};
}

/// @pre the action was accepted.
std::set<std::string> MiddleLayerNode::GroupsOf(const ActionCall& action) const {
  return hires::actions::GroupsOf(hires::skills::SpecOf(*setup_.skills, action), action);
}

/// In lockstep a robot that would go on without an answer is a missing controller, too.
Failure MiddleLayerNode::WhyNotReady(const ActionCall& action) const {
  if (are_motors_halted_) return Code::kMotorsHalted;
  const std::string missing = controllers_->Missing(GroupsOf(action));
  if (!missing.empty()) return {Code::kNoController, {}, missing};
  if (lockstep_) {
    return lockstep_->is_awaited() ? Failure()
                                   : Failure{Code::kNoController, {}, lockstep_->topic()};
  }
  const double now = ros::Time::now().toSec(), limit = params_.runner.stale_after;
  if (!inputs_.state().CompleteUntil() || ros::Time::now().isZero()) {
    return {Code::kStaleObservation, {}, "nothing comes on " + inputs_.Missing()};
  }
  return now - looked_ <= limit ? Failure()
                                : hires::control::Stale(now - looked_, limit, inputs_.Missing());
}

Failure MiddleLayerNode::Start(int id, const ActionCall& action, double time_limit) {
  const double now = std::max(looked_, ros::Time::now().toSec());
  return runner_.Start(id, action, GroupsOf(action), driving_->MakeSkill(action), time_limit, now);
}

void MiddleLayerNode::OnEnded(const ActionNews& news, ActionEnd end, const Failure& failure) {
  if (news.has_base) driving_->End(news.id);
  goals_.End(news, end, failure);
}

void MiddleLayerNode::PublishFeedback() {
  std::vector<ActionNews> news = runner_.News();
  for (ActionNews& entry : news) {
    if (entry.has_base && driving_->is_overridden()) entry.phase = "overridden";
  }
  goals_.PublishFeedback(news);
  ShowDrive(news);
}

void MiddleLayerNode::ShowDrive(const std::vector<ActionNews>& news) {
  const auto driving = std::find_if(
      news.begin(), news.end(), [](const ActionNews& entry) { return entry.drive.has_value(); });
  display_.Show(std::max(looked_, 0.0), driving == news.end() ? std::nullopt : driving->drive);
}

/// @pre not in a dry run: no action runs then.
void MiddleLayerNode::Send(const hires::robot::Command& command) {
  if (command.base_velocity) driving_->Command(*command.base_velocity);
  controllers_->Send(command);
}

// Looks at the robot ------------------------------------------------------------------------------

/// An emergency stop halts the arms too.
void MiddleLayerNode::OnMotorsHalted(bool are_halted) {
  if (are_halted && !are_motors_halted_) {
    hires::base::Log(LogLevel::kWarn, "motors=halted everything that runs ends");
    runner_.FailAll(Code::kMotorsHalted);
  }
  are_motors_halted_ = are_halted;
}

void MiddleLayerNode::OnArrived(const std::string& topic, double stamp) {
  if (lockstep_) {
    lockstep_->NoteArrival(topic, stamp);
    LookAtTick();
  } else if (topic == params_.names.odometry || topic == params_.names.joint_states) {
    LookWhereFree();
  }
}

void MiddleLayerNode::LookWhereFree() {
  const auto complete = inputs_.state().CompleteUntil();
  if (!complete || *complete <= looked_) return;
  looked_ = *complete;
  LookAt(looked_, looked_);
}

void MiddleLayerNode::LookAtTick() {
  const std::optional<double> stamp = lockstep_->TakeDue();
  if (!stamp) return;
  const auto complete = inputs_.state().CompleteUntil();
  if (complete && *complete >= *stamp - kSameStamp) {
    looked_ = *stamp;
    LookAt(*stamp, std::min(*stamp, *complete));
  } else {
    runner_.CheckFreshness(*stamp, inputs_.Missing());
  }
  AnswerTick();
}

void MiddleLayerNode::AnswerTick() {
  if (!lockstep_ || !lockstep_->awaits_answer() || runner_.is_thinking()) return;
  lockstep_->Answer(controllers_ ? controllers_->TakeNumSent() : 0);
}

/// @param time   [s] that skills take for now.
/// @param stamp  [s] up to which what the robot says is complete.
void MiddleLayerNode::LookAt(double time, double stamp) {
  const auto now = inputs_.state().At(stamp);
  if (!now) return runner_.CheckFreshness(time, inputs_.Missing());
  last_look_ = Steady::now();
  const hires::robot::Observation seen = inputs_.ObservationOf(*now);
  if (driving_) {
    driving_->See(time, seen);
    if (const auto braking = driving_->WeighLoad(time, seen)) runner_.SetBraking(*braking);
  }
  runner_.Look(time, seen);
}

// Clocks ------------------------------------------------------------------------------------------

void MiddleLayerNode::Run(const std::function<bool()>& stop) {
  ros::CallbackQueue* queue = ros::getGlobalCallbackQueue();
  while (ros::ok() && !stop()) {
    queue->callAvailable(ros::WallDuration(0.02));
    Tend();
  }
  const auto end = Steady::now() + kFarewell;
  runner_.CancelAll();
  while (ros::ok() && !runner_.is_idle() && Steady::now() < end) {
    queue->callAvailable(ros::WallDuration(0.02));
    Tend();
  }
}

void MiddleLayerNode::Tend() {
  goals_.StartWaiting();
  if (driving_) driving_->Tick();
  if (!lockstep_) runner_.CheckFreshness(ros::Time::now().toSec(), inputs_.Missing());
  if (runner_.is_stopping() && Steady::now() - last_look_ > kBlindStop) runner_.GiveUpStopping();
  PublishFeedback();
}

void MiddleLayerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string missing = inputs_.Missing();
  const std::string deaf = controllers_ ? controllers_->Missing() : "";
  if (!missing.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "nothing comes on " + missing);
  } else if (!deaf.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "nobody listens to " + deaf);
  } else if (lockstep_ && !lockstep_->is_awaited()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "the robot does not wait for " + lockstep_->topic());
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "ready");
  }
  status.add("bad messages", inputs_.num_bad());
  status.add("running", hires::base::Join(runner_.Running(), "; "));
  status.add("ended", goals_.num_ended());
  status.add("lockstep", params_.lockstep);
  status.add("dry run", params_.dry_run);
  status.add("controller without a listener", deaf);
  status.add("request to the guard", driving_ ? driving_->request() : 0);
  status.add("overridden", driving_ && driving_->is_overridden());
  status.add("world hash", hires::base::HexOf(setup_.world_hash));
}

}  // namespace hires_ros
