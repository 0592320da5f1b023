#include "skills/joint_motion.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/manipulation/arm_path.h"
#include "hires/robot/posture.h"

namespace hires::skills {
namespace {

using robot::Observation;

constexpr double kMovingSpeed = 1e-3;     // [rad/s] or [m/s] slower joints stand
constexpr double kShortestBraking = 0.1;  // [s]
constexpr double kHeadPatience = 1.0;     // [s] that a head may come late

double ToleranceOf(const JointGoalParams& params, const std::string& group) {
  if (group == "torso") return params.torso_tolerance;
  return group == "head" ? params.head_tolerance : params.arm_tolerance;
}

/// How far a joint is from its goal; full turns of one that turns without end do not count.
double ErrorOf(const robot::RobotModel& model, const std::string& name, double goal,
               double position) {
  const robot::Joint* joint = robot::FindJoint(model, name);
  const bool turns = joint != nullptr && joint->type == robot::JointType::kContinuous;
  return std::abs(turns ? geometry::WrapToPi(goal - position) : goal - position);
}

/// A group's joints to rest. Empty when they rest already.
robot::JointTrajectory Braking(const robot::UpperBodyProfile& profile, const std::string& group,
                               const Observation& seen) {
  robot::JointTrajectory braking;
  braking.joints = robot::JointsOfGroup(profile, group);
  const std::vector<double> positions = JointsOf(braking.joints, seen.joints);
  const std::vector<double> velocities = JointsOf(braking.joints, seen.joint_velocities);
  double duration = 0.0;
  for (std::size_t i = 0; i < braking.joints.size(); ++i) {
    const double speed = std::abs(velocities[i]);
    if (speed < kMovingSpeed) continue;
    duration = std::max(
        {duration, kShortestBraking, speed / robot::AccelerationOf(profile, braking.joints[i])});
  }
  if (duration == 0.0) return {};
  std::vector<double> ends = positions;
  for (std::size_t i = 0; i < ends.size(); ++i) ends[i] += 0.5 * duration * velocities[i];
  braking.points = {{0.0, positions, velocities},
                    {duration, ends, std::vector<double>(ends.size(), 0.0)}};
  return braking;
}

}  // namespace

JointMotion::JointMotion(std::shared_ptr<const ManipulationContext> context,
                         GroupTrajectories trajectories, MotionEnd end)
    : context_(std::move(context)), trajectories_(std::move(trajectories)), end_(end) {
  for (const auto& [group, trajectory] : trajectories_) {
    duration_ = std::max(duration_, trajectory.duration());
  }
}

bool JointMotion::IsAtGoal(const Observation& observation) const {
  for (const auto& [group, trajectory] : trajectories_) {
    if (trajectory.points.empty()) continue;
    const double tolerance = ToleranceOf(context_->params.goal, group);
    const std::vector<double> now = JointsOf(trajectory.joints, observation.joints);
    const std::vector<double>& goal = trajectory.points.back().positions;
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (ErrorOf(context_->robot->model, trajectory.joints[i], goal[i], now[i]) > tolerance) {
        return false;
      }
    }
  }
  return true;
}

bool JointMotion::IsTorsoAlone() const {
  return trajectories_.size() == 1 && trajectories_.begin()->first == "torso";
}

void JointMotion::SendLateHead(const Observation& observation, robot::Command* command) {
  const auto head = trajectories_.find("head");
  const bool is_late = observation.time > head_due_ + kHeadPatience;
  if (head == trajectories_.end() || head->second.points.empty() || !is_late) return;
  command->trajectories["head"] =
      TrajectoryFrom(*context_, observation, head->second.joints,
                     {head->second.points.back().positions}, context_->params.speed);
  head_due_ = observation.time + command->trajectories["head"].duration();
}

Status JointMotion::Update(const Observation& observation, robot::Command* command) {
  if (begin_ < 0.0) {
    begin_ = observation.time;
    head_due_ = begin_ + duration_;
    for (const auto& [group, trajectory] : trajectories_) {
      if (!trajectory.points.empty()) command->trajectories[group] = trajectory;
    }
  }
  const JointGoalParams& params = context_->params.goal;
  const double elapsed = observation.time - begin_;
  const bool is_there = IsAtGoal(observation);
  if (!is_there) {
    at_goal_since_ = -1.0;
  } else if (at_goal_since_ < 0.0) {
    at_goal_since_ = observation.time;
  }
  // Most motions are only over when their trajectory is; the torso's goal is its tolerance, as that
  // of the PR2's own controller.
  const bool is_due = elapsed >= duration_ || end_ == MotionEnd::kPassing || IsTorsoAlone();
  if (!is_there) SendLateHead(observation, command);
  const double settling = end_ == MotionEnd::kSettled ? params.settling_time : 0.0;
  if (is_there && is_due && observation.time - at_goal_since_ >= settling) {
    return Succeeded();
  }
  if (elapsed > params.time_limit_factor * duration_ + params.time_limit_surplus) {
    return Failed(base::FailureCode::kTimedOut);
  }
  return {};
}

robot::JointTrajectory TrajectoryFrom(const ManipulationContext& context,
                                      const Observation& observation,
                                      const std::vector<std::string>& joints,
                                      std::vector<std::vector<double>> path, double speed) {
  const robot::JointPositions now = PostureOf(*context.robot, observation.joints);
  if (path.size() < 2) path.insert(path.begin(), path.front());
  path.front() = NearestTurn(context.robot->model, joints, JointsOf(joints, now), path.front());
  return manipulation::TimePath(*context.robot, joints, path, speed);
}

std::unique_ptr<Activity> GripperMotion::Open(std::shared_ptr<const ManipulationContext> context,
                                              const std::string& arm) {
  const double gap = context->upper_body().gripper.max_gap;
  return std::make_unique<GripperMotion>(std::move(context), arm, robot::GripperCommand{gap, -1.0},
                                         true);
}

std::unique_ptr<Activity> GripperMotion::Close(std::shared_ptr<const ManipulationContext> context,
                                               const std::string& arm) {
  const double force = context->upper_body().gripper.force;
  return std::make_unique<GripperMotion>(std::move(context), arm, robot::GripperCommand{0.0, force},
                                         false);
}

GripperMotion::GripperMotion(std::shared_ptr<const ManipulationContext> context, std::string arm,
                             robot::GripperCommand wanted, bool opens)
    : context_(std::move(context)), arm_(std::move(arm)), wanted_(wanted), opens_(opens) {}

bool GripperMotion::IsOver(double gap, double time) {
  const GripperParams& params = context_->params.gripper;
  if (std::abs(gap - resting_gap_) > params.rest_motion) {
    resting_gap_ = gap;
    resting_since_ = time;
    has_moved_ = true;
  }
  if (opens_) return gap >= wanted_.gap - params.gap_tolerance;
  if (gap <= wanted_.gap + params.rest_motion) return true;
  // Fingers that have not moved yet may still have to hear of it.
  const double patience = has_moved_ ? params.rest_time : 5.0 * params.rest_time;
  return time - resting_since_ >= patience;
}

Status GripperMotion::Update(const Observation& observation, robot::Command* command) {
  const double gap = GapNow(context_->arm(arm_), observation);
  if (begin_ < 0.0) {
    begin_ = resting_since_ = observation.time;
    resting_gap_ = gap;
    command->grippers[arm_] = wanted_;
  }
  if (IsOver(gap, observation.time)) return Succeeded();
  const bool is_late = observation.time - begin_ > context_->params.gripper.time_limit;
  return is_late ? Failed(base::FailureCode::kTimedOut) : Status{};
}

Status WaitUntil::Update(const Observation& observation, robot::Command* /*command*/) {
  if (begin_ < 0.0) begin_ = observation.time;
  if (condition_(observation)) return Succeeded();
  return observation.time - begin_ > time_limit_ ? Failed(failure_) : Status{};
}

double GapNow(const robot::ArmProfile& arm, const Observation& observation) {
  return JointsOf({arm.gripper_joint}, observation.joints).front();
}

robot::Command Halt(const robot::Robot& robot, const Observation& observation) {
  robot::Command halt;
  halt.base_velocity = geometry::Twist2{};
  if (!robot.profile.upper_body) return halt;
  const robot::UpperBodyProfile& profile = *robot.profile.upper_body;
  std::vector<std::string> groups{"torso", "head"};
  for (const auto& [name, arm] : profile.arms) groups.push_back(name);
  for (const std::string& group : groups) {
    robot::JointTrajectory braking = Braking(profile, group, observation);
    if (!braking.points.empty()) halt.trajectories[group] = std::move(braking);
  }
  return halt;
}

}  // namespace hires::skills
