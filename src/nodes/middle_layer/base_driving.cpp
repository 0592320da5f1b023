#include "nodes/middle_layer/base_driving.h"

#include <fmt/format.h>
#include <hires/BaseRequest.h>
#include <ros/ros.h>

#include <chrono>

#include "hires/base/log.h"
#include "hires/control/tray_load.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/values/failure_messages.h"

namespace hires_ros {
namespace {

using hires::base::Failure;
using hires::control::DriveLimits;
using hires::navigation::BrakingLimits;

constexpr double kWeighingPeriod = 0.5;  // [s] between two looks at the load

hires::BaseRequest ToMsg(const hires::control::DriveRequest& request) {
  hires::BaseRequest msg;
  msg.header.stamp = ros::Time::now();
  msg.id = request.id;
  const DriveLimits& drive = request.limits;
  msg.set_name = drive.set_name;
  msg.max_linear_velocity = drive.limits.max_linear_velocity;
  msg.max_angular_velocity = drive.limits.max_angular_velocity;
  msg.max_linear_acceleration = drive.limits.max_linear_acceleration;
  msg.max_angular_acceleration = drive.limits.max_angular_acceleration;
  msg.max_braking = drive.max_braking;
  msg.max_braking_jerk = drive.max_braking_jerk;
  return msg;
}

double SteadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

BaseDriving::BaseDriving(const MiddleLayerParams& params,
                         const hires::imagination::ImaginationSetup& setup,
                         const RobotControllers* controllers,
                         std::function<void(const Failure&)> fail, ros::NodeHandle* nh)
    : guard_(params.guard),
      navigation_(params.navigation),
      setup_(setup),
      controllers_(controllers),
      fail_(std::move(fail)),
      permit_(params.guard.request_period,
              {[this](const hires::control::DriveRequest& request) { Send(request); },
               [this](const Failure& failure) { OnGuardStopped(failure); }}),
      override_(params.override) {
  if (guard_.is_there) {
    request_ = nh->advertise<hires::BaseRequest>(kGuardRequest, 10);
    guard_state_ = nh->subscribe(kGuardState, 10, &BaseDriving::OnGuardState, this,
                                 ros::TransportHints().tcpNoDelay());
  }
  if (navigation_.is_used) {
    move_base_ = std::make_shared<MoveBaseLink>(params.names.move_base.action,
                                                params.names.map_frame, params.names.map_to_world);
  }
}

std::unique_ptr<hires::skills::Skill> BaseDriving::MakeSkill(
    const hires::base::ActionCall& action) const {
  if (!move_base_ || !hires::control::IsForMoveBase(*setup_.skills, action)) {
    return hires::skills::MakeSkill(*setup_.skills, action);
  }
  return hires::control::MakeMoveBaseDrive(
      *setup_.skills, action, move_base_, [granted = permit_.granted()] { return granted->load(); },
      navigation_);
}

void BaseDriving::Begin(int id, const hires::base::ActionCall& action) {
  override_.Forget();
  if (move_base_) move_base_->Open();
  DriveLimits limits = hires::control::LimitsFor(*setup_.skills, action);
  limits.max_braking = braking_.max_deceleration;
  limits.max_braking_jerk = braking_.max_jerk;
  permit_.Begin(id, limits, ros::WallTime::now().toNSec());
  Tick();
}

void BaseDriving::BreakOff() {
  if (move_base_) move_base_->Shut();
}

void BaseDriving::End(int id) {
  permit_.End(id);
  BreakOff();
}

void BaseDriving::Tick() {
  if (!guard_.is_there || !permit_.is_asking()) return;
  // Without a subscriber no velocity reaches the base.
  if (!controllers_->is_base_there()) {
    return fail_({hires::base::FailureCode::kNoController, {}, controllers_->base_topic()});
  }
  permit_.Tick(SteadySeconds());
}

void BaseDriving::See(double time, const hires::robot::Observation& seen) {
  override_.See(time, seen.V_B);
}

std::optional<hires::control::LoadBraking> BaseDriving::WeighLoad(
    double time, const hires::robot::Observation& seen) {
  const bool is_recent = time >= weighed_ && time < weighed_ + kWeighingPeriod;
  if (!guard_.is_there || is_recent) return std::nullopt;
  weighed_ = time;
  const auto braking = hires::control::BrakingFor(setup_.scene->robot, setup_.scene->world, seen,
                                                  setup_.scene->has_camera(), guard_.braking);
  braking_ = braking.value_or(BrakingLimits{0.0, 0.0});
  permit_.SetBraking(braking_.max_deceleration, braking_.max_jerk);
  return hires::control::LoadBraking{braking.value_or(guard_.braking.unknown_load), guard_.braking};
}

void BaseDriving::Send(const hires::control::DriveRequest& request) {
  if (request_) request_.publish(ToMsg(request));
}

void BaseDriving::OnGuardState(const hires::BaseGuardState& state) {
  permit_.OnAnswer(
      {state.request, state.state == hires::BaseGuardState::PASSING, FromMsg(state.failure)});
}

void BaseDriving::OnGuardStopped(const Failure& failure) {
  hires::base::Log(hires::base::LogLevel::kWarn, fmt::format("request={} stopped by the guard: {}",
                                                             permit_.id(), ToString(failure)));
  fail_(failure);
}

}  // namespace hires_ros
