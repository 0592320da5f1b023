#include "imagination/rollout/progress_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::imagination {
namespace {

constexpr double kSmallPlace = 1.0;      // [m] diagonal of a place in which nothing comes on
constexpr double kShortestStall = 5.0;   // [s]
constexpr double kAtGoal = 1.0;          // [m] what goes wrong so near has to do with the goal
constexpr double kStandingSpeed = 0.01;  // [m/s] mean
constexpr double kStandingTurn = 0.01;   // [rad/s] mean
constexpr double kOneSided = 0.8;        // share of all turning that is to one side: it circles
constexpr double kComesOn = 0.2;         // of its best pace
constexpr double kFullTurn = 2.0 * M_PI;

bool IsAtGoal(const Stall& stall) { return stall.to_goal && *stall.to_goal <= kAtGoal; }

std::string GoalText(const Stall& stall) {
  if (!stall.to_goal) return {};
  return IsAtGoal(stall) ? fmt::format(" {:.2f} m from its goal", *stall.to_goal)
                         : fmt::format(", its goal {:.1f} m away", *stall.to_goal);
}

/// What would help, where that is known.
std::string Remedy(const Stall& stall, const skills::MoveBaseParams& driving) {
  const navigation::DwaParams& local = driving.local;
  if (!IsAtGoal(stall)) {
    return stall.kind == Stall::Kind::kStands
               ? "look at what it waits for: its laser, its localisation, or who is in its way"
               : fmt::format(
                     "what is near is too narrow for it as it drives: more room there or another "
                     "way; driving.costmap.inflation_radius ({:g} m) should not be much more than "
                     "half the base's width",
                     driving.costmap.inflation_radius);
  }
  switch (stall.kind) {
    case Stall::Kind::kCircles:
      return fmt::format(
          "it drives {:.2f} m/s where it turns {:.2f} rad/s: a motion set that turns faster for "
          "its speed, or a wider driving.local.xy_goal_tolerance ({:g} m)",
          stall.speed, std::abs(stall.turning), local.xy_goal_tolerance);
    case Stall::Kind::kTurns:
      return fmt::format(
          "a lower driving.local.min_angular_velocity ({:g} rad/s), or a wider "
          "driving.local.yaw_goal_tolerance ({:g} rad)",
          local.min_angular_velocity, local.yaw_goal_tolerance);
    case Stall::Kind::kSwings:
      return fmt::format(
          "a wider driving.local.xy_goal_tolerance ({:g} m) or yaw_goal_tolerance ({:g} rad), or "
          "a motion set that brakes harder",
          local.xy_goal_tolerance, local.yaw_goal_tolerance);
    case Stall::Kind::kStands:
      break;
  }
  return fmt::format(
      "a lower driving.local.min_linear_velocity ({:g} m/s), or a wider "
      "driving.local.xy_goal_tolerance ({:g} m)",
      local.min_linear_velocity, local.xy_goal_tolerance);
}

}  // namespace

void ProgressWatch::Note(double time, const geometry::Pose2& X_MB,
                         const std::optional<skills::DriveView>& view) {
  noted_.push_back({time, X_MB});
  if (view && view->path && !view->path->empty()) X_MGoal_ = view->path->back();
}

std::optional<double> ProgressWatch::ToGoal() const {
  if (!X_MGoal_ || noted_.empty()) return std::nullopt;
  return (X_MGoal_->position() - noted_.back().X_MB.position()).norm();
}

bool ProgressWatch::ComesOn() const {
  if (!X_MGoal_ || noted_.empty()) return true;
  const double duration = noted_.back().time - noted_.front().time;
  double best = 0.0;  // [m/s]
  std::size_t before = 0;
  for (const Noted& now : noted_) {
    while (now.time - noted_[before].time > kShortestStall) ++before;
    if (before == 0) continue;
    const double way = (now.X_MB.position() - noted_[before - 1].X_MB.position()).norm();
    best = std::max(best, way / (now.time - noted_[before - 1].time));
  }
  const double nearer = (X_MGoal_->position() - noted_.front().X_MB.position()).norm() - *ToGoal();
  return nearer >= kComesOn * best * duration;
}

std::optional<Stall> ProgressWatch::StallAtEnd() const {
  if (noted_.empty()) return std::nullopt;
  Eigen::Vector2d lower = noted_.back().X_MB.position(), upper = lower;
  std::size_t first = noted_.size() - 1;
  double way = 0.0, turned = 0.0, turned_at_all = 0.0;
  for (; first > 0; --first) {
    const geometry::Pose2 &later = noted_[first].X_MB, &earlier = noted_[first - 1].X_MB;
    lower = lower.cwiseMin(earlier.position());
    upper = upper.cwiseMax(earlier.position());
    if ((upper - lower).norm() > kSmallPlace) break;
    way += (later.position() - earlier.position()).norm();
    const double turn = geometry::WrapToPi(later.yaw - earlier.yaw);
    turned += turn;
    turned_at_all += std::abs(turn);
  }
  Stall stall;
  stall.since = noted_[first].time;
  const double duration = noted_.back().time - stall.since;
  if (duration < kShortestStall) return std::nullopt;
  stall.X_MB = noted_.back().X_MB;
  stall.to_goal = ToGoal();
  stall.speed = way / duration;
  stall.turning = turned / duration;
  const bool moves = stall.speed > kStandingSpeed;
  const bool turns = turned_at_all / duration > kStandingTurn;
  const bool is_one_sided =
      std::abs(turned) > kFullTurn && std::abs(turned) > kOneSided * turned_at_all;
  stall.kind = is_one_sided     ? (moves ? Stall::Kind::kCircles : Stall::Kind::kTurns)
               : moves || turns ? Stall::Kind::kSwings
                                : Stall::Kind::kStands;
  return stall;
}

std::string WhatItDoes(const Stall& stall) {
  switch (stall.kind) {
    case Stall::Kind::kStands:
      return "stands" + GoalText(stall);
    case Stall::Kind::kCircles:
      return "drives in circles" + GoalText(stall);
    case Stall::Kind::kTurns:
      return "turns round and round" + GoalText(stall);
    case Stall::Kind::kSwings:
      return "goes to and fro" + GoalText(stall);
  }
  return {};
}

std::string StallText(const Stall& stall, const skills::MoveBaseParams& driving,
                      const std::string& why_tight) {
  const bool is_tight = IsAtGoal(stall) && !why_tight.empty();
  return fmt::format("since {:.1f} s it {}, at x {:.2f} m, y {:.2f} m; what may help: {}",
                     stall.since, WhatItDoes(stall), stall.X_MB.x, stall.X_MB.y,
                     is_tight ? "another goal, for " + why_tight : Remedy(stall, driving));
}

std::string UnderWayText(double time_limit, const std::optional<double>& to_goal, bool comes_on) {
  const std::string left = to_goal ? fmt::format(", its goal {:.1f} m away", *to_goal) : "";
  if (!comes_on) {
    return fmt::format(
        "in {:g} s it hardly came on{}: on its way it was stuck again and again; more time does "
        "not help, more room on its way does",
        time_limit, left);
  }
  return fmt::format(
      "it was still under way{}; what may help: a faster motion set, or more than "
      "rollout.time_limit ({:g} s)",
      left, time_limit);
}

}  // namespace hires::imagination
