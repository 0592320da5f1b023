#include "hires/control/drive_permit.h"

#include <algorithm>

namespace hires::control {

DriveLimits LimitsFor(const skills::SkillSet& skills, const base::ActionCall& action) {
  DriveLimits limits;
  limits.set_name = skills::MotionSetNameOf(skills, action);
  limits.limits = skills.motion_sets.at(limits.set_name);
  if (skills::SpecOf(skills, action).driving == actions::Driving::kStraight) {
    limits.limits.max_linear_velocity =
        std::min(limits.limits.max_linear_velocity, skills.blind.max_velocity);
    limits.limits.max_angular_velocity =
        std::min(limits.limits.max_angular_velocity, skills.blind.max_angular_velocity);
  }
  return limits;
}

void DrivePermit::Begin(int action, const DriveLimits& limits, std::uint64_t wall) {
  action_ = action;
  last_id_ = std::max(last_id_ + 1, wall);
  request_ = {last_id_, limits};
  is_stopped_ = false;
  *granted_ = false;
  sent_.reset();
}

void DrivePermit::SetBraking(double max_braking, double max_braking_jerk) {
  request_.limits.max_braking = max_braking;
  request_.limits.max_braking_jerk = max_braking_jerk;
}

void DrivePermit::End(int action) {
  if (action_ != action) return;
  *granted_ = false;
  action_.reset();
  request_ = {};
  hooks_.send(request_);
}

void DrivePermit::Tick(double now) {
  if (!action_ || (sent_ && now >= *sent_ && now - *sent_ < period_)) return;
  sent_ = now;
  hooks_.send(request_);
}

void DrivePermit::OnAnswer(const GuardAnswer& answer) {
  if (*granted_ && answer.request == 0) {
    *granted_ = false;
    is_stopped_ = true;
    hooks_.stopped(base::FailureCode::kGuardRestarted);
    return;
  }
  const bool is_ours = action_ && answer.request == request_.id;
  *granted_ = is_ours && !is_stopped_ && answer.passes;
  if (!is_ours || is_stopped_ || answer.passes) return;
  is_stopped_ = true;
  hooks_.stopped(answer.failure);
}

}  // namespace hires::control
