#include "hires/navigation/car_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "navigation/swept_footprint.h"

namespace hires::navigation {
namespace {

constexpr double kAtEnd = 0.01;         // [m] before the end of a leg it stops
constexpr double kSearched = 1.0;       // [m] of the path in which the base is looked for
constexpr double kLongestRamp = 0.15;   // [m] in which it steers from one arc into the next
constexpr double kLookedAhead = 0.5;    // [m] beyond where it could stop
constexpr double kOutlineStep = 0.025;  // [m] between two outlines that are looked at
constexpr double kAngularStep = 0.1;    // [rad]
constexpr double kTurningLeft = 1.1;    // as fast as it may turn so much more sharply than its way

}  // namespace

double ApproachSpeed(double distance, double deceleration, double reaction_time) {
  const double lost = deceleration * reaction_time;
  return std::sqrt(lost * lost + 2.0 * deceleration * distance) - lost;
}

CarFollower::CarFollower(const CarFollowerParams& params, const Footprint& footprint,
                         double min_turning_radius)
    : params_(params), footprint_(footprint), sharpest_(1.0 / min_turning_radius) {
  HIRES_CHECK(min_turning_radius > 0.0 && params.control_period > 0.0 &&
                  params.xy_goal_tolerance > 0.0 && params.yaw_goal_tolerance > 0.0 &&
                  params.deceleration > 0.0 && params.error_distance > 0.0 &&
                  params.reaction_time >= 0.0,
              "radius, periods, tolerances and distances of a car's follower are positive");
}

void CarFollower::SetPath(std::vector<CarPose> path) {
  HIRES_CHECK(!path.empty(), "a path has a goal");
  path_ = std::move(path);
  along_.assign(1, 0.0);
  for (std::size_t i = 1; i < path_.size(); ++i) {
    const double chord = (path_[i].X_MB.position() - path_[i - 1].X_MB.position()).norm();
    along_.push_back(along_.back() + chord);
  }
  leg_ = nearest_ = 0;
  place_ = lateral_ = heading_ = 0.0;
  is_ending_ = false;
  PlanSpeeds();
}

void CarFollower::SetMotionSet(const robot::MotionSet& limits) {
  for (const double limit : {limits.max_linear_velocity, limits.max_angular_velocity,
                             limits.max_linear_acceleration, limits.max_angular_acceleration}) {
    HIRES_CHECK(std::isfinite(limit) && limit >= 0.0, "limits are finite and not negative");
  }
  limits_ = limits;
  PlanSpeeds();
}

double CarFollower::Deceleration() const {
  return std::min(params_.deceleration, limits_.linear_deceleration());
}

/// How fast it may pass each pose: on arcs so much within the limit of turning that errors can be
/// taken back on either side, and where the arc changes so slowly that steering within the limit
/// of angular acceleration takes a short way only; before these no faster than it can brake.
void CarFollower::PlanSpeeds() {
  fastest_.clear();
  for (const CarPose& pose : path_) {
    const double turning = std::abs(pose.curvature);
    fastest_.push_back(turning > 0.0
                           ? std::min(limits_.max_linear_velocity,
                                      limits_.max_angular_velocity / (kTurningLeft * turning))
                           : limits_.max_linear_velocity);
  }
  for (std::size_t next = path_.size(); next-- > 1;) {
    const std::size_t i = next - 1;
    if (path_[next].is_backward != path_[i].is_backward) continue;  // there it stops
    const double change = std::abs(path_[next].curvature - path_[i].curvature);
    if (change > 0.0) {
      const double ramp = std::sqrt(kLongestRamp * limits_.max_angular_acceleration / change);
      fastest_[i] = std::min(fastest_[i], ramp);
    }
    const double braking = 2.0 * Deceleration() * (along_[next] - along_[i]);
    fastest_[i] = std::min(fastest_[i], std::sqrt(fastest_[next] * fastest_[next] + braking));
  }
}

std::size_t CarFollower::EndOfLeg() const {
  std::size_t end = std::min(leg_ + 1, path_.size() - 1);
  while (end + 1 < path_.size() && path_[end + 1].is_backward == path_[end].is_backward) ++end;
  return end;
}

double CarFollower::Sign() const {
  return path_[std::min(leg_ + 1, path_.size() - 1)].is_backward ? -1.0 : 1.0;
}

double CarFollower::remaining() const { return std::max(0.0, along_.back() - place_); }

bool CarFollower::IsStopped(const geometry::Twist2& V_B) const {
  return std::abs(V_B.vx) <= params_.stopped_linear_velocity;
}

bool CarFollower::IsLost() const {
  return std::abs(lateral_) > params_.farthest || std::abs(heading_) > params_.farthest_turn;
}

/// The nearest pose of the leg, never one that it has passed.
void CarFollower::FindPlace(const geometry::Pose2& X_MB) {
  const auto distance = [&](std::size_t i) {
    return (path_[i].X_MB.position() - X_MB.position()).norm();
  };
  const std::size_t end = EndOfLeg();
  const double searched = along_[nearest_] + kSearched;
  for (std::size_t i = nearest_ + 1; i <= end && along_[i] <= searched; ++i) {
    if (distance(i) < distance(nearest_)) nearest_ = i;
  }
  const CarPose& pose = path_[nearest_];
  const geometry::Pose2 X_NB = pose.X_MB.Inverse() * X_MB;
  place_ = along_[nearest_] + Sign() * X_NB.x;
  lateral_ = X_NB.y;
  heading_ = geometry::WrapToPi(X_NB.yaw - MeanCurvature(place_, place_) * X_NB.x);
}

/// Of the leg between two places [m]; at one place, if they are the same.
double CarFollower::MeanCurvature(double from, double to) const {
  const std::size_t end = EndOfLeg();
  from = std::clamp(from, along_[leg_], along_[end]);
  to = std::clamp(to, from, along_[end]);
  std::size_t i = std::min(leg_ + 1, end);
  while (i < end && along_[i] < from) ++i;
  double turned = 0.0, at = from;
  for (; i < end && along_[i] < to; ++i) {
    turned += path_[i].curvature * (along_[i] - at);
    at = along_[i];
  }
  if (to - from <= 0.0) return path_[i].curvature;
  return (turned + path_[i].curvature * (to - at)) / (to - from);
}

/// [1/m] As the path ahead is curved, in the mean over the way on which it can steer from one side
/// to the other; and what brings it back to the path: lateral'' = -lateral / d^2 - 2 lateral' / d
/// along the way, critically damped.
double CarFollower::CurvatureFor(double speed) const {
  const double middle = place_ + speed * params_.reaction_time;
  const double half = limits_.max_angular_acceleration > 0.0
                          ? speed * speed * sharpest_ / limits_.max_angular_acceleration
                          : 0.0;
  const double rate = 1.0 / params_.error_distance;
  const double curvature = MeanCurvature(middle - half, middle + half) - rate * rate * lateral_ -
                           2.0 * rate * Sign() * std::sin(heading_);
  return std::clamp(curvature, -sharpest_, sharpest_);
}

/// [m/s] In the direction of the leg.
double CarFollower::SpeedFor(double speed_now) const {
  const std::size_t end = EndOfLeg();
  const double reached = place_ + std::max(0.0, speed_now) * params_.reaction_time;
  double fastest = fastest_[nearest_];
  for (std::size_t i = nearest_ + 1; i <= end && along_[i - 1] < reached; ++i) {
    fastest = std::min(fastest, fastest_[i]);
  }
  const double left = std::max(0.0, along_[end] - place_);
  fastest = std::min(
      fastest, ApproachSpeed(left, Deceleration(), params_.reaction_time + params_.control_period));
  // With the steering hard over the base turns as it speeds up.
  const double gaining =
      std::min(limits_.max_linear_acceleration, limits_.max_angular_acceleration / sharpest_);
  const double period = params_.control_period;
  return std::max(0.0, std::clamp(fastest, speed_now - limits_.linear_deceleration() * period,
                                  std::max(speed_now, speed_now + gaining * period)));
}

geometry::Twist2 CarFollower::Velocity(const geometry::Twist2& V_B) const {
  const double speed = SpeedFor(Sign() * V_B.vx);
  const double vx = Sign() * speed;
  const double change = limits_.max_angular_acceleration * params_.control_period;
  const double most = std::min(limits_.max_angular_velocity, speed * sharpest_);
  const double wz = std::clamp(CurvatureFor(speed) * vx, V_B.wz - change, V_B.wz + change);
  return {vx, 0.0, std::clamp(wz, -most, most)};
}

/// Along its arc.
geometry::Twist2 CarFollower::Braked(const geometry::Twist2& V_B) const {
  const double speed = std::abs(V_B.vx);
  const double slower =
      std::max(0.0, speed - limits_.linear_deceleration() * params_.control_period);
  const double share = speed > 0.0 ? slower / speed : 0.0;
  const double most = slower * sharpest_;
  return {share * V_B.vx, 0.0, std::clamp(share * V_B.wz, -most, most)};
}

/// On the way that it brakes on if it is driven at V_B once more, and on the path beyond.
bool CarFollower::IsFree(const Costmap& costmap, const geometry::Pose2& X_MB,
                         const geometry::Twist2& V_B) {
  SweptFootprint sweep(footprint_, kOutlineStep, kAngularStep);
  const double deceleration = limits_.linear_deceleration();
  const double stopping = deceleration > 0.0 ? std::abs(V_B.vx) / deceleration : 0.0;
  if (!sweep.IsFree(costmap, X_MB, V_B, params_.control_period + 0.5 * stopping)) return false;
  const double ahead = place_ + std::abs(V_B.vx) * stopping + kLookedAhead;
  const std::size_t end = EndOfLeg();
  for (std::size_t i = nearest_ + 1; i <= end && along_[i] <= ahead; ++i) {
    if (costmap.FootprintCost(footprint_, path_[i].X_MB) >= kLethalCost) return false;
  }
  return true;
}

DwaResult CarFollower::AtRest(const geometry::Pose2& X_MB) const {
  const geometry::Pose2 X_BGoal = X_MB.Inverse() * path_.back().X_MB;
  const bool is_there = std::hypot(X_BGoal.x, X_BGoal.y) <= params_.xy_goal_tolerance &&
                        std::abs(geometry::WrapToPi(X_BGoal.yaw)) <= params_.yaw_goal_tolerance;
  return {is_there ? DwaStatus::kGoalReached : DwaStatus::kNoValidTrajectory, {}, 0};
}

DwaResult CarFollower::Update(const Costmap* costmap, const geometry::Pose2& X_MB,
                              const geometry::Twist2& V_B) {
  HIRES_CHECK(!path_.empty(), "a path was set");
  is_blocked_ = false;
  FindPlace(X_MB);
  if (along_[EndOfLeg()] - place_ <= kAtEnd) is_ending_ = true;
  if (is_ending_ && IsStopped(V_B)) {
    if (EndOfLeg() + 1 == path_.size()) return AtRest(X_MB);
    leg_ = nearest_ = EndOfLeg();
    is_ending_ = false;
    FindPlace(X_MB);
  }
  const bool is_lost = IsLost();
  geometry::Twist2 velocity = is_ending_ || is_lost ? Braked(V_B) : Velocity(V_B);
  is_blocked_ = costmap && !IsFree(*costmap, X_MB, velocity);
  if ((is_lost || is_blocked_) && IsStopped(V_B)) return AtRest(X_MB);
  if (is_blocked_) velocity = Braked(V_B);
  return {DwaStatus::kDriving, velocity, 1};
}

}  // namespace hires::navigation
