#include "hires/navigation/dwa.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "navigation/arc_ends.h"
#include "navigation/distance_grid.h"
#include "navigation/goal_approach.h"
#include "navigation/oscillation_guard.h"
#include "navigation/swept_footprint.h"
#include "navigation/velocity_window.h"
#include "navigation/way_manoeuvre.h"

namespace hires::navigation {
namespace {

constexpr double kKeptBehind = 1.0;     // [m] of the path already driven
constexpr double kRoomSpacing = 0.025;  // [m] between places tried for turning
constexpr double kRoomReached = 0.01;   // [m]
constexpr double kRoomShare = 0.9;      // of the goal's tolerance, so that stopping keeps within
constexpr double kBriskShare = 0.4;     // of it
constexpr double kBriskTurns = 2.0;     // goal's tolerances of yaw
constexpr double kInnerShare = 0.6;     // of it, so that turning keeps within, too

// [m] Kept free around the footprint where possible: poses between two checked ones may lie a
// quarter of a cell nearer to things, and a base does not follow to the millimetre.
constexpr double kMargin = 0.02;

/// A velocity with its score so far. Of equal scores the one that turns least wins, then the one
/// that moves least sideways, then the fastest.
struct Candidate {
  double score;
  geometry::Twist2 V_B;

  auto Key() const {
    return std::make_tuple(score, std::abs(V_B.wz), std::abs(V_B.vy), -V_B.vx, V_B.wz, V_B.vy);
  }
};
bool Worse(const Candidate& a, const Candidate& b) { return b.Key() < a.Key(); }

double Speed(const geometry::Twist2& V) { return std::hypot(V.vx, V.vy); }

bool IsUsable(double limit) { return std::isfinite(limit) && limit >= 0.0; }

void Check(const DwaParams& p) {
  HIRES_CHECK(p.control_period > 0.0 && p.sim_time > 0.0 && p.sim_granularity > 0.0 &&
                  p.angular_sim_granularity > 0.0 && p.xy_goal_tolerance > 0.0 &&
                  p.yaw_goal_tolerance > 0.0,
              "periods, granularities and tolerances of the local planner are positive");
  for (double value :
       {p.min_linear_velocity, p.max_lateral_velocity, p.min_angular_velocity, p.path_distance_bias,
        p.goal_distance_bias, p.obstacle_scale, p.stop_time_buffer, p.forward_point_distance,
        p.scaling_speed, p.max_scaling_factor, p.oscillation_reset_distance,
        p.oscillation_reset_angle, p.stopped_linear_velocity, p.stopped_angular_velocity}) {
    HIRES_CHECK(IsUsable(value), "parameters of the local planner are finite and not negative");
  }
}

/// The place straight before or behind a base that is nearest to p_M.
Eigen::Vector2d OnOwnLine(const geometry::Pose2& X_MB, const Eigen::Vector2d& p_M) {
  return X_MB * Eigen::Vector2d((X_MB.Inverse() * p_M).x(), 0.0);
}

/// The same path with no two points farther apart than `spacing`.
std::vector<Eigen::Vector2d> PointsAlong(const std::vector<geometry::Pose2>& path, double spacing) {
  std::vector<Eigen::Vector2d> points{path.front().position()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d from = path[i - 1].position(), along = path[i].position() - from;
    const int pieces = std::max(1, static_cast<int>(std::ceil(along.norm() / spacing)));
    for (int k = 1; k <= pieces; ++k) points.push_back(from + along * k / pieces);
  }
  return points;
}

std::vector<SweptFootprint> SweepsOf(const DwaParams& params, const Footprint& footprint,
                                     double margin) {
  std::vector<double> margins{kMargin};
  if (margin > 0.0) margins = {kMargin + margin, kMargin + 0.5 * margin, kMargin};
  std::vector<SweptFootprint> sweeps;
  for (const double more : margins)
    sweeps.emplace_back(Padded(footprint, more), params.sim_granularity,
                        params.angular_sim_granularity);
  sweeps.emplace_back(footprint, params.sim_granularity, params.angular_sim_granularity);
  return sweeps;
}

}  // namespace

struct DwaPlanner::Impl {
  Impl(const DwaParams& params, const Footprint& footprint)
      : params_(params),
        footprint_(footprint),
        sweeps_(SweepsOf(params, footprint, 0.0)),
        guard_(params.oscillation_reset_distance, params.oscillation_reset_angle,
               params.min_linear_velocity),
        watch_(params),
        approach_(params),
        manoeuvre_(params) {}

  void SetPath(const std::vector<geometry::Pose2>& path);
  DwaResult Update(const Costmap& costmap, const geometry::Pose2& X_MB,
                   const geometry::Twist2& V_B);

  // On the way.
  DwaResult Drive(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B);
  std::vector<geometry::Twist2> NextVelocities(const geometry::Twist2& V_B) const;
  bool PrepareGrids(const Costmap& costmap, const geometry::Pose2& X_MB);
  void DropDrivenPath(const Eigen::Vector2d& p_MB);
  std::size_t NearestOnPath(const Eigen::Vector2d& p_MB) const;
  std::optional<DwaResult> Manoeuvre(const Costmap& costmap, const geometry::Pose2& X_MB,
                                     const geometry::Twist2& V_B);
  std::vector<Candidate> ScoreDistances(const std::vector<geometry::Twist2>& velocities,
                                        const geometry::Pose2& X_MB, double resolution) const;
  std::optional<double> DistanceScore(const ArcEnds::End& end, double resolution) const;
  std::optional<Candidate> BestWithObstacles(std::vector<Candidate> candidates,
                                             const Costmap& costmap, const geometry::Pose2& X_MB,
                                             SweptFootprint* sweep) const;
  double FootprintScale(const geometry::Twist2& V_B) const;
  double Duration() const;

  // At the goal.
  std::optional<DwaResult> CloseIn(const Costmap& costmap, const geometry::Pose2& X_MB,
                                   const geometry::Twist2& V_B);
  DwaResult AtGoal(const Costmap& costmap, const geometry::Pose2& X_MB,
                   const geometry::Twist2& V_B);
  DwaResult Brake(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B);
  DwaResult Turn(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B);
  double TurningSpeed(double angle) const;
  std::optional<double> TurnToGoal(const Costmap& costmap, const geometry::Pose2& X_MB,
                                   SweptFootprint* sweep) const {
    return FreeTurn(costmap, X_MB, X_MGoal_.yaw, turn_sign_, sweep);
  }
  DwaResult MakeRoom(const Costmap& costmap, const geometry::Pose2& X_MB,
                     const geometry::Twist2& V_B);
  std::optional<Eigen::Vector2d> FindRoom(const Costmap& costmap, const geometry::Pose2& X_MB);
  bool IsWayFree(const Costmap& costmap, const geometry::Pose2& X_MB, const Eigen::Vector2d& p_MTo);
  bool CanMoveSideways() const { return params_.max_lateral_velocity > 0.0; }
  bool IsBrisk() const;
  SweptFootprint& Exact() { return sweeps_.back(); }
  SweptFootprint& Wide() { return sweeps_[sweeps_.size() - 2]; }  ///< with the least margin
  bool IsReturning() const { return num_missed_ > 0 && !CanMoveSideways(); }
  bool IsReached(const Costmap& costmap, const geometry::Pose2& X_MB);
  double YawError(const geometry::Pose2& X_MB) const {
    return geometry::WrapToPi(X_MGoal_.yaw - X_MB.yaw);
  }
  double GoalDistance(const geometry::Pose2& X_MB) const {
    return (X_MGoal_.position() - X_MB.position()).norm();
  }
  void LeaveGoal();

  DwaParams params_;
  robot::MotionSet limits_;
  Footprint footprint_;
  double margin_{0.0};                  // [m]
  std::vector<SweptFootprint> sweeps_;  // with margins, the widest first; the last one without
  OscillationGuard guard_;
  GoalWatch watch_;
  GoalApproach approach_;
  WayManoeuvre manoeuvre_;

  std::vector<Eigen::Vector2d> path_;  // dense
  std::size_t first_{0};               // of path_ that is not yet well behind the robot
  geometry::Pose2 X_MGoal_;

  LocalWindow window_;
  DistanceGrid path_grid_, goal_grid_, front_grid_;
  bool align_{false};  // does the forward point have to follow the path?

  bool position_reached_{false};
  int num_missed_{0};           // times that it came to rest out of tolerance of this goal
  std::size_t num_blocked_{0};  // times that something was in the way of coming close to this goal
  bool turning_{false};
  int turn_sign_{0};
  double turning_at_{0.0};               // [rad/s] commanded last
  std::optional<Eigen::Vector2d> room_;  // where to turn, if not here
};

void DwaPlanner::Impl::SetPath(const std::vector<geometry::Pose2>& path) {
  path_ = PointsAlong(path, params_.sim_granularity);
  first_ = 0;
  const geometry::Pose2 X_GoalNew = X_MGoal_.Inverse() * path.back();
  const bool is_same_goal = X_GoalNew.position().norm() <= kRoomReached;
  if (!is_same_goal) num_missed_ = 0;
  manoeuvre_.SetWay(is_same_goal);
  X_MGoal_ = path.back();
  guard_.Reset();
  num_blocked_ = 0;
  LeaveGoal();
}

void DwaPlanner::Impl::LeaveGoal() {
  position_reached_ = turning_ = false;
  turn_sign_ = 0;
  room_.reset();
  watch_.Reset();
  approach_.End();
}

DwaResult DwaPlanner::Impl::Update(const Costmap& costmap, const geometry::Pose2& X_MB,
                                   const geometry::Twist2& V_B) {
  DropDrivenPath(X_MB.position());
  const bool was_active = manoeuvre_.is_active();
  if (was_active) {
    if (const auto result = Manoeuvre(costmap, X_MB, V_B)) return *result;
  }
  if (approach_.is_active()) {
    if (const auto result = CloseIn(costmap, X_MB, V_B)) return *result;
  }
  if (IsReached(costmap, X_MB)) position_reached_ = true;
  if (position_reached_) return AtGoal(costmap, X_MB, V_B);
  if (watch_.Swings(X_MB, X_MGoal_.position())) {
    watch_.Reset();
    approach_.BeginTo(X_MGoal_);
    if (const auto result = CloseIn(costmap, X_MB, V_B)) return *result;
  }
  if (!was_active) {
    if (const auto result = Manoeuvre(costmap, X_MB, V_B)) return *result;
  }
  const DwaResult result = Drive(costmap, X_MB, V_B);
  if (result.status == DwaStatus::kNoValidTrajectory) manoeuvre_.Stand();  // for the next cycle
  return result;
}

/// None: the window drives.
std::optional<DwaResult> DwaPlanner::Impl::Manoeuvre(const Costmap& costmap,
                                                     const geometry::Pose2& X_MB,
                                                     const geometry::Twist2& V_B) {
  using Next = WayManoeuvre::Next;
  const std::size_t nearest = NearestOnPath(X_MB.position());
  const auto step = manoeuvre_.Update(costmap, X_MB, V_B, path_, nearest, &sweeps_);
  if (step.next == Next::kBrake) return Brake(costmap, X_MB, V_B);
  if (step.next == Next::kNothing) return std::nullopt;
  guard_.Reset();
  return DwaResult{DwaStatus::kDriving, step.velocity, 1};
}

/// Turning to the goal's heading may move the believed place by some cm. A base that moves sideways
/// stops at the edge of the tolerance all the same, for it need not turn away to come back; so does
/// one that could not turn further inside.
bool DwaPlanner::Impl::IsReached(const Costmap& costmap, const geometry::Pose2& X_MB) {
  const double distance = GoalDistance(X_MB);
  if (distance > params_.xy_goal_tolerance) return false;
  return CanMoveSideways() || distance <= kInnerShare * params_.xy_goal_tolerance ||
         !TurnToGoal(costmap, {X_MGoal_.x, X_MGoal_.y, X_MB.yaw}, &Wide());
}

/// None: it is there, or something is in its way.
std::optional<DwaResult> DwaPlanner::Impl::CloseIn(const Costmap& costmap,
                                                   const geometry::Pose2& X_MB,
                                                   const geometry::Twist2& V_B) {
  SweptFootprint* sweep = &sweeps_[std::min(num_blocked_, sweeps_.size() - 1)];
  const GoalApproach::Step step = approach_.Update(costmap, X_MB, V_B, sweep);
  if (step.state == GoalApproach::State::kBlocked) ++num_blocked_;
  if (step.state == GoalApproach::State::kDriving)
    return DwaResult{DwaStatus::kDriving, step.velocity, 1};
  position_reached_ = step.state == GoalApproach::State::kArrived;
  return std::nullopt;
}

void DwaPlanner::Impl::DropDrivenPath(const Eigen::Vector2d& p_MB) {
  const auto near = std::find_if(path_.begin() + first_, path_.end(), [&](const auto& point) {
    return (point - p_MB).norm() < kKeptBehind;
  });
  if (near != path_.end()) first_ = near - path_.begin();
}

/// Of what lies a little ahead: behind a wall the path may come back.
std::size_t DwaPlanner::Impl::NearestOnPath(const Eigen::Vector2d& p_MB) const {
  const auto count = static_cast<std::size_t>(kLocalHalfWidth / params_.sim_granularity);
  const auto end = path_.begin() + std::min(path_.size(), first_ + count);
  const auto nearest =
      std::min_element(path_.begin() + first_, end, [&](const auto& a, const auto& b) {
        return (a - p_MB).squaredNorm() < (b - p_MB).squaredNorm();
      });
  return nearest - path_.begin();
}

// ---- on the way -------------------------------------------------------------------------------

DwaResult DwaPlanner::Impl::Drive(const Costmap& costmap, const geometry::Pose2& X_MB,
                                  const geometry::Twist2& V_B) {
  DwaResult result;
  if (!Exact().IsFree(costmap, X_MB, {}, 0.0) || !PrepareGrids(costmap, X_MB)) return result;
  const auto velocities = NextVelocities(V_B);
  result.num_samples = static_cast<int>(velocities.size());
  const auto candidates = ScoreDistances(velocities, X_MB, costmap.resolution());
  std::optional<Candidate> best;
  for (auto sweep = sweeps_.begin(); sweep != sweeps_.end() && !best; ++sweep)
    best = BestWithObstacles(candidates, costmap, X_MB, &*sweep);
  if (!best) {  // come to rest as gently as the limits say; from there other ways may open
    return IsStopped(V_B, params_) ? result : Brake(costmap, X_MB, V_B);
  }
  guard_.Chosen(best->V_B, X_MB);
  result.status = DwaStatus::kDriving;
  result.velocity = best->V_B;
  return result;
}

/// On the way back to a goal that it missed, where nothing but the window leads there, the base may
/// turn as slowly as it takes to change the sense of a turn; else one with a low acceleration turns
/// on as it began, the long way round.
std::vector<geometry::Twist2> DwaPlanner::Impl::NextVelocities(const geometry::Twist2& V_B) const {
  DwaParams params = params_;
  if (IsReturning()) {
    const double change = limits_.max_angular_acceleration * params.control_period;
    params.min_angular_velocity = std::min(params.min_angular_velocity, 0.5 * change);
  }
  return ReachableVelocities(params, limits_, V_B);
}

bool DwaPlanner::Impl::PrepareGrids(const Costmap& costmap, const geometry::Pose2& X_MB) {
  window_.Centre(costmap, X_MB.position(), kLocalHalfWidth);
  std::vector<int> on_path;
  Eigen::Vector2d local_goal = X_MGoal_.position();
  double way = 0.0;  // [m]
  for (std::size_t i = first_; i < path_.size(); ++i) {
    const int cell = window_.CellBelow(path_[i]);
    if (cell < 0 && !on_path.empty()) break;  // the path leaves the window
    if (cell < 0) continue;
    // Behind a detour may be what is near through a gap; the path knows why it avoids that.
    if (!on_path.empty()) way += (path_[i] - local_goal).norm();
    if (way > kLocalHalfWidth) break;
    on_path.push_back(cell);
    local_goal = path_[i];
  }
  if (on_path.empty()) return false;
  const Eigen::Vector2d to_goal = local_goal - X_MB.position();
  const Eigen::Vector2d ahead =
      params_.forward_point_distance *
      (to_goal.norm() > 0.0 ? to_goal.normalized() : Eigen::Vector2d::UnitX());
  const int front = window_.CellBelow(local_goal + ahead);
  align_ = to_goal.norm() > params_.forward_point_distance;
  path_grid_.Compute(window_, on_path);
  goal_grid_.Compute(window_, {on_path.back()});
  front_grid_.Compute(window_, {front < 0 ? on_path.back() : front});
  return true;
}

double DwaPlanner::Impl::Duration() const {
  const double speed = limits_.max_linear_velocity;
  const double stopping = params_.control_period + params_.stop_time_buffer +
                          TimeToStop(speed, limits_.linear_deceleration());
  const double in_window = 0.8 * (kLocalHalfWidth - params_.forward_point_distance);
  const double longest = speed > 0.0 ? in_window / speed : params_.sim_time;
  return std::max(params_.sim_time, std::min(stopping, longest));
}

std::vector<Candidate> DwaPlanner::Impl::ScoreDistances(
    const std::vector<geometry::Twist2>& velocities, const geometry::Pose2& X_MB,
    double resolution) const {
  std::vector<Candidate> candidates;
  candidates.reserve(velocities.size());
  ArcEnds ends(X_MB, Duration(), params_.forward_point_distance);
  for (const geometry::Twist2& V_B : velocities) {
    if (!guard_.Allows(V_B)) continue;
    const auto score = DistanceScore(ends.Of(V_B), resolution);
    if (score) candidates.push_back({*score, V_B});
  }
  return candidates;
}

std::optional<double> DwaPlanner::Impl::DistanceScore(const ArcEnds::End& end,
                                                      double resolution) const {
  const auto base = window_.Around(end.p_MB);
  const auto nose = window_.Around(end.p_MF);
  if (!base || !nose) return std::nullopt;
  const double from_path = path_grid_.At(*base), from_goal = goal_grid_.At(*base);
  if (from_path >= DistanceGrid::kUnreachable || from_goal >= DistanceGrid::kUnreachable) {
    return std::nullopt;
  }
  const double path_cells = from_path + (align_ ? path_grid_.At(*nose) : 0.0);
  const double goal_cells = from_goal + front_grid_.At(*nose);
  return 0.5 * resolution *
         (params_.path_distance_bias * path_cells + params_.goal_distance_bias * goal_cells);
}

/// Obstacles only ever add to a score, so looking in the order of the scores without them finds the
/// best after a few looks: the same one as looking at all.
std::optional<Candidate> DwaPlanner::Impl::BestWithObstacles(std::vector<Candidate> candidates,
                                                             const Costmap& costmap,
                                                             const geometry::Pose2& X_MB,
                                                             SweptFootprint* sweep) const {
  std::optional<Candidate> best;
  const double weight = costmap.resolution() * params_.obstacle_scale;
  std::make_heap(candidates.begin(), candidates.end(), Worse);
  while (!candidates.empty() && (!best || candidates.front().score <= best->score)) {
    std::pop_heap(candidates.begin(), candidates.end(), Worse);
    Candidate candidate = candidates.back();
    candidates.pop_back();
    const std::uint8_t cost =
        sweep->HighestCost(costmap, X_MB, candidate.V_B, Duration(), FootprintScale(candidate.V_B));
    if (cost >= kLethalCost) continue;
    candidate.score += weight * cost;
    if (!best || Worse(*best, candidate)) best = candidate;
  }
  return best;
}

double DwaPlanner::Impl::FootprintScale(const geometry::Twist2& V_B) const {
  const double speed = Speed(V_B), fastest = limits_.max_linear_velocity;
  if (speed <= params_.scaling_speed || fastest <= params_.scaling_speed) return 1.0;
  const double share = (speed - params_.scaling_speed) / (fastest - params_.scaling_speed);
  return 1.0 + params_.max_scaling_factor * std::min(share, 1.0);
}

// ---- at the goal ------------------------------------------------------------------------------

DwaResult DwaPlanner::Impl::AtGoal(const Costmap& costmap, const geometry::Pose2& X_MB,
                                   const geometry::Twist2& V_B) {
  guard_.Reset();
  if (std::abs(YawError(X_MB)) > params_.yaw_goal_tolerance) {
    if (!turning_) turning_at_ = 0.0;
    turning_ = turning_ || IsStopped(V_B, params_);
    return turning_ ? Turn(costmap, X_MB, V_B) : Brake(costmap, X_MB, V_B);
  }
  turning_ = false;
  if (!IsStopped(V_B, params_)) return Brake(costmap, X_MB, V_B);
  if (GoalDistance(X_MB) <= params_.xy_goal_tolerance) return {DwaStatus::kGoalReached, {}, 0};
  ++num_missed_;
  LeaveGoal();  // it came to rest too far off after all
  if (num_missed_ > 1 || !CanMoveSideways() || !IsBrisk()) {
    // Where something is in its way it tries once more with less room, down to none.
    for (std::size_t room = num_blocked_; room < sweeps_.size(); ++room) {
      approach_.BeginFrom(X_MB, X_MGoal_);
      if (const auto result = CloseIn(costmap, X_MB, V_B)) return *result;
    }
  }
  return Drive(costmap, X_MB, V_B);
}

/// From full speed it comes to rest well within the tolerances, as with the PR2's sets: then the
/// window brings it back to a goal that it missed once.
bool DwaPlanner::Impl::IsBrisk() const {
  const double way = 0.5 * limits_.max_linear_velocity *
                     TimeToStop(limits_.max_linear_velocity, limits_.linear_deceleration());
  const double turn = 0.5 * limits_.max_angular_velocity *
                      TimeToStop(limits_.max_angular_velocity, limits_.angular_deceleration());
  return way <= kBriskShare * params_.xy_goal_tolerance &&
         turn <= kBriskTurns * params_.yaw_goal_tolerance;
}

DwaResult DwaPlanner::Impl::Brake(const Costmap& costmap, const geometry::Pose2& X_MB,
                                  const geometry::Twist2& V_B) {
  const geometry::Twist2 braked = Braked(V_B, limits_, params_.control_period);
  if (!Exact().IsFree(costmap, X_MB, braked,
                      TimeToCover(braked, limits_, params_.control_period))) {
    return {DwaStatus::kNoValidTrajectory, {}, 1};
  }
  return {DwaStatus::kDriving, braked, 1};
}

DwaResult DwaPlanner::Impl::Turn(const Costmap& costmap, const geometry::Pose2& X_MB,
                                 const geometry::Twist2& V_B) {
  if (room_) return MakeRoom(costmap, X_MB, V_B);
  std::optional<double> turn;
  if (turn_sign_ != 0) turn = TurnToGoal(costmap, X_MB, &Exact());
  for (std::size_t i = 0; turn_sign_ == 0 && i + 1 < sweeps_.size() && !turn; ++i)
    turn = TurnToGoal(costmap, X_MB, &sweeps_[i]);
  if (!turn) {
    turn_sign_ = 0;
    const DwaResult aside = MakeRoom(costmap, X_MB, V_B);
    if (aside.status == DwaStatus::kDriving) return aside;
    turn = TurnToGoal(costmap, X_MB, &Exact());
    if (!turn) return aside;
  }
  turn_sign_ = *turn < 0.0 ? -1 : 1;
  const double change = limits_.max_angular_acceleration * params_.control_period;
  geometry::Twist2 velocity = Braked(V_B, limits_, params_.control_period);
  if (CanMoveSideways() && IsBrisk()) {
    velocity.wz = Approach(V_B.wz, turn_sign_ * TurningSpeed(std::abs(*turn)), change);
  } else {
    velocity.wz = Ramped(turning_at_, V_B.wz, SpeedOfTurn(*turn, limits_), change);
  }
  turning_at_ = velocity.wz;
  return {DwaStatus::kDriving, velocity, 1};
}

/// [rad/s] As the original's.
double DwaPlanner::Impl::TurningSpeed(double angle) const {
  const double slowest = std::min(params_.min_angular_velocity, limits_.max_angular_velocity);
  const double stoppable = std::sqrt(2.0 * AngularRamp(limits_) * angle);
  return std::min({std::max(angle, slowest), stoppable, limits_.max_angular_velocity});
}

DwaResult DwaPlanner::Impl::MakeRoom(const Costmap& costmap, const geometry::Pose2& X_MB,
                                     const geometry::Twist2& V_B) {
  if (!room_ || !IsWayFree(costmap, X_MB, *room_)) room_ = FindRoom(costmap, X_MB);
  if (!room_) return {DwaStatus::kNoValidTrajectory, {}, 1};
  const Eigen::Vector2d to_room = X_MB.Inverse() * *room_;
  const double distance = to_room.norm();
  if (distance < kRoomReached) {
    room_.reset();
    turning_ = false;  // stand still first
    return Brake(costmap, X_MB, V_B);
  }
  const double change = limits_.max_linear_acceleration * params_.control_period;
  const double creeping =
      CanMoveSideways() ? params_.max_lateral_velocity : params_.min_linear_velocity;
  const double speed =
      std::min({creeping, limits_.max_linear_velocity, distance / params_.control_period,
                std::sqrt(2.0 * LinearRamp(limits_) * distance)});
  const Eigen::Vector2d now(V_B.vx, V_B.vy);
  Eigen::Vector2d wanted = to_room / distance * speed;
  if (!CanMoveSideways()) wanted.y() = 0.0;  // the place was chosen on its line
  const Eigen::Vector2d difference = wanted - now;
  const Eigen::Vector2d next =
      difference.norm() > change ? Eigen::Vector2d(now + difference.normalized() * change) : wanted;
  const double turning = Braked(V_B, limits_, params_.control_period).wz;
  return {DwaStatus::kDriving, {next.x(), next.y(), turning}, 1};
}

/// The nearest place within the goal's tolerance that can be reached in a straight line, as the
/// robot is headed now, and where it can turn.
std::optional<Eigen::Vector2d> DwaPlanner::Impl::FindRoom(const Costmap& costmap,
                                                          const geometry::Pose2& X_MB) {
  const double radius = kRoomShare * params_.xy_goal_tolerance;
  const int reach = static_cast<int>(radius / kRoomSpacing);
  std::vector<std::tuple<double, int, int>> places;  // nearest first
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Eigen::Vector2d offset = kRoomSpacing * Eigen::Vector2d(i, j);
      const double distance = (X_MGoal_.position() + offset - X_MB.position()).norm();
      if (offset.norm() <= radius && distance > kRoomReached) places.emplace_back(distance, i, j);
    }
  }
  std::sort(places.begin(), places.end());
  for (const auto& [distance, i, j] : places) {
    Eigen::Vector2d place = X_MGoal_.position() + kRoomSpacing * Eigen::Vector2d(i, j);
    if (!CanMoveSideways()) place = OnOwnLine(X_MB, place);
    if ((X_MGoal_.position() - place).norm() > radius) continue;
    if ((X_MB.position() - place).norm() <= kRoomReached) continue;
    if (!IsWayFree(costmap, X_MB, place)) continue;
    if (TurnToGoal(costmap, {place.x(), place.y(), X_MB.yaw}, &Wide())) return place;
  }
  return std::nullopt;
}

bool DwaPlanner::Impl::IsWayFree(const Costmap& costmap, const geometry::Pose2& X_MB,
                                 const Eigen::Vector2d& p_MTo) {
  const Eigen::Vector2d way = X_MB.Inverse() * p_MTo;  // driven in one unit of time
  return Exact().IsFree(costmap, X_MB, {way.x(), way.y(), 0.0}, 1.0);
}

// ---- the planner ------------------------------------------------------------------------------

DwaPlanner::DwaPlanner(const DwaParams& params, const Footprint& footprint) {
  Check(params);
  HIRES_CHECK(footprint.outline.size() >= 3, "a footprint has at least three corners");
  impl_ = std::make_unique<Impl>(params, footprint);
}
DwaPlanner::DwaPlanner(const DwaPlanner& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
DwaPlanner& DwaPlanner::operator=(const DwaPlanner& other) {
  *impl_ = *other.impl_;
  return *this;
}
DwaPlanner::~DwaPlanner() = default;

void DwaPlanner::SetPath(const std::vector<geometry::Pose2>& path) {
  HIRES_CHECK(!path.empty(), "a path has at least its goal");
  impl_->SetPath(path);
}

void DwaPlanner::SetMotionSet(const robot::MotionSet& limits) {
  HIRES_CHECK(IsUsable(limits.max_linear_velocity) && IsUsable(limits.max_angular_velocity) &&
                  IsUsable(limits.max_linear_acceleration) &&
                  IsUsable(limits.max_angular_acceleration) &&
                  IsUsable(limits.max_linear_deceleration) &&
                  IsUsable(limits.max_angular_deceleration),
              "limits of motion are finite and not negative");
  impl_->limits_ = limits;
  impl_->approach_.SetMotionSet(limits);
  impl_->watch_.SetMotionSet(limits);
  impl_->manoeuvre_.SetMotionSet(limits);
}

void DwaPlanner::SetMargin(double margin) {
  HIRES_CHECK(IsUsable(margin), "a margin is finite and not negative");
  if (margin == impl_->margin_) return;
  impl_->margin_ = margin;
  impl_->sweeps_ = SweepsOf(impl_->params_, impl_->footprint_, margin);
}

DwaResult DwaPlanner::Update(const Costmap& costmap, const geometry::Pose2& X_MB,
                             const geometry::Twist2& V_B) {
  HIRES_CHECK(!impl_->path_.empty(), "SetPath comes before Update");
  return impl_->Update(costmap, X_MB, V_B);
}

}  // namespace hires::navigation
