#include "nodes/middle_layer/middle_layer_node.h"

#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/ros/conversions.h"
#include "hires/ros/pr2_gripper_command.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"

namespace hires_ros {
namespace {

using hires::ExecuteActionResult;
using Code = hires::base::FailureCode;
using hires::base::ConfigError;
using hires::base::Failure;
using hires::base::LogLevel;

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

hires::geometry::Polygon PaddedFootprint(const hires::robot::Robot& robot) {
  return hires::geometry::Padded(robot.profile.footprint, robot.profile.footprint_padding);
}

ExecuteActionResult ResultOf(std::uint8_t code, const Failure& failure, double duration) {
  ExecuteActionResult result;
  result.code = code;
  result.failure = ToMsg(failure);
  result.failure.detail = hires::base::Shortened(failure.detail);
  result.duration = duration;
  return result;
}

}  // namespace

MiddleLayerNode::MiddleLayerNode(const MiddleLayerParams& params,
                                 hires::imagination::ImaginationSetup setup, ros::NodeHandle* nh)
    : params_(params),
      setup_(std::move(setup)),
      sensors_({setup_.scene, &setup_.scene->robot}, setup_.scene->surroundings, params.names,
               setup_.sensing),
      observations_(&sensors_.state(), {setup_.skills->driving->costmap,
                                        PaddedFootprint(setup_.scene->robot), params.scan}),
      runner_(setup_.scene->robot, params.runner,
              {[this](const hires::robot::Command& command) { Send(command); },
               [this](const hires::control::ActionNews& news, hires::control::ActionEnd end,
                      const Failure& failure) { OnEnded(news, end, failure); },
               [this] {
                 ros::getGlobalCallbackQueue()->addCallback(
                     boost::make_shared<Call>([this] { OnWake(); }));
               },
               [this](const hires::control::ActionNews& news) {
                 if (news.has_base && move_base_) move_base_->Shut();
               }}),
      leave_(params.guard.request_period,
             {[this](hires::BaseRequest request) {
                if (!request_) return;
                request.header.stamp = ros::Time::now();
                request_.publish(request);
              },
              [this](const Failure& failure) { OnGuardStopped(failure); }}),
      override_(params.override),
      last_look_(Steady::now()),
      server_(
          *nh, kExecuteAction, [this](GoalHandle goal) { OnGoal(goal); },
          [this](GoalHandle goal) { OnCancel(goal); }, false) {
  Advertise(nh);
  Subscribe(nh);
  updater_.setHardwareID(setup_.scene->robot.model.name);
  updater_.add("actions", this, &MiddleLayerNode::Diagnose);
  heartbeat_ = nh->createWallTimer(ros::WallDuration(1.0),
                                   boost::function<void(const ros::WallTimerEvent&)>(
                                       [this](const ros::WallTimerEvent&) { updater_.update(); }));
  server_.start();
}

void MiddleLayerNode::Advertise(ros::NodeHandle* nh) {
  if (params_.lockstep) ack_ = nh->advertise<hires::LockstepAck>(kLockstepAck, 10);
  if (params_.dry_run) return;
  if (params_.guard.is_there) request_ = nh->advertise<hires::BaseRequest>(kGuardRequest, 10);
  base_ = nh->advertise<geometry_msgs::Twist>(
      params_.guard.is_there ? kGuardCommand : params_.names.base_command, 10);
  for (const auto& [group, topic] : params_.names.trajectories) {
    trajectories_[group] = nh->advertise<trajectory_msgs::JointTrajectory>(topic, 10);
  }
  for (const auto& [arm, topic] : params_.names.grippers) {
    grippers_[arm] = nh->advertise<Pr2GripperCommand>(topic, 10);
  }
  if (params_.navigation.is_used) {
    move_base_ = std::make_shared<MoveBaseLink>(
        params_.names.move_base.action, params_.names.map_frame, params_.names.map_to_world);
  }
}

// Goals -------------------------------------------------------------------------------------------

void MiddleLayerNode::OnGoal(GoalHandle goal) {
  try {
    hires::skills::MakeSkill(*setup_.skills, FromMsg(goal.getGoal()->action));
    if (goal.getGoal()->time_limit.toSec() < 0.0) {
      throw ConfigError(fmt::format("time_limit is {:g} s, wanted 0 (the node's own) or more",
                                    goal.getGoal()->time_limit.toSec()));
    }
  } catch (const ConfigError& error) {
    goal.setRejected(
        ResultOf(ExecuteActionResult::INVALID, {Code::kInvalidAction, {}, error.what()}, 0.0));
    return;
  }
  if (params_.dry_run) {
    goal.setRejected(ResultOf(ExecuteActionResult::FAILED, Code::kDryRun, 0.0));
    return;
  }
  waiting_.push_back({goal, Steady::now()});
  StartWaiting();
}

void MiddleLayerNode::StartWaiting() {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    const auto action = FromMsg(waiting->goal.getGoal()->action);
    const Failure why_not = WhyNotReady(GroupsOf(action));
    const std::chrono::duration<double> waited = Steady::now() - waiting->since;
    if (!why_not) {
      StartGoal(waiting->goal);
    } else if (waited.count() > params_.start_patience) {
      waiting->goal.setRejected(ResultOf(ExecuteActionResult::FAILED, why_not, 0.0));
    } else {
      ++waiting;
      continue;
    }
    waiting = waiting_.erase(waiting);
  }
}

/// Why an action would fail at once; nothing is missing else.
Failure MiddleLayerNode::WhyNotReady(const std::set<std::string>& groups) const {
  if (are_motors_halted_) return Code::kMotorsHalted;
  const std::string controller = MissingController(groups);
  if (!controller.empty()) return {Code::kNoController, {}, controller};
  const bool is_fresh = sensors_.state().CompleteUntil() && !ros::Time::now().isZero() &&
                        ros::Time::now().toSec() - looked_ <= params_.runner.stale_after;
  return is_fresh || params_.lockstep ? Failure() : Code::kStaleObservation;
}

/// A controller that is needed and does not listen; empty: all are there. In lockstep that includes
/// a robot that would go on without an answer.
std::string MiddleLayerNode::MissingController(const std::set<std::string>& groups) const {
  if (groups.count("base") > 0 && base_.getNumSubscribers() == 0) return base_.getTopic();
  if (params_.lockstep && awaited_ != ros::this_node::getName()) return ack_.getTopic();
  for (const std::string& group : groups) {
    if (group == "base") continue;
    const bool is_arm = group != "torso" && group != "head";
    const auto trajectory = trajectories_.find(group), gripper = grippers_.find(group);
    if (trajectory == trajectories_.end() || (is_arm && gripper == grippers_.end())) {
      return "the robot's names tell none for " + group;
    }
    if (trajectory->second.getNumSubscribers() == 0) return trajectory->second.getTopic();
    if (is_arm && gripper->second.getNumSubscribers() == 0) return gripper->second.getTopic();
  }
  return "";
}

/// @pre the action was accepted.
std::set<std::string> MiddleLayerNode::GroupsOf(const hires::base::ActionCall& action) const {
  return hires::actions::GroupsOf(hires::skills::SpecOf(*setup_.skills, action), action);
}

std::unique_ptr<hires::skills::Skill> MiddleLayerNode::MakeSkill(
    const hires::base::ActionCall& action) const {
  if (!move_base_ || !hires::control::IsForMoveBase(*setup_.skills, action)) {
    return hires::skills::MakeSkill(*setup_.skills, action);
  }
  return hires::control::MakeMoveBaseDrive(
      *setup_.skills, action, move_base_, [granted = leave_.granted()] { return granted->load(); },
      params_.navigation);
}

void MiddleLayerNode::StartGoal(GoalHandle goal) {
  const hires::base::ActionCall action = FromMsg(goal.getGoal()->action);
  const double now = std::max(looked_, ros::Time::now().toSec());
  const Failure refusal = runner_.Start(next_id_, action, GroupsOf(action), MakeSkill(action),
                                        goal.getGoal()->time_limit.toSec(), now);
  if (refusal) {
    goal.setRejected(ResultOf(ExecuteActionResult::INVALID, refusal, 0.0));
    return;
  }
  hires::base::Log(LogLevel::kInfo, fmt::format("action={} begins", hires::base::ToString(action)));
  goal.setAccepted();
  const int id = next_id_++;
  going_[id] = {goal, 0.0, ""};
  if (GroupsOf(action).count("base") == 0) return;
  override_.Forget();
  if (move_base_) move_base_->Open();
  DriveLimits limits = LimitsFor(*setup_.skills, action);
  limits.max_braking = braking_.max_deceleration;
  limits.max_braking_jerk = braking_.max_jerk;
  leave_.Begin(id, limits, ros::WallTime::now().toNSec());
  AskForLeave();
}

void MiddleLayerNode::OnCancel(GoalHandle goal) {
  waiting_.remove_if([&](Waiting& waiting) {
    if (!(waiting.goal == goal)) return false;
    goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, {}, 0.0));
    return true;
  });
  for (const auto& [id, going] : going_) {
    if (!(going.goal == goal)) continue;
    runner_.Cancel(id);
    return;  // may have ended, and is no more in the map then
  }
}

void MiddleLayerNode::OnEnded(const hires::control::ActionNews& news, hires::control::ActionEnd end,
                              const Failure& failure) {
  const auto going = going_.find(news.id);
  GoalHandle goal = going->second.goal;
  leave_.End(news.id);
  if (news.has_base && move_base_) move_base_->Shut();
  going_.erase(going);
  ++num_ended_;
  hires::base::Log(LogLevel::kInfo,
                   fmt::format("action={} ends failure=\"{}\" duration={:.2f}",
                               hires::base::ToString(FromMsg(goal.getGoal()->action)),
                               ToString(failure), news.elapsed));
  switch (end) {
    case hires::control::ActionEnd::kSucceeded:
      goal.setSucceeded(ResultOf(ExecuteActionResult::SUCCEEDED, failure, news.elapsed));
      break;
    case hires::control::ActionEnd::kFailed:
      goal.setAborted(ResultOf(ExecuteActionResult::FAILED, failure, news.elapsed));
      break;
    case hires::control::ActionEnd::kPreempted:
      goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, failure, news.elapsed));
      break;
  }
}

void MiddleLayerNode::PublishFeedback() {
  for (hires::control::ActionNews news : runner_.News()) {
    if (news.has_base && override_.is_overridden()) news.phase = "overridden";
    Going& going = going_.at(news.id);
    if (news.elapsed < going.next_feedback && news.phase == going.phase) continue;
    going.next_feedback = news.elapsed + params_.feedback_period;
    going.phase = news.phase;
    hires::ExecuteActionFeedback feedback;
    feedback.elapsed = news.elapsed;
    feedback.phase = news.phase;
    going.goal.publishFeedback(feedback);
  }
}

// Commands ----------------------------------------------------------------------------------------

/// @pre not in a dry run: no action runs then.
void MiddleLayerNode::Send(const hires::robot::Command& command) {
  if (command.base_velocity) {
    override_.Command(*command.base_velocity);
    base_.publish(ToMsg(*command.base_velocity));
    ++commands_since_ack_;
  }
  for (const auto& [group, trajectory] : command.trajectories) {
    trajectories_.at(group).publish(ToMsg(trajectory));
    ++commands_since_ack_;
  }
  for (const auto& [arm, gripper] : command.grippers) {
    grippers_.at(arm).publish(Pr2GripperCommand{gripper.gap, gripper.max_effort});
    ++commands_since_ack_;
  }
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

void MiddleLayerNode::AskForLeave() {
  if (!params_.guard.is_there || !leave_.is_asking()) return;
  // Nothing that drives would be heard any more.
  if (base_.getNumSubscribers() == 0) {
    return runner_.FailAll({Code::kNoController, {}, base_.getTopic()});
  }
  leave_.Tick(std::chrono::duration<double>(Steady::now().time_since_epoch()).count());
}

void MiddleLayerNode::Tend() {
  StartWaiting();
  AskForLeave();
  if (!params_.lockstep) runner_.CheckFreshness(ros::Time::now().toSec());
  if (runner_.is_stopping() && Steady::now() - last_look_ > kBlindStop) runner_.GiveUpStopping();
  PublishFeedback();
}

void MiddleLayerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string missing = sensors_.NameOf(sensors_.state().MissingNow());
  if (missing.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "ready");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "nothing comes on " + missing);
  }
  status.add("bad messages", sensors_.num_bad());
  status.add("running", hires::base::Join(runner_.Running(), "; "));
  status.add("ended", num_ended_);
  status.add("lockstep", params_.lockstep);
  status.add("dry run", params_.dry_run);
  status.add("request to the guard", leave_.id());
  status.add("overridden", override_.is_overridden());
  status.add("world hash", hires::base::HexOf(setup_.world_hash));
}

}  // namespace hires_ros
