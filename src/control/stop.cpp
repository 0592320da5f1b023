#include "hires/control/stop.h"

#include <algorithm>
#include <cmath>

namespace hires::control {
namespace {

using geometry::Twist2;
using robot::Observation;

constexpr double kShortestHalt = 0.1;  // [s]

double LinearSpeed(const Twist2& V) { return std::hypot(V.vx, V.vy); }

double ValueOr(const robot::JointPositions& values, const std::string& name, double other) {
  const auto found = values.find(name);
  return found == values.end() ? other : found->second;
}

/// The position within what the joint can reach.
double WithinLimits(const robot::RobotModel& model, const std::string& joint, double position) {
  for (const robot::Link& link : model.links) {
    if (!link.joint || link.joint->name != joint || !link.joint->limits) continue;
    if (link.joint->type == robot::JointType::kContinuous) return position;
    return std::clamp(position, link.joint->limits->lower, link.joint->limits->upper);
  }
  return position;
}

}  // namespace

StopParams ReadStopParams(base::ParamReader in) {
  using base::Between;
  StopParams params;
  params.linear_deceleration = in.Get("linear_deceleration", Between(0.05, 10.0));
  params.angular_deceleration = in.Get("angular_deceleration", Between(0.05, 20.0));
  params.still_speed = in.Get("still_speed", Between(0.0001, 1.0));
  params.patience = in.Get("patience", Between(0.1, 60.0));
  return params;
}

Stop::Stop(const robot::Robot& robot, std::set<std::string> groups, const StopParams& params)
    : robot_(robot), groups_(std::move(groups)), params_(params) {}

robot::Command Stop::Update(double time, const Observation& seen) {
  robot::Command command;
  if (!begin_) {
    begin_ = time;
    V_begin_ = seen.V_B;
    if (params_.braking) {
      ramp_.emplace(V_begin_, Twist2{}, params_.braking->limits, params_.braking->params);
    }
    HaltJoints(seen, &command);
  }
  const double elapsed = time - *begin_;
  if (groups_.count("base") > 0) command.base_velocity = RampAt(elapsed);
  is_over_ = elapsed > params_.patience || (elapsed > 0.0 && IsStill(seen));
  return command;
}

Twist2 Stop::RampAt(double elapsed) const {
  if (ramp_) return ramp_->VelocityAt(elapsed);
  const double needed = std::max(LinearSpeed(V_begin_) / params_.linear_deceleration,
                                 std::abs(V_begin_.wz) / params_.angular_deceleration);
  if (elapsed >= needed) return {};
  const double share = 1.0 - elapsed / needed;
  return {share * V_begin_.vx, share * V_begin_.vy, share * V_begin_.wz};
}

std::vector<std::string> Stop::JointsOf(const std::string& group) const {
  if (!robot_.profile.upper_body) return {};
  const robot::UpperBodyProfile& body = *robot_.profile.upper_body;
  if (group == "torso") return {body.torso_joint};
  if (group == "head") return {body.head_pan_joint, body.head_tilt_joint};
  const auto arm = body.arms.find(group);
  return arm == body.arms.end() ? std::vector<std::string>{} : arm->second.joints;
}

void Stop::HaltJoints(const Observation& seen, robot::Command* command) const {
  for (const std::string& group : groups_) {
    const std::vector<std::string> joints = JointsOf(group);
    const bool are_seen = std::all_of(joints.begin(), joints.end(), [&](const std::string& joint) {
      return seen.joints.count(joint) > 0;
    });
    if (!joints.empty() && are_seen) command->trajectories[group] = HaltOf(joints, seen);
  }
}

/// All joints of the group come to rest at one moment, the first at which each of them can.
robot::JointTrajectory Stop::HaltOf(const std::vector<std::string>& joints,
                                    const Observation& seen) const {
  double duration = kShortestHalt;
  for (const std::string& joint : joints) {
    const double speed = std::abs(ValueOr(seen.joint_velocities, joint, 0.0));
    duration = std::max(duration, speed / robot::AccelerationOf(*robot_.profile.upper_body, joint));
  }
  robot::TrajectoryPoint end;
  end.time = duration;
  for (const std::string& joint : joints) {
    const double way = 0.5 * duration * ValueOr(seen.joint_velocities, joint, 0.0);
    end.positions.push_back(WithinLimits(robot_.model, joint, seen.joints.at(joint) + way));
    end.velocities.push_back(0.0);
  }
  return {joints, {end}};
}

bool Stop::IsStill(const Observation& seen) const {
  if (groups_.count("base") > 0 &&
      std::max(LinearSpeed(seen.V_B), std::abs(seen.V_B.wz)) > params_.still_speed) {
    return false;
  }
  for (const std::string& group : groups_) {
    for (const std::string& joint : JointsOf(group)) {
      if (std::abs(ValueOr(seen.joint_velocities, joint, 0.0)) > params_.still_speed) return false;
    }
  }
  return true;
}

}  // namespace hires::control
