#include "nodes/base_guard/base_guard_node.h"

#include <actionlib_msgs/GoalID.h>
#include <fmt/format.h>
#include <hires/BaseGuardState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <cmath>

#include "hires/base/log.h"
#include "hires/geometry/covariance.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "nodes/base_guard/move_base_service.h"

namespace hires_ros {
namespace {

using hires::base::LogLevel;
using hires::navigation::GuardState;
using hires::navigation::PoseSource;
using Diagnostic = diagnostic_msgs::DiagnosticStatus;

constexpr double kPeriod = 0.02;   // [s] of the guard's looks: ten within the controller's time-out
constexpr double kJumpBack = 1.0;  // [s] by which time goes back when its clock began again

const char* ToText(GuardState state) {
  switch (state) {
    case GuardState::kPassing:
      return "passing";
    case GuardState::kBraking:
      return "braking";
    case GuardState::kStanding:
      return "standing";
  }
  return "unknown";
}

std::uint8_t ToMsg(GuardState state) {
  return state == GuardState::kPassing   ? hires::BaseGuardState::PASSING
         : state == GuardState::kBraking ? hires::BaseGuardState::BRAKING
                                         : hires::BaseGuardState::STANDING;
}

hires::robot::MotionSet MotionSetOf(const hires::BaseRequest& msg) {
  return {msg.max_linear_velocity, msg.max_angular_velocity, msg.max_linear_acceleration,
          msg.max_angular_acceleration};
}

hires::geometry::Twist2 FlatTwist(const geometry_msgs::Twist& msg) {
  return {msg.linear.x, msg.linear.y, msg.angular.z};
}

/// Nothing is wrong, and what ends in good order is no trouble either.
bool IsPeaceful(const hires::base::Failure& failure) {
  using Code = hires::base::FailureCode;
  return !failure || failure.code == Code::kNoRequest || failure.code == Code::kRequestOver;
}

}  // namespace

BaseGuardNode::BaseGuardNode(const BaseGuardNodeParams& params, ros::NodeHandle* nh)
    : params_(params), guard_(params.guard), begin_(Steady::now()) {
  base_ = nh->advertise<geometry_msgs::Twist>(params.names.base_command, 1);
  state_ = nh->advertise<hires::BaseGuardState>(kGuardState, 1, true);
  if (params.uses_move_base) {
    cancel_ = nh->advertise<actionlib_msgs::GoalID>(params.names.move_base.action + "/cancel", 1);
    tuner_ = MakeMoveBaseTuner(params.names.move_base, params.journal);
  }
  Subscribe(nh);
  updater_.setHardwareID("base_guard");
  updater_.add("base_guard", this, &BaseGuardNode::Diagnose);
  PublishState();
}

void BaseGuardNode::Subscribe(ros::NodeHandle* nh) {
  const hires::control::RobotNames& names = params_.names;
  const auto hints = ros::TransportHints().tcpNoDelay();
  const auto add = [this](const ros::Subscriber& subscriber) {
    subscribers_.push_back(subscriber);
  };
  add(nh->subscribe(kGuardRequest, 10, &BaseGuardNode::OnRequest, this, hints));
  add(nh->subscribe(kGuardCommand, 1, &BaseGuardNode::OnCommand, this, hints));
  add(nh->subscribe(names.odometry, 10, &BaseGuardNode::OnOdometry, this, hints));
  const auto on_transforms = [this](bool are_static) {
    return boost::function<void(const tf2_msgs::TFMessage&)>(
        [this, are_static](const tf2_msgs::TFMessage& msg) { OnTransforms(msg, are_static); });
  };
  add(nh->subscribe<tf2_msgs::TFMessage>(kTransforms, 100, on_transforms(false)));
  add(nh->subscribe<tf2_msgs::TFMessage>(kStaticTransforms, 100, on_transforms(true)));
  if (!names.localisation.empty()) {
    add(nh->subscribe(names.localisation, 1, &BaseGuardNode::OnLocalisation, this));
  }
  if (!names.base_scan.empty()) {
    add(nh->subscribe<sensor_msgs::LaserScan>(
        names.base_scan, 1,
        boost::function<void(const sensor_msgs::LaserScan&)>(
            [this](const auto& msg) { guard_.OnScan(StampOf(msg.header.stamp), Now()); })));
  }
  if (!names.motors_halted.empty()) {
    add(nh->subscribe<std_msgs::Bool>(
        names.motors_halted, 10,
        boost::function<void(const std_msgs::Bool&)>(
            [this](const auto& msg) { guard_.OnMotorsHalted(msg.data != 0); })));
  }
  if (tuner_) {
    add(nh->subscribe(names.move_base.planner + "/parameter_updates", 1,
                      &BaseGuardNode::OnPlannerUpdate, this));
  }
}

void BaseGuardNode::OnRequest(const hires::BaseRequest& msg) {
  request_ = msg;
  guard_.OnRequest({msg.id, MotionSetOf(msg), {msg.max_braking, msg.max_braking_jerk}}, Now());
}

void BaseGuardNode::OnCommand(const geometry_msgs::Twist& msg) {
  guard_.OnCommand(FlatTwist(msg), Now());
  Update();
}

void BaseGuardNode::OnOdometry(const nav_msgs::Odometry& msg) {
  guard_.OnOdometry(VelocityOfBase(msg), StampOf(msg.header.stamp), Now());
}

/// Odometry may tell of another part of the robot, where tf knows how that sits on the base. Where
/// tf does not, it is taken for the base's: how fast it goes is right all the same, unless it
/// turns.
hires::geometry::Twist2 BaseGuardNode::VelocityOfBase(const nav_msgs::Odometry& msg) {
  const hires::geometry::Twist2 V_C = FlatTwist(msg.twist.twist);
  const std::string child = hires::sensing::BareFrame(msg.child_frame_id);
  const std::string& base = params_.names.base_frame;
  loose_frame_.clear();
  if (child.empty() || child == base) return V_C;
  if (const auto newest = tree_.NewestOf(child, base)) {
    const auto X_CB = tree_.Find(child, base, *newest);
    if (X_CB.is_found()) return hires::sensing::MovedTo(hires::geometry::Flatten(X_CB.X_PC), V_C);
  }
  TellOfLooseFrame(child);
  return V_C;
}

void BaseGuardNode::TellOfLooseFrame(const std::string& frame) {
  // Before tf told of the base, it is no wonder.
  if (newest_.count(PoseSource::kBaseTransform) == 0 &&
      static_sources_.count(PoseSource::kBaseTransform) == 0) {
    return;
  }
  loose_frame_ = frame;
  if (!told_frames_.insert(frame).second) return;
  hires::base::Log(
      LogLevel::kWarn,
      fmt::format("{}: child_frame_id is '{}', which tf does not connect with {}; its velocity is "
                  "taken for the base's. Publish that transform, or correct base_frame in ~names",
                  params_.names.odometry, frame, params_.names.base_frame));
}

void BaseGuardNode::OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  const auto& covariance = msg.pose.covariance;  // of x, y, z, roll, pitch, yaw; row by row
  guard_.OnLocalisation(hires::geometry::LargestSd(covariance[0], covariance[1], covariance[7]),
                        std::sqrt(covariance[35]));
}

void BaseGuardNode::OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
  const ros::Time now = ros::Time::now();
  if (now + ros::Duration(kJumpBack) < last_transforms_) {  // the clock began again
    tree_.ForgetMoving();
    newest_.clear();
  }
  last_transforms_ = now;
  tree_.Take(msg, are_static);
  const hires::control::RobotNames& names = params_.names;
  const auto map = tree_.NewestOf(names.map_frame, names.odometry_frame);
  const auto base = tree_.NewestOf(names.odometry_frame, names.base_frame);
  // Where tf does not know the odometry's frame, it may lead from map to base all the same.
  const bool is_apart = !map && !base;
  const auto whole = is_apart ? tree_.NewestOf(names.map_frame, names.base_frame) : std::nullopt;
  OnLink(PoseSource::kMapTransform, is_apart ? whole : map);
  OnLink(PoseSource::kBaseTransform, is_apart ? whole : base);
}

/// @param stamp  [s] of the newest that is known of the link; infinity: it never moves.
void BaseGuardNode::OnLink(PoseSource source, std::optional<double> stamp) {
  if (!stamp) return;
  if (!std::isfinite(*stamp)) {
    static_sources_.insert(source);
    return;
  }
  const auto newest = newest_.find(source);
  if (newest != newest_.end() && newest->second >= *stamp) return;
  newest_[source] = *stamp;
  guard_.OnTransform(source, StampOf(ros::Time(*stamp)), Now());
}

void BaseGuardNode::OnPlannerUpdate(const dynamic_reconfigure::Config& msg) {
  tuner_->OnUpdate(FromMsg(msg));
}

double BaseGuardNode::Now() const {
  return std::chrono::duration<double>(Steady::now() - begin_).count();
}

double BaseGuardNode::StampOf(const ros::Time& stamp) const {
  return Now() - (ros::Time::now() - stamp).toSec();
}

void BaseGuardNode::Run(const std::function<bool()>& stop) {
  auto next = Steady::now();
  while (ros::ok()) {
    const double wait = std::chrono::duration<double>(next - Steady::now()).count();
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(std::max(0.0, wait)));
    if (Steady::now() < next) continue;
    next = std::max(
        next + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(kPeriod)),
        Steady::now());
    is_ending_ = stop();
    if (is_ending_ && guard_.state() == GuardState::kStanding) return;
    Update();
    updater_.update();
  }
}

void BaseGuardNode::Update() {
  const double now = Now();
  for (const PoseSource source : static_sources_) guard_.OnTransform(source, now, now);
  guard_.OnHindrance(is_ending_ ? hires::base::FailureCode::kGuardEnds : hires::base::Failure());
  TendTuner(now);
  const GuardState before = guard_.state();
  const auto velocity = guard_.Update(now);
  if (velocity) base_.publish(ToMsg(*velocity));
  const bool has_stopped = before == GuardState::kPassing && guard_.state() != GuardState::kPassing;
  if (has_stopped) {
    ++num_stops_;
    CancelMoveBase();
  }
  PublishState();
}

/// Where move_base drives, its planner has the limits of the request first.
void BaseGuardNode::TendTuner(double now) {
  if (!tuner_) return;
  const std::uint64_t applicant = guard_.Applicant(now);
  if (applicant != 0 && applicant != tuned_for_) {
    tuner_->Apply(applicant, request_.set_name, MotionSetOf(request_));
    tuned_for_ = applicant;
  } else if (applicant == 0 && tuned_for_ != 0 && guard_.state() == GuardState::kStanding) {
    tuner_->Restore();
    tuned_for_ = 0;
  }
  const hires::control::TunerState tuner = tuner_->state();
  const bool is_ours = tuned_for_ != 0 && tuner.request == tuned_for_;
  const bool has_failed = is_ours && tuner.phase == hires::control::TunerState::Phase::kFailed;
  guard_.OnHold(!has_failed &&
                !(is_ours && tuner.phase == hires::control::TunerState::Phase::kInForce));
  if (has_failed) {
    guard_.OnHindrance({hires::base::FailureCode::kMotionSetRefused, {}, tuner.reason});
  }
}

void BaseGuardNode::CancelMoveBase() {
  if (!cancel_) return;
  // Stops all goals, of all clients: what moves the base now is to end.
  cancel_.publish(actionlib_msgs::GoalID());
}

void BaseGuardNode::PublishState() {
  const Said now{guard_.state(), guard_.request(), guard_.failure()};
  if (said_ && *said_ == now) return;
  hires::BaseGuardState msg;
  msg.header.stamp = ros::Time::now();
  msg.state = ToMsg(now.state);
  msg.request = now.request;
  msg.failure = ToMsg(now.failure);
  state_.publish(msg);
  const bool is_trouble = !IsPeaceful(now.failure);
  hires::base::Log(
      is_trouble && now.state != GuardState::kPassing ? LogLevel::kWarn : LogLevel::kInfo,
      fmt::format("base_guard={} request={} failure={} stop_time={:.2f} stop_distance={:.2f}",
                  ToText(now.state), now.request, now.failure ? ToString(now.failure) : "none",
                  guard_.stop_time(), guard_.stop_distance()));
  said_ = std::make_unique<Said>(now);
  updater_.force_update();
}

void BaseGuardNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const hires::base::Failure& failure = guard_.failure();
  status.summary(IsPeaceful(failure) ? Diagnostic::OK : Diagnostic::WARN,
                 ToText(guard_.state()) + (failure ? ": " + ToString(failure) : ""));
  if (!loose_frame_.empty()) {
    status.mergeSummary(Diagnostic::WARN, "odometry of the unknown frame " + loose_frame_);
  }
  status.add("request", guard_.request());
  const hires::base::Failure forbids = guard_.WhatForbidsDriving(Now());
  status.add("forbids driving", forbids ? ToString(forbids) : "nothing");
  status.add("stops", num_stops_);
  status.add("last stop [s]", guard_.stop_time());
  status.add("last stop [m]", guard_.stop_distance());
  status.add("subscribers of the base command", base_.getNumSubscribers());
}

}  // namespace hires_ros
