#include "hires/manipulation/arm_path.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "manipulation/corner_rounding.h"
#include "manipulation/joint_planner.h"
#include "manipulation/motion_check.h"

namespace hires::manipulation {
namespace {

constexpr double kMaxJump = 0.35;  // [rad] of a joint per step of a straight way; more is a jump

ArmPathResult Failed(ArmPathStatus status, Obstruction obstruction = {}) {
  return {status, std::move(obstruction), {}};
}

/// Goals that are within the limits and free; `why` tells what blocks the first, if it is blocked.
std::vector<ArmJoints> FreeGoals(const MotionCheck& check, const std::vector<ArmJoints>& goals,
                                 int at_most, Obstruction* why) {
  std::vector<ArmJoints> free;
  for (const ArmJoints& goal : goals) {
    if (static_cast<int>(free.size()) >= at_most) break;
    const Obstruction blocked = check.WhyBlocked(goal);
    if (!blocked) free.push_back(goal);
    if (!*why) *why = blocked;
  }
  return free;
}

std::vector<ArmJoints> WithinLimits(const MotionCheck& check, const std::vector<ArmJoints>& goals) {
  std::vector<ArmJoints> within;
  std::copy_if(goals.begin(), goals.end(), std::back_inserter(within),
               [&](const ArmJoints& goal) { return check.IsWithinLimits(goal); });
  return within;
}

geometry::Pose3 PoseBetween(const geometry::Pose3& from, const geometry::Pose3& to, double share) {
  return {from.translation + share * (to.translation - from.translation),
          from.rotation.slerp(share, to.rotation)};
}

int NumSteps(const geometry::Pose3& from, const geometry::Pose3& to, double step) {
  const double way = (to.translation - from.translation).norm();
  const double turn = 0.1 * from.rotation.angularDistance(to.rotation);
  return std::max(1, static_cast<int>(std::ceil(std::max(way, turn) / step)));
}

/// Joints for every step of the tool's straight way; empty if one cannot be reached from the one
/// before without a jump.
std::vector<ArmJoints> FollowTool(const ArmScene& arm, const ArmJoints& start,
                                  const geometry::Pose3& X_BT, double step) {
  InverseParams params;
  params.max_tries = 1;  // only on from the step before
  const geometry::Pose3 X_BStart = arm.kinematics->ToolPose(arm.posture, start);
  const int steps = NumSteps(X_BStart, X_BT, step);
  std::vector<ArmJoints> path{start};
  for (int i = 1; i <= steps; ++i) {
    const geometry::Pose3 X = PoseBetween(X_BStart, X_BT, static_cast<double>(i) / steps);
    const auto solved = arm.kinematics->Solve(arm.posture, X, path.back(), 0, params);
    if (solved.empty() || LargestDifference(solved.front(), path.back()) > kMaxJump) return {};
    path.push_back(solved.front());
  }
  return path;
}

Obstruction WhyBlockedAlong(const MotionCheck& check, const std::vector<ArmJoints>& path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    Obstruction why = check.WhyBlocked(path[i]);
    if (!why) why = check.WhyBlocked(path[i - 1], path[i]);
    if (why) return why;
  }
  return {};
}

}  // namespace

ArmPathResult PlanArmPath(const ArmScene& arm, const std::vector<ArmJoints>& goals,
                          std::uint64_t seed, const ArmPathParams& params) {
  const ArmJoints start = arm.kinematics->JointsOf(arm.posture);
  for (const ArmJoints& goal : goals) {
    HIRES_CHECK(goal.size() == start.size(), "one value per joint of the arm");
  }
  const MotionCheck check(arm, params);
  const std::vector<ArmJoints> reachable = WithinLimits(check, goals);
  if (reachable.empty()) return Failed(ArmPathStatus::kUnreachable);
  if (Obstruction why = check.WhyBlocked(start); why) {
    return Failed(ArmPathStatus::kStartBlocked, std::move(why));
  }
  Obstruction goal_touch;
  const auto free = FreeGoals(check, reachable, params.max_goals, &goal_touch);
  if (free.empty()) return Failed(ArmPathStatus::kGoalBlocked, std::move(goal_touch));
  for (const ArmJoints& goal : free) {
    if (check.IsFree(start, goal)) return {ArmPathStatus::kFound, {}, {start, goal}};
  }
  auto path = PlanByRrtConnect(check, *arm.kinematics, start, free, seed, params);
  if (path.empty()) return Failed(ArmPathStatus::kNoPath, check.WhyBlocked(start, free.front()));
  return {ArmPathStatus::kFound, {}, RoundCorners(check, path)};
}

ArmPathResult PlanStraight(const ArmScene& arm, const geometry::Pose3& X_BT, double step,
                           const ArmPathParams& params) {
  HIRES_CHECK(step > 0.0, "step > 0");
  const ArmJoints start = arm.kinematics->JointsOf(arm.posture);
  const MotionCheck check(arm, params);
  if (Obstruction why = check.WhyBlocked(start); why) {
    return Failed(ArmPathStatus::kStartBlocked, std::move(why));
  }
  std::vector<ArmJoints> path = FollowTool(arm, start, X_BT, step);
  if (path.empty()) return Failed(ArmPathStatus::kUnreachable);
  if (Obstruction why = check.WhyBlocked(path.back()); why) {
    return Failed(ArmPathStatus::kGoalBlocked, std::move(why));
  }
  if (Obstruction why = WhyBlockedAlong(check, path); why) {
    return Failed(ArmPathStatus::kNoPath, std::move(why));
  }
  return {ArmPathStatus::kFound, {}, std::move(path)};
}

}  // namespace hires::manipulation
