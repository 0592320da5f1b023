#include "simulation/joint_drives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::simulation {
namespace {

constexpr double kTurn = 2.0 * geometry::kPi;
constexpr double kAtOnce = 1e-9;  // [s] a first point this early leaves no time to go there

DriveLimits LimitsOf(const robot::Robot& robot, const std::string& name) {
  const robot::Joint& joint = *robot::FindJoint(robot.model, name);
  return {joint.limits->lower, joint.limits->upper, joint.type == robot::JointType::kContinuous,
          joint.limits->velocity, robot::AccelerationOf(*robot.profile.upper_body, name)};
}

/// The largest speed of the next step from which `distance` suffices to stop without running over
/// it, each later step slower by acceleration * dt: n steps at v, v - a dt, ... take
/// n v dt - n (n - 1) / 2 a dt^2.
double StoppingSpeed(double distance, double acceleration, double dt) {
  const double D = std::abs(distance) / (acceleration * dt * dt);
  const double n = std::max(1.0, std::ceil(0.5 * (std::sqrt(1.0 + 8.0 * D) - 1.0)));
  return (D / n + 0.5 * (n - 1.0)) * acceleration * dt;
}

double Clamped(double position, const DriveLimits& limits) {
  return limits.is_continuous ? position : std::clamp(position, limits.lower, limits.upper);
}

bool AllFinite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

std::string WhyBadPoint(const robot::JointTrajectory& trajectory, std::size_t index) {
  const robot::TrajectoryPoint& point = trajectory.points[index];
  const std::size_t wanted = trajectory.joints.size();
  if (point.positions.size() != wanted) {
    return fmt::format("has {} positions, wanted one for each of {} joints", point.positions.size(),
                       wanted);
  }
  if (!point.velocities.empty() && point.velocities.size() != wanted) {
    return fmt::format("has {} velocities, wanted none or one for each of {} joints",
                       point.velocities.size(), wanted);
  }
  if (!std::isfinite(point.time) || !AllFinite(point.positions) || !AllFinite(point.velocities)) {
    return "has a time, position or velocity that is not finite";
  }
  const double earliest = index == 0 ? 0.0 : trajectory.points[index - 1].time;
  if (point.time < earliest || (index > 0 && point.time == earliest)) {
    return fmt::format("is at {} s, wanted {} {} s; times ascend from 0", point.time,
                       index == 0 ? "at least" : "later than", earliest);
  }
  return "";
}

}  // namespace

JointDrives::JointDrives(const robot::Robot& robot, const robot::JointPositions& start) {
  HIRES_CHECK(robot.profile.upper_body, "only a robot with an upper body has joint drives");
  const robot::UpperBodyProfile& profile = *robot.profile.upper_body;
  std::vector<std::string> group_names{"torso", "head"};
  for (const auto& [arm, parts] : profile.arms) group_names.push_back(arm);
  std::vector<std::string> names;
  std::vector<DriveLimits> limits;
  std::map<std::string, std::vector<int>> groups;
  for (const std::string& group : group_names) {
    for (const std::string& name : robot::JointsOfGroup(profile, group)) {
      groups[group].push_back(static_cast<int>(names.size()));
      names.push_back(name);
      limits.push_back(LimitsOf(robot, name));
    }
  }
  for (const auto& [arm, parts] : profile.arms) {
    names.push_back(parts.gripper_joint);
    limits.push_back(LimitsOf(robot, parts.gripper_joint));
    limits.back().upper = std::min(limits.back().upper, profile.gripper.max_gap);
    limits.back().max_velocity = std::min(limits.back().max_velocity, profile.gripper.max_speed);
  }
  for (const std::string& name : names) {
    HIRES_CHECK(start.count(name) == 1, "the start names every driven joint: " + name);
    joints_.push_back({start.at(name), 0.0, nullptr, 0});
  }
  names_ = std::make_shared<const std::vector<std::string>>(std::move(names));
  limits_ = std::make_shared<const std::vector<DriveLimits>>(std::move(limits));
  groups_ = std::make_shared<const std::map<std::string, std::vector<int>>>(std::move(groups));
}

int JointDrives::Find(const std::string& name) const {
  const auto found = std::find(names_->begin(), names_->end(), name);
  return found == names_->end() ? -1 : static_cast<int>(found - names_->begin());
}

void JointDrives::Check(const std::string& group, const robot::JointTrajectory& trajectory) const {
  std::vector<std::string> known;
  const auto found = groups_->find(group);
  if (found == groups_->end()) {
    for (const auto& entry : *groups_) known.push_back(entry.first);
    throw base::ConfigError("trajectory: " + base::UnknownName("group of joints", group, known));
  }
  for (const int joint : found->second) known.push_back(name(joint));
  for (const std::string& joint : trajectory.joints) {
    if (std::find(known.begin(), known.end(), joint) != known.end()) continue;
    throw base::ConfigError(
        fmt::format("trajectory of '{}': {}", group, base::UnknownName("joint", joint, known)));
  }
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const std::string why = WhyBadPoint(trajectory, i);
    if (why.empty()) continue;
    throw base::ConfigError(fmt::format("trajectory of '{}': point {} {}", group, i, why));
  }
}

std::shared_ptr<const JointDrives::Reference> JointDrives::MakeReference(
    int joint, std::size_t column, const robot::JointTrajectory& trajectory, double time) const {
  const State& now = joints_[joint];
  const DriveLimits& can = limits(joint);
  const auto& points = trajectory.points;
  auto reference = std::make_shared<Reference>();
  reference->is_smooth = std::none_of(points.begin(), points.end(),
                                      [](const auto& point) { return point.velocities.empty(); });
  const double turns =
      can.is_continuous ? std::round((now.position - points[0].positions[column]) / kTurn) : 0.0;
  if (points[0].time > kAtOnce) {
    reference->knots.push_back({time, now.position, now.velocity});
  }
  for (const robot::TrajectoryPoint& point : points) {
    const double position = Clamped(point.positions[column] + turns * kTurn, can);
    const double velocity = point.velocities.empty() ? 0.0 : point.velocities[column];
    reference->knots.push_back({time + point.time, position, velocity});
  }
  return reference;
}

void JointDrives::Send(const std::string& group, const robot::JointTrajectory& trajectory,
                       double time) {
  Check(group, trajectory);
  for (const int joint : groups_->at(group)) {
    const auto column = std::find(trajectory.joints.begin(), trajectory.joints.end(), name(joint));
    if (trajectory.points.empty() || column == trajectory.joints.end()) {
      Brake(joint);
      continue;
    }
    const std::size_t index = column - trajectory.joints.begin();
    joints_[joint].reference = MakeReference(joint, index, trajectory, time);
    joints_[joint].knot = 0;
  }
}

void JointDrives::SendTo(int joint, double position) {
  auto reference = std::make_shared<Reference>();
  reference->knots.push_back({-1.0, Clamped(position, limits(joint)), 0.0});
  joints_[joint].reference = std::move(reference);
  joints_[joint].knot = 0;
}

void JointDrives::Brake(int joint) {
  const State& now = joints_[joint];
  const double way = now.velocity * now.velocity / (2.0 * limits(joint).max_acceleration);
  SendTo(joint, now.position + std::copysign(way, now.velocity));
}

void JointDrives::Place(int joint, double position) {
  HIRES_CHECK(std::isfinite(position), "a joint's position is finite");
  Halt(joint);
  joints_[joint].position = Clamped(position, limits(joint));
}

void JointDrives::Halt(int joint) {
  joints_[joint].reference.reset();
  joints_[joint].velocity = 0.0;
}

JointDrives::Wanted JointDrives::At(const Reference& reference, std::size_t* knot, double time) {
  const std::vector<Knot>& knots = reference.knots;
  while (*knot + 1 < knots.size() && knots[*knot + 1].time <= time) ++*knot;
  const Knot& from = knots[*knot];
  if (*knot + 1 == knots.size() || time <= from.time) return {from.position, 0.0};
  const Knot& to = knots[*knot + 1];
  const double T = to.time - from.time, s = (time - from.time) / T;
  const double d = to.position - from.position;
  if (!reference.is_smooth) return {from.position + s * d, d / T};
  const double a = from.velocity * T, b = to.velocity * T;  // Hermite's cubic
  const double c2 = 3.0 * d - 2.0 * a - b, c3 = a + b - 2.0 * d;
  return {from.position + s * (a + s * (c2 + s * c3)), (a + s * (2.0 * c2 + 3.0 * s * c3)) / T};
}

void JointDrives::StepJoint(int index, double time, double dt) {
  State& joint = joints_[index];
  const DriveLimits& can = limits(index);
  const Wanted wanted = At(*joint.reference, &joint.knot, time);
  // What is still missing if it moved along with the reference for this step.
  const double lag = wanted.position - wanted.velocity * dt - joint.position;
  const double catch_up = StoppingSpeed(lag, can.max_acceleration, dt);
  double velocity = wanted.velocity + std::clamp(lag / dt, -catch_up, catch_up);
  // A straight line ends without warning: see its end coming.
  const double rest = joint.reference->knots.back().position - joint.position;
  const double stop = StoppingSpeed(rest, can.max_acceleration, dt);
  if (joint.knot + 2 >= joint.reference->knots.size() && velocity * rest > 0.0) {
    velocity = std::clamp(velocity, -stop, stop);
  }
  const double change = can.max_acceleration * dt;
  velocity = std::clamp(velocity, joint.velocity - change, joint.velocity + change);
  joint.velocity = std::clamp(velocity, -can.max_velocity, can.max_velocity);
  joint.position = Clamped(joint.position + dt * joint.velocity, can);
  const bool is_over = time >= joint.reference->knots.back().time;
  if (is_over && std::abs(joint.velocity) <= change && std::abs(rest) <= 1e-12) {
    joint.position = joint.reference->knots.back().position;
    Halt(index);
  }
}

void JointDrives::Step(double time, double dt) {
  is_moving_ = false;
  for (int i = 0; i < num_joints(); ++i) {
    if (!joints_[i].reference) continue;
    StepJoint(i, time, dt);
    is_moving_ = is_moving_ || joints_[i].velocity != 0.0;
  }
}

std::vector<std::string> MovingJoints(const robot::Robot& robot, const JointDrives& drives) {
  std::vector<std::string> names;
  for (int i = 0; i < drives.num_joints(); ++i) names.push_back(drives.name(i));
  for (const auto& [name, arm] : robot.profile.upper_body->arms) {
    names[drives.Find(arm.gripper_joint)] = arm.finger_joint;
  }
  return names;
}

}  // namespace hires::simulation
