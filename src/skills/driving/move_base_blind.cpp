#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/navigation/slow_before.h"
#include "hires/robot/echoes.h"
#include "hires/skills/move_base.h"
#include "skills/driving/base_limits.h"

namespace hires::skills {
namespace {

using geometry::Pose2;
using geometry::Twist2;

/// The motion set as far as a blind drive uses it.
robot::MotionSet Slowed(robot::MotionSet motion_set, const MoveBaseBlindParams& params) {
  motion_set.max_linear_velocity = std::min(motion_set.max_linear_velocity, params.max_velocity);
  motion_set.max_angular_velocity =
      std::min(motion_set.max_angular_velocity, params.max_angular_velocity);
  return motion_set;
}

/// [m] in the base as it stands now: what the scan shows, and what earlier ones showed.
std::vector<Eigen::Vector2d> ThingsAround(const robot::PlacedScan& scan, const Pose2& X_OB,
                                          const geometry::Polygon& body) {
  const Pose2 X_BO = X_OB.Inverse(), X_BScan = X_BO * scan.X_OB;
  std::vector<Eigen::Vector2d> things_B = robot::EchoesOf(scan, body);
  for (Eigen::Vector2d& thing : things_B) thing = X_BScan * thing;
  for (const Eigen::Vector2d& thing_O : scan.out_of_view_O) things_B.push_back(X_BO * thing_O);
  return things_B;
}

}  // namespace

std::optional<geometry::Polygon> BodyThatLooks(const DrivingContext& context) {
  return context.by_plane ? std::optional(context.base) : std::nullopt;
}

MoveBaseBlind::MoveBaseBlind(const MoveBaseBlindParams& params, const Pose2& X_MGoal,
                             const robot::MotionSet& motion_set,
                             const robot::BaseControllerParams& base,
                             std::optional<geometry::Polygon> body)
    : params_(params),
      X_MGoal_(X_MGoal),
      motion_set_(motion_set),
      drive_(base.drive),
      min_turning_radius_(base.min_turning_radius),
      body_(std::move(body)),
      lost_(params.lost) {
  if (drive_ != robot::Drive::kCarLike) return;
  navigation::CarFollowerParams following;
  following.control_period = params.period;
  following.xy_goal_tolerance = params.xy_tolerance;
  following.yaw_goal_tolerance = params.yaw_tolerance;
  following.deceleration = params.deceleration;
  following.reaction_time = params.reaction_time;
  car_.emplace(following, geometry::Polygon{}, min_turning_radius_);
  car_->SetMotionSet(WithinLimits(Slowed(motion_set, params), base.limits));
}

double MoveBaseBlind::Deceleration() const {
  return std::min(params_.deceleration, motion_set_.linear_deceleration());
}

double MoveBaseBlind::AngularDeceleration() const {
  return std::min(params_.deceleration, motion_set_.angular_deceleration());
}

double MoveBaseBlind::LinearSpeed(double distance) const {
  return std::min({navigation::ApproachSpeed(distance, Deceleration(), params_.reaction_time),
                   params_.max_velocity, motion_set_.max_linear_velocity});
}

double MoveBaseBlind::TurningSpeed(double angle) const {
  const double speed = std::min(
      {navigation::ApproachSpeed(std::abs(angle), AngularDeceleration(), params_.reaction_time),
       params_.max_angular_velocity, motion_set_.max_angular_velocity});
  return std::copysign(speed, angle);
}

MoveBaseBlind::Course MoveBaseBlind::Straight(const Pose2& X_BGoal) const {
  const double distance = std::hypot(X_BGoal.x, X_BGoal.y);
  const double scale = distance > 0.0 ? LinearSpeed(distance) / distance : 0.0;
  return {{scale * X_BGoal.x, scale * X_BGoal.y, TurningSpeed(X_BGoal.yaw)},
          distance + std::abs(X_BGoal.yaw)};
}

/// Wheels that cannot drive sideways: it faces the goal or turns its back on it, whichever is
/// nearer, drives there, and turns.
MoveBaseBlind::Course MoveBaseBlind::TurnAndDrive(const Pose2& X_BGoal) {
  const double distance = std::hypot(X_BGoal.x, X_BGoal.y);
  if (distance <= params_.xy_tolerance) {
    return {{0.0, 0.0, TurningSpeed(X_BGoal.yaw)}, std::abs(X_BGoal.yaw)};
  }
  const double ahead = std::atan2(X_BGoal.y, X_BGoal.x);
  // Once chosen it is kept unless it is clearly wrong, so that noise does not change it.
  const double most = begun_driving_ ? 0.6 * geometry::kPi : 0.5 * geometry::kPi;
  if (std::abs(backwards_ ? geometry::WrapToPi(ahead + geometry::kPi) : ahead) > most) {
    backwards_ = !backwards_;
  }
  begun_driving_ = true;
  const double off = backwards_ ? geometry::WrapToPi(ahead + geometry::kPi) : ahead;
  const bool is_aimed = std::abs(off) <= params_.yaw_tolerance ||
                        std::abs(distance * std::sin(off)) <= 0.5 * params_.xy_tolerance;
  const double speed = is_aimed ? LinearSpeed(distance) * std::cos(off) : 0.0;
  return {{backwards_ ? -speed : speed, 0.0, TurningSpeed(off)},
          geometry::kPi + distance + std::abs(off)};
}

void MoveBaseBlind::PlanWay(const Pose2& X_MB) {
  car_->SetPath(navigation::ShortestCarPath(X_MB, X_MGoal_, min_turning_radius_));
  ++num_ways_;
  nearest_ = 1e9;
}

/// Steering like a car. Where it came to rest out of tolerance it is given a new way, some times.
MoveBaseBlind::Course MoveBaseBlind::Steer(const robot::Observation& observation) {
  if (num_ways_ == 0) PlanWay(observation.X_MB);
  auto result = car_->Update(nullptr, observation.X_MB, observation.V_B);
  if (result.status == navigation::DwaStatus::kNoValidTrajectory && num_ways_ < kMostCarWays) {
    PlanWay(observation.X_MB);
    result = car_->Update(nullptr, observation.X_MB, observation.V_B);
  }
  return {result.velocity, car_->remaining()};
}

MoveBaseBlind::Course MoveBaseBlind::CourseTo(const robot::Observation& observation,
                                              const Pose2& X_BGoal) {
  switch (drive_) {
    case robot::Drive::kCarLike:
      return Steer(observation);
    case robot::Drive::kDifferential:
      return TurnAndDrive(X_BGoal);
    case robot::Drive::kOmnidirectional:
      break;
  }
  return Straight(X_BGoal);
}

/// Where the odometry was reset, the scan at hand lies nobody knows where: it waits for the next.
void MoveBaseBlind::LookAround(const robot::Observation& observation) {
  const ScanWatch::News news = watch_.Look(observation);
  if (news.is_reset) scan_.reset();
  if (news.scan) scan_ = news.scan;
  if (observation.scan_age > kScanPatience) scan_.reset();
}

Twist2 MoveBaseBlind::BeforeThings(const Twist2& wanted,
                                   const robot::Observation& observation) const {
  if (!body_) return wanted;
  if (!scan_) return {};
  navigation::SlowBeforeParams braking;
  braking.deceleration = Deceleration();
  braking.angular_deceleration = AngularDeceleration();
  braking.reaction_time = params_.reaction_time;
  return navigation::SlowedBefore(wanted, ThingsAround(*scan_, observation.X_OB, *body_), *body_,
                                  braking);
}

Status MoveBaseBlind::Stuck(const robot::Observation& observation) const {
  if (!body_ || scan_) return Failed(base::FailureCode::kStuck);
  return Failed({base::FailureCode::kStaleScan,
                 {},
                 observation.scan
                     ? fmt::format("the base's laser is silent for {:.1f} s", observation.scan_age)
                     : "no scan of the base's laser has come"});
}

Status MoveBaseBlind::Update(const robot::Observation& observation, robot::Command* command) {
  command->motion_set = motion_set_;
  if (body_) LookAround(observation);
  const LostWatch::State place = lost_.Look(observation);
  if (place == LostWatch::State::kGivenUp) return Failed(lost_.Why(observation));
  if (place == LostWatch::State::kLost || place == LostWatch::State::kFound) {
    command->base_velocity = Twist2{};
    num_ways_ = 0;
    nearest_ = 1e9;  // from wherever it will be found
    return {};
  }
  const Pose2 X_BGoal = observation.X_MB.Inverse() * X_MGoal_;
  const double distance = std::hypot(X_BGoal.x, X_BGoal.y), turn = std::abs(X_BGoal.yaw);
  if (distance <= params_.xy_tolerance && turn <= params_.yaw_tolerance) {
    command->base_velocity = Twist2{};
    const bool stopped = std::hypot(observation.V_B.vx, observation.V_B.vy) < 0.01 &&
                         std::abs(observation.V_B.wz) < 0.01;
    return stopped ? Succeeded() : Status{};
  }
  const Course course = CourseTo(observation, X_BGoal);
  if (course.remaining < nearest_ - 0.01) {
    nearest_ = course.remaining;
    last_progress_ = observation.time;
  }
  if (observation.time - last_progress_ > params_.stuck_timeout) return Stuck(observation);
  command->base_velocity = BeforeThings(course.velocity, observation);
  return {};
}

}  // namespace hires::skills
