#include "hires/ros/middle_layer_node.h"

#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/ros/conversions.h"
#include "hires/ros/middle_layer_groups.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"
#include "hires/ros/short_text.h"
#include "pr2_gripper_command.h"

namespace hires_ros {
namespace {

using hires::ExecuteActionResult;
using hires::base::ConfigError;
using hires::base::LogLevel;

constexpr auto kBlindStop = std::chrono::seconds(3);  // that a stop may go on unseen
constexpr auto kFarewell = std::chrono::seconds(5);   // that the node takes to stop the robot
constexpr double kSameStamp = 1e-9;                   // [s]

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

ExecuteActionResult ResultOf(std::uint8_t code, const std::string& reason, double duration) {
  ExecuteActionResult result;
  result.code = code;
  result.reason = Shortened(reason);
  result.duration = duration;
  return result;
}

}  // namespace

MiddleLayerNode::MiddleLayerNode(const MiddleLayerParams& params,
                                 hires::imagination::ImaginationSetup setup, ros::NodeHandle* nh)
    : params_(params),
      setup_(std::move(setup)),
      scan_obstacles_(setup_.skills->driving->costmap, PaddedFootprint(setup_.scene->robot),
                      params.scan),
      senses_({setup_.scene, &setup_.scene->robot}, setup_.scene->surroundings, scan_obstacles_,
              params.runner.stale_after),
      runner_(setup_.scene->robot, params.runner,
              {[this](const hires::robot::Command& command) { Send(command); },
               [this](const ActionNews& news, ActionEnd end, const std::string& reason) {
                 OnEnded(news, end, reason);
               },
               [this] {
                 ros::getGlobalCallbackQueue()->addCallback(
                     boost::make_shared<Call>([this] { OnWake(); }));
               }}),
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
  base_ = nh->advertise<geometry_msgs::Twist>(kBaseCommand, 10);
  for (const auto& [group, topic] : TrajectoryTopics()) {
    trajectories_[group] = nh->advertise<trajectory_msgs::JointTrajectory>(topic, 10);
  }
  for (const auto& [arm, topic] : GripperTopics()) {
    grippers_[arm] = nh->advertise<Pr2GripperCommand>(topic, 10);
  }
  if (params_.lockstep) ack_ = nh->advertise<hires::LockstepAck>(kLockstepAck, 10);
}

void MiddleLayerNode::Subscribe(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto add = [&](ros::Subscriber subscriber) { subscribers_.push_back(subscriber); };
  add(nh->subscribe<nav_msgs::Odometry>(kOdometry, 100,
                                        boost::function<void(const nav_msgs::OdometryConstPtr&)>(
                                            [this](const nav_msgs::OdometryConstPtr& msg) {
                                              senses_.OnOdometry(msg->header.stamp.toSec(),
                                                                 FromMsg(*msg));
                                              Note(kOdometry, msg->header.stamp.toSec());
                                            }),
                                        ros::VoidConstPtr(), hints));
  add(nh->subscribe<sensor_msgs::JointState>(
      kJointStates, 100,
      boost::function<void(const sensor_msgs::JointStateConstPtr&)>(
          [this](const sensor_msgs::JointStateConstPtr& msg) {
            senses_.OnJoints(msg->header.stamp.toSec(), FromMsg(*msg));
            Note(kJointStates, msg->header.stamp.toSec());
          }),
      ros::VoidConstPtr(), hints));
  add(nh->subscribe(kTransforms, 100, &MiddleLayerNode::OnTransforms, this, hints));
  add(nh->subscribe(kBaseScan, 10, &MiddleLayerNode::OnScan, this, hints));
  add(nh->subscribe(kDetections, 10, &MiddleLayerNode::OnDetections, this, hints));
  add(nh->subscribe(kKnownObjects, 10, &MiddleLayerNode::OnKnownObjects, this, hints));
  if (params_.lockstep) {
    add(nh->subscribe(kLockstepTick, 10, &MiddleLayerNode::OnTick, this, hints));
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
    goal.setRejected(ResultOf(ExecuteActionResult::INVALID, error.what(), 0.0));
    return;
  }
  waiting_.push_back({goal, Steady::now()});
  StartWaiting();
}

void MiddleLayerNode::StartWaiting() {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    const auto action = FromMsg(waiting->goal.getGoal()->action);
    const std::string why_not = WhyNotReady(GroupsOf(action));
    const std::chrono::duration<double> waited = Steady::now() - waiting->since;
    if (why_not.empty()) {
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

/// The reason why an action would fail at once; empty: nothing is missing.
std::string MiddleLayerNode::WhyNotReady(const std::set<std::string>& groups) const {
  const std::string controller = MissingController(groups);
  if (!controller.empty()) return "no_controller: " + controller;
  const bool is_fresh = senses_.Missing().empty() && !ros::Time::now().isZero() &&
                        ros::Time::now().toSec() - looked_ <= params_.runner.stale_after;
  return is_fresh || params_.lockstep ? "" : "stale_observation";
}

/// A controller that is needed and does not listen; empty: all are there. In lockstep that includes
/// a robot that would go on without an answer.
std::string MiddleLayerNode::MissingController(const std::set<std::string>& groups) const {
  if (groups.count("base") > 0 && base_.getNumSubscribers() == 0) return base_.getTopic();
  if (params_.lockstep && awaited_ != ros::this_node::getName()) return ack_.getTopic();
  for (const auto* controllers : {&trajectories_, &grippers_}) {
    for (const auto& [group, publisher] : *controllers) {
      if (groups.count(group) > 0 && publisher.getNumSubscribers() == 0) {
        return publisher.getTopic();
      }
    }
  }
  return "";
}

void MiddleLayerNode::StartGoal(GoalHandle goal) {
  const hires::base::ActionCall action = FromMsg(goal.getGoal()->action);
  const double now = std::max(looked_, ros::Time::now().toSec());
  const auto refusal =
      runner_.Start(next_id_, action, hires::skills::MakeSkill(*setup_.skills, action),
                    goal.getGoal()->time_limit.toSec(), now);
  if (refusal) {
    goal.setRejected(ResultOf(ExecuteActionResult::INVALID, *refusal, 0.0));
    return;
  }
  hires::base::Log(LogLevel::kInfo, fmt::format("action={} begins", hires::base::ToString(action)));
  goal.setAccepted();
  going_[next_id_++] = {goal, 0.0, ""};
}

void MiddleLayerNode::OnCancel(GoalHandle goal) {
  waiting_.remove_if([&](Waiting& waiting) {
    if (!(waiting.goal == goal)) return false;
    goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, "", 0.0));
    return true;
  });
  for (const auto& [id, going] : going_) {
    if (!(going.goal == goal)) continue;
    runner_.Cancel(id);
    return;  // may have ended, and is no more in the map then
  }
}

void MiddleLayerNode::OnEnded(const ActionNews& news, ActionEnd end, const std::string& reason) {
  const auto going = going_.find(news.id);
  GoalHandle goal = going->second.goal;
  going_.erase(going);
  ++num_ended_;
  hires::base::Log(
      LogLevel::kInfo,
      fmt::format("action={} ends reason=\"{}\" duration={:.2f}",
                  hires::base::ToString(FromMsg(goal.getGoal()->action)), reason, news.elapsed));
  switch (end) {
    case ActionEnd::kSucceeded:
      goal.setSucceeded(ResultOf(ExecuteActionResult::SUCCEEDED, reason, news.elapsed));
      break;
    case ActionEnd::kFailed:
      goal.setAborted(ResultOf(ExecuteActionResult::FAILED, reason, news.elapsed));
      break;
    case ActionEnd::kPreempted:
      goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, reason, news.elapsed));
      break;
  }
}

void MiddleLayerNode::PublishFeedback() {
  for (const ActionNews& news : runner_.News()) {
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

// Senses ------------------------------------------------------------------------------------------

void MiddleLayerNode::OnTransforms(const tf2_msgs::TFMessage& msg) {
  for (const geometry_msgs::TransformStamped& transform : msg.transforms) {
    if (transform.header.frame_id != kMapFrame || transform.child_frame_id != kOdometryFrame) {
      continue;
    }
    geometry_msgs::Pose pose;
    pose.position.x = transform.transform.translation.x;
    pose.position.y = transform.transform.translation.y;
    pose.orientation = transform.transform.rotation;
    senses_.OnLocalisation(transform.header.stamp.toSec(), hires::geometry::Flatten(FromMsg(pose)));
    Note(kTransforms, transform.header.stamp.toSec());
  }
}

void MiddleLayerNode::OnScan(const sensor_msgs::LaserScan& msg) {
  senses_.OnScan(msg.header.stamp.toSec(),
                 {msg.angle_min, msg.angle_increment, msg.range_min, msg.ranges});
  Note(kBaseScan, msg.header.stamp.toSec());
}

void MiddleLayerNode::OnDetections(const hires::Detections& msg) {
  std::vector<hires::perception::Detection> detections;
  for (const hires::DetectedObject& object : msg.objects) {
    detections.push_back({object.name, object.model, FromMsg(object.pose), object.visible_share});
  }
  senses_.OnDetections(msg.header.stamp.toSec(), std::move(detections));
  Note(kDetections, msg.header.stamp.toSec());
}

void MiddleLayerNode::OnKnownObjects(const hires::WorldState& msg) {
  senses_.OnKnownObjects(FromMsg(msg));
}

void MiddleLayerNode::OnTick(const hires::LockstepTick& msg) {
  awaited_ = msg.awaited;
  // A tick is repeated where the answer is late, or went before the robot listened.
  if (tick_ && tick_->header.stamp == msg.header.stamp) return;
  if (acked_ && acked_->header.stamp == msg.header.stamp) {
    ack_.publish(*acked_);
    return;
  }
  tick_ = msg;
  is_tick_looked_at_ = false;
  LookAtTick();
}

void MiddleLayerNode::Note(const std::string& topic, double stamp) {
  double& newest = arrived_[topic];
  newest = std::max(newest, stamp);
  if (params_.lockstep) {
    LookAtTick();
  } else if (topic == kOdometry || topic == kJointStates) {
    LookWhereFree();
  }
}

void MiddleLayerNode::LookWhereFree() {
  const auto complete = senses_.CompleteUntil();
  if (!complete || *complete <= looked_) return;
  looked_ = *complete;
  last_look_ = Steady::now();
  runner_.Look(looked_, senses_.Look(looked_));
}

bool MiddleLayerNode::IsTickComplete() const {
  const double stamp = tick_->header.stamp.toSec();
  const auto is_there = [&](const std::string& topic) {
    const auto arrived = arrived_.find(topic);
    return arrived != arrived_.end() && arrived->second >= stamp - kSameStamp;
  };
  for (const std::string& topic : tick_->sensors) {
    if (!is_there(topic)) return false;
  }
  return true;
}

void MiddleLayerNode::LookAtTick() {
  if (!tick_ || is_tick_looked_at_ || !IsTickComplete()) return;
  is_tick_looked_at_ = true;
  const double stamp = tick_->header.stamp.toSec();
  const auto complete = senses_.CompleteUntil();
  if (complete && *complete >= stamp - kSameStamp) {
    looked_ = stamp;
    last_look_ = Steady::now();
    runner_.Look(stamp, senses_.Look(std::min(stamp, *complete)));
  } else {
    runner_.CheckFreshness(stamp);
  }
  AnswerTick();
}

void MiddleLayerNode::AnswerTick() {
  if (!tick_ || !is_tick_looked_at_ || runner_.is_thinking()) return;
  hires::LockstepAck ack;
  ack.header.stamp = tick_->header.stamp;
  ack.num_commands = commands_since_ack_;
  commands_since_ack_ = 0;
  tick_.reset();
  acked_ = ack;
  ack_.publish(ack);
}

void MiddleLayerNode::OnWake() {
  runner_.Collect();
  PublishFeedback();
  AnswerTick();
}

void MiddleLayerNode::Send(const hires::robot::Command& command) {
  if (command.base_velocity) {
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

void MiddleLayerNode::Tend() {
  StartWaiting();
  if (!params_.lockstep) runner_.CheckFreshness(ros::Time::now().toSec());
  if (runner_.is_stopping() && Steady::now() - last_look_ > kBlindStop) runner_.GiveUpStopping();
  PublishFeedback();
}

void MiddleLayerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string missing = senses_.Missing();
  if (missing.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "ready");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "nothing comes on " + missing);
  }
  status.add("running", hires::base::Join(runner_.Running(), "; "));
  status.add("ended", num_ended_);
  status.add("lockstep", params_.lockstep);
  status.add("world hash", hires::base::HexOf(setup_.world_hash));
}

}  // namespace hires_ros
