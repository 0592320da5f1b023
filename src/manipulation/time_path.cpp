#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/manipulation/arm_path.h"
#include "manipulation/path_timing.h"
#include "manipulation/smooth_path.h"

namespace hires::manipulation {
namespace {

using robot::JointTrajectory;
using robot::TrajectoryPoint;

constexpr double kMaxDeviation = 0.005;  // [rad] or [m] by which a joint may cut a corner
constexpr double kChangeOfForce = 0.05;  // relative change of acceleration that gets a point

double VelocityLimit(const robot::RobotModel& model, const std::string& joint) {
  for (const robot::Link& link : model.links) {
    if (!link.joint || link.joint->name != joint) continue;
    if (link.joint->limits && link.joint->limits->velocity > 0.0) {
      return link.joint->limits->velocity;
    }
    throw base::ConfigError(
        fmt::format("robot '{}': joint '{}' has no velocity limit, so no motion can be timed; add "
                    "<limit velocity=\"...\"> to the URDF",
                    model.name, joint));
  }
  throw base::ConfigError(fmt::format("robot '{}': {}", model.name,
                                      base::UnknownName("joint", joint, model.JointNames())));
}

double AccelerationLimit(const robot::RobotProfile& profile, const std::string& joint) {
  const robot::UpperBodyProfile body = profile.upper_body.value_or(robot::UpperBodyProfile{});
  const auto found = body.accelerations.find(joint);
  return found == body.accelerations.end() ? body.default_acceleration : found->second;
}

JointBounds BoundsOf(const robot::Robot& robot, const std::vector<std::string>& joints,
                     double speed) {
  JointBounds bounds{Eigen::VectorXd(joints.size()), Eigen::VectorXd(joints.size())};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    bounds.velocity[i] = speed * VelocityLimit(robot.model, joints[i]);
    bounds.acceleration[i] = speed * speed * AccelerationLimit(robot.profile, joints[i]);
  }
  return bounds;
}

std::vector<double> ToStd(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

TrajectoryPoint PointIn(const TimedCell& cell, double into, double time) {
  const double u = std::min(
      cell.u1, cell.u0 + std::sqrt(cell.x0) * into + 0.5 * cell.acceleration * into * into);
  const double rate = std::max(0.0, std::sqrt(cell.x0) + cell.acceleration * into);
  return {time, ToStd(cell.piece->Position(u)), ToStd(rate * cell.piece->Slope(u))};
}

/// Does what drives the joints change between these cells?
bool ForceChanges(const TimedCell& a, const TimedCell& b, const JointBounds& bounds) {
  const auto force = [&](const TimedCell& cell, double u, double x) -> Eigen::VectorXd {
    const Eigen::VectorXd q2 = cell.piece->Slope(u) * cell.acceleration + 2.0 * x * cell.piece->a2;
    return q2.cwiseQuotient(bounds.acceleration);
  };
  return (force(a, a.u1, a.x1) - force(b, b.u0, b.x0)).lpNorm<Eigen::Infinity>() > kChangeOfForce;
}

std::vector<TrajectoryPoint> Sample(const std::vector<TimedCell>& cells, const JointBounds& bounds,
                                    double period) {
  std::vector<TrajectoryPoint> points{PointIn(cells.front(), 0.0, 0.0)};
  double time = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const TimedCell& cell = cells[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(cell.duration / period)));
    for (int k = 1; k < parts; ++k) {
      const double into = cell.duration * k / parts;
      points.push_back(PointIn(cell, into, time + into));
    }
    time += cell.duration;
    const bool is_last = i + 1 == cells.size();
    if (is_last || time + cells[i + 1].duration - points.back().time > period ||
        ForceChanges(cell, cells[i + 1], bounds)) {
      points.push_back(PointIn(cell, cell.duration, time));
    }
  }
  return points;
}

/// By how much the cubic between two points breaks the bounds: the factor on time that cures it.
double StretchOf(const TrajectoryPoint& a, const TrajectoryPoint& b, const JointBounds& bounds) {
  const double h = b.time - a.time;
  double stretch = 1.0;
  for (std::size_t j = 0; j < a.positions.size(); ++j) {
    const double v0 = a.velocities[j], v1 = b.velocities[j];
    const double mean = (b.positions[j] - a.positions[j]) / h;
    const double acc0 = (6.0 * mean - 4.0 * v0 - 2.0 * v1) / h;
    const double acc1 = (-6.0 * mean + 2.0 * v0 + 4.0 * v1) / h;
    double fastest = std::max(std::abs(v0), std::abs(v1));
    if (acc0 * acc1 < 0.0) {  // the velocity has its extreme in between
      const double t = h * acc0 / (acc0 - acc1);
      fastest = std::max(fastest, std::abs(v0 + 0.5 * acc0 * t));
    }
    const double force = std::max(std::abs(acc0), std::abs(acc1));
    stretch = std::max(
        {stretch, fastest / bounds.velocity[j], std::sqrt(force / bounds.acceleration[j])});
  }
  return stretch;
}

void Stretch(const JointBounds& bounds, std::vector<TrajectoryPoint>* points) {
  double factor = 1.0;
  for (std::size_t i = 1; i < points->size(); ++i) {
    factor = std::max(factor, StretchOf((*points)[i - 1], (*points)[i], bounds));
  }
  for (TrajectoryPoint& point : *points) {
    point.time *= factor;
    for (double& velocity : point.velocities) velocity /= factor;
  }
}

}  // namespace

JointTrajectory TimePath(const robot::Robot& robot, const std::vector<std::string>& joints,
                         const std::vector<std::vector<double>>& path, double speed,
                         double period) {
  HIRES_CHECK(!path.empty() && speed > 0.0 && speed <= 1.0 && period > 0.0,
              "a path with points, a speed in (0, 1], a period > 0");
  for (const auto& point : path) {
    HIRES_CHECK(point.size() == joints.size(), "one value per joint in every point");
  }
  const JointBounds bounds = BoundsOf(robot, joints, speed);
  const std::vector<PathPiece> pieces = SmoothPath(path, kMaxDeviation);
  const std::vector<double> still(joints.size(), 0.0);
  if (pieces.empty()) return {joints, {{0.0, path.back(), still}}};
  JointTrajectory trajectory{joints, Sample(TimePieces(pieces, bounds), bounds, period)};
  Stretch(bounds, &trajectory.points);
  trajectory.points.front() = {0.0, path.front(), still};
  trajectory.points.back() = {trajectory.points.back().time, path.back(), still};
  return trajectory;
}

}  // namespace hires::manipulation
