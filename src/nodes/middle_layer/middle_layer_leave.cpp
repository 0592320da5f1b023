#include "nodes/middle_layer/middle_layer_leave.h"

#include <algorithm>

#include "hires/ros/conversions.h"

namespace hires_ros {

DriveLimits LimitsFor(const hires::skills::SkillSet& skills,
                      const hires::base::ActionCall& action) {
  DriveLimits limits;
  limits.set_name = hires::skills::MotionSetNameOf(skills, action);
  limits.limits = skills.motion_sets.at(limits.set_name);
  if (hires::skills::SpecOf(skills, action).driving == hires::actions::Driving::kStraight) {
    limits.limits.max_linear_velocity =
        std::min(limits.limits.max_linear_velocity, skills.blind.max_velocity);
    limits.limits.max_angular_velocity =
        std::min(limits.limits.max_angular_velocity, skills.blind.max_angular_velocity);
  }
  return limits;
}

void BaseLeave::Begin(int action, const DriveLimits& limits, std::uint64_t wall) {
  action_ = action;
  last_id_ = std::max(last_id_ + 1, wall);
  request_ = {};
  request_.id = last_id_;
  request_.set_name = limits.set_name;
  request_.max_linear_velocity = limits.limits.max_linear_velocity;
  request_.max_angular_velocity = limits.limits.max_angular_velocity;
  request_.max_linear_acceleration = limits.limits.max_linear_acceleration;
  request_.max_angular_acceleration = limits.limits.max_angular_acceleration;
  SetBraking(limits.max_braking, limits.max_braking_jerk);
  is_stopped_ = false;
  *granted_ = false;
  sent_.reset();
}

void BaseLeave::SetBraking(double max_braking, double max_braking_jerk) {
  request_.max_braking = max_braking;
  request_.max_braking_jerk = max_braking_jerk;
}

void BaseLeave::End(int action) {
  if (action_ != action) return;
  *granted_ = false;
  action_.reset();
  request_ = {};
  hooks_.send(request_);
}

void BaseLeave::Tick(double now) {
  if (!action_ || (sent_ && now >= *sent_ && now - *sent_ < period_)) return;
  sent_ = now;
  hooks_.send(request_);
}

void BaseLeave::OnState(const hires::BaseGuardState& state) {
  if (*granted_ && state.request == 0) {  // it knows nothing of the request that it let pass
    *granted_ = false;
    is_stopped_ = true;
    hooks_.stopped(hires::base::FailureCode::kGuardRestarted);
    return;
  }
  const bool is_ours = action_ && state.request == request_.id;
  *granted_ = is_ours && !is_stopped_ && state.state == hires::BaseGuardState::PASSING;
  if (!is_ours || is_stopped_ || state.state == hires::BaseGuardState::PASSING) return;
  is_stopped_ = true;
  hooks_.stopped(FromMsg(state.failure));
}

}  // namespace hires_ros
