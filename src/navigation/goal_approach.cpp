#include "navigation/goal_approach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/navigation/car_follower.h"
#include "navigation/velocity_window.h"

namespace hires::navigation {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using geometry::Twist2;

constexpr double kNear = 3.0;              // times the goal's tolerance
constexpr double kPatience = 2.0;          // [s]
constexpr double kCloser = 0.05;           // [m] what counts as progress, within that time
constexpr double kShare = 0.5;             // ... or of what a slow motion set can do in it
constexpr double kTurnWeight = 0.1;        // [m/rad] of turns towards the goal
constexpr double kReached = 0.01;          // [m] before the place, or beyond it
constexpr double kAimed = 0.03;            // [rad]
constexpr double kSpeed = 0.3;             // [m/s] at most
constexpr double kDeceleration = 0.5;      // [m/s^2] at most ...
constexpr double kTurnDeceleration = 1.0;  // [rad/s^2]
constexpr double kBrakingShare = 0.5;      // of the motion set's, so that what lags keeps up
constexpr double kBackOnLine = 0.5;        // [m] of way to come back onto a line, ...
constexpr double kMostTowards = 0.15;      // [rad] ... headed towards it by that at most
constexpr double kReaction = 0.2;          // [s] from what is seen to what the wheels do of it

}  // namespace

ProgressWatch::ProgressWatch(const DwaParams& params, double patience)
    : period_(params.control_period), patience_(patience), closer_(kCloser) {
  Reset();
}

void ProgressWatch::Reset() {
  least_ = std::numeric_limits<double>::infinity();
  since_ = 0.0;
}

void ProgressWatch::SetMotionSet(const robot::MotionSet& limits) {
  const double slowest =
      std::min(limits.max_linear_velocity, kTurnWeight * limits.max_angular_velocity);
  closer_ = std::min(kCloser, kShare * patience_ * slowest);
}

bool ProgressWatch::Stalls(double left) {
  since_ += period_;
  if (left < least_ - closer_) {
    least_ = left;
    since_ = 0.0;
  }
  return since_ > patience_;
}

double LeftTo(const Pose2& X_MB, const Vector2d& p_M) {
  const Vector2d p_B = X_MB.Inverse() * p_M;
  return p_B.norm() + kTurnWeight * std::abs(std::atan2(p_B.y(), p_B.x()));
}

double NearGoal(const DwaParams& params) { return kNear * params.xy_goal_tolerance; }

GoalWatch::GoalWatch(const DwaParams& params)
    : near_(NearGoal(params)), watch_(params, kPatience) {}

bool GoalWatch::Swings(const Pose2& X_MB, const Vector2d& p_MGoal) {
  if ((X_MB.Inverse() * p_MGoal).norm() > near_) {
    Reset();
    return false;
  }
  return watch_.Stalls(LeftTo(X_MB, p_MGoal));
}

double SpeedOfTurn(double angle, const robot::MotionSet& limits) {
  const double deceleration =
      std::min(kTurnDeceleration, kBrakingShare * AngularRamp(limits));
  const double speed = std::min(ApproachSpeed(std::abs(angle), deceleration, kReaction),
                                limits.max_angular_velocity);
  return std::copysign(speed, angle);
}

double TurnBegun(double angle, int sign) {
  const double turn = geometry::WrapToPi(angle);
  const bool is_other_way = std::abs(turn) > 0.5 * geometry::kPi && turn * sign < 0.0;
  return is_other_way ? turn + sign * 2.0 * geometry::kPi : turn;
}

std::optional<double> FreeTurn(const Costmap& costmap, const Pose2& X_MB, double yaw, int sign,
                               SweptFootprint* sweep) {
  const double shorter = geometry::WrapToPi(yaw - X_MB.yaw);
  const double longer = shorter - std::copysign(2.0 * geometry::kPi, shorter);
  const double first = TurnBegun(shorter, sign);
  for (const double angle : {first, first == shorter ? longer : shorter}) {
    if (sweep->IsFree(costmap, X_MB, {0.0, 0.0, std::copysign(1.0, angle)}, std::abs(angle))) {
      return angle;
    }
  }
  return std::nullopt;
}

GoalApproach::GoalApproach(const DwaParams& params) : params_(params) {}

void GoalApproach::BeginTo(const Pose2& X_MGoal) {
  X_MGoal_ = X_MGoal;
  missing_M_.reset();
  pieces_.clear();
  has_pieces_ = false;
  commanded_ = {};
  stage_ = Stage::kStopping;
}

void GoalApproach::BeginFrom(const Pose2& X_MB, const Pose2& X_MGoal) {
  BeginTo(X_MGoal);
  missing_M_ = X_MGoal.position() - X_MB.position();
}

void GoalApproach::BeginAlong(std::vector<Piece> pieces) {
  std::reverse(pieces.begin(), pieces.end());
  pieces_ = std::move(pieces);
  has_pieces_ = true;
  missing_M_.reset();
  commanded_ = {};
  stage_ = Stage::kStopping;
}

Vector2d GoalApproach::Place(const Pose2& X_MB) const {
  if (has_pieces_) return p_MTo_;
  return missing_M_ ? Vector2d(X_MB.position() + *missing_M_) : X_MGoal_.position();
}

/// False if something is in the way. Of pieces that was looked at when they were found.
bool GoalApproach::Choose(const Costmap& costmap, const Pose2& X_MB, SweptFootprint* sweep) {
  if (!has_pieces_) return ChooseOwn(costmap, X_MB, sweep);
  yaw_ = pieces_.back().yaw;
  sign_ = pieces_.back().sign;
  p_MTo_ = pieces_.back().p_MTo;
  pieces_.pop_back();
  return true;
}

/// How it goes there: of front and back what takes less turning, before and after. False if
/// something is in the way, or it could not turn there.
bool GoalApproach::ChooseOwn(const Costmap& costmap, const Pose2& X_MB, SweptFootprint* sweep) {
  p_MTo_ = Place(X_MB);
  const Vector2d way_M = p_MTo_ - X_MB.position();
  if (CanMoveSideways()) {
    const Vector2d way_B = X_MB.Inverse() * p_MTo_;
    yaw_ = X_MB.yaw;
    sign_ = 0;
    return sweep->IsFree(costmap, X_MB, {way_B.x(), way_B.y(), 0.0}, 1.0);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double side : {0.0, geometry::kPi}) {
    const double yaw = geometry::WrapToPi(std::atan2(way_M.y(), way_M.x()) + side);
    const auto turn = FreeTurn(costmap, X_MB, yaw, 0, sweep);
    if (!turn) continue;
    const double ahead = side == 0.0 ? way_M.norm() : -way_M.norm();
    if (!sweep->IsFree(costmap, {X_MB.x, X_MB.y, yaw}, {ahead, 0.0, 0.0}, 1.0)) continue;
    const auto last = FreeTurn(costmap, {p_MTo_.x(), p_MTo_.y(), yaw}, X_MGoal_.yaw, 0, sweep);
    if (!last || std::abs(*turn) + std::abs(*last) >= least) continue;
    least = std::abs(*turn) + std::abs(*last);
    yaw_ = yaw;
    sign_ = *turn < 0.0 ? -1 : 1;
  }
  return std::isfinite(least);
}

double GoalApproach::TurnLeft(double yaw) const { return TurnBegun(yaw_ - yaw, sign_); }

Twist2 GoalApproach::Turn(const Pose2& X_MB, const Twist2& V_B) const {
  Twist2 velocity = Braked(V_B, limits_, params_.control_period);
  velocity.wz = Ramped(commanded_.wz, V_B.wz, SpeedOfTurn(TurnLeft(X_MB.yaw), limits_),
                       limits_.max_angular_acceleration * params_.control_period);
  return velocity;
}

/// [rad] Back onto its line, where that is longer than a few steps: as a base turned, its believed
/// place moved by some cm.
double GoalApproach::HeadingTowards(const Vector2d& p_MB, double left) const {
  if (!has_pieces_ || CanMoveSideways()) return yaw_;
  const Vector2d to_left(-std::sin(yaw_), std::cos(yaw_));
  const double beside = to_left.dot(p_MTo_ - p_MB);
  const double turned = std::clamp(beside / kBackOnLine, -kMostTowards, kMostTowards);
  return yaw_ + (left < 0.0 ? -turned : turned);
}

/// [m/s] It creeps to its goal; pieces are driven as fast as a base may go sideways.
double GoalApproach::MostTowards(const Vector2d& way_B) const {
  if (!CanMoveSideways()) return kSpeed;
  const double sideways = params_.max_lateral_velocity;
  if (!has_pieces_) return std::min(kSpeed, sideways);
  return std::min(kSpeed, sideways * way_B.norm() / std::max(std::abs(way_B.y()), 1e-9));
}

/// None: it is there.
std::optional<Twist2> GoalApproach::Drive(const Pose2& X_MB, const Twist2& V_B) const {
  const Vector2d way_B = X_MB.Inverse() * p_MTo_;
  Vector2d wanted = way_B;
  if (!CanMoveSideways()) {  // along its line: what lies beside it is a few mm
    const Vector2d line(std::cos(yaw_), std::sin(yaw_));
    wanted = {line.dot(p_MTo_ - X_MB.position()), 0.0};
  }
  const double left = wanted.norm();
  if (left <= kReached) return std::nullopt;
  const double deceleration =
      std::min(kDeceleration, kBrakingShare * LinearRamp(limits_));
  const double speed = std::min({ApproachSpeed(left, deceleration, kReaction), MostTowards(wanted),
                                 limits_.max_linear_velocity});
  const double heading = HeadingTowards(X_MB.position(), wanted.x());
  wanted *= speed / left;
  const double change = limits_.max_linear_acceleration * params_.control_period;
  const double turning =
      Ramped(commanded_.wz, V_B.wz, SpeedOfTurn(geometry::WrapToPi(heading - X_MB.yaw), limits_),
             limits_.max_angular_acceleration * params_.control_period);
  return Twist2{Ramped(commanded_.vx, V_B.vx, wanted.x(), change),
                Ramped(commanded_.vy, V_B.vy, wanted.y(), change), turning};
}

GoalApproach::Step GoalApproach::Update(const Costmap& costmap, const Pose2& X_MB,
                                        const Twist2& V_B, SweptFootprint* sweep) {
  Twist2 velocity = Braked(V_B, limits_, params_.control_period);
  if (stage_ == Stage::kStopping && IsStopped(V_B, params_)) {
    if (!Choose(costmap, X_MB, sweep)) {
      End();
      return {State::kBlocked, {}};
    }
    stage_ = CanMoveSideways() && !has_pieces_ ? Stage::kDriving : Stage::kTurning;
  }
  if (stage_ == Stage::kTurning) {
    if (std::abs(TurnLeft(X_MB.yaw)) <= kAimed) {
      stage_ = Stage::kDriving;
      p_MTo_ = Place(X_MB);
    } else {
      velocity = Turn(X_MB, V_B);
    }
  }
  if (stage_ == Stage::kDriving) {
    if (const auto next = Drive(X_MB, V_B)) {
      velocity = *next;
    } else if (!pieces_.empty()) {
      stage_ = Stage::kStopping;
    } else {
      End();
      return {State::kArrived, {}};
    }
  }
  if (sweep->IsFree(costmap, X_MB, velocity,
                    TimeToCover(velocity, limits_, params_.control_period))) {
    commanded_ = velocity;
    return {State::kDriving, velocity};
  }
  End();
  return {State::kBlocked, {}};
}

}  // namespace hires::navigation
