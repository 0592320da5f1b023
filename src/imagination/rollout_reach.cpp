// What rollouts of one start say about another one.
#include "hires/imagination/rollout_reach.h"

#include <algorithm>
#include <cstring>

#include "imagination/reach_watch.h"

namespace hires::imagination {
namespace {

/// To the last bit: 0 and -0 may lead to different ones.
bool IsSame(double a, double b) { return std::memcmp(&a, &b, sizeof(double)) == 0; }

template <typename Vector>
bool IsSame(const Vector& a, const Vector& b) {
  return std::equal(a.data(), a.data() + a.size(), b.data(),
                    [](double x, double y) { return IsSame(x, y); });
}

bool IsSameObject(const world::ObjectState& a, const world::ObjectState& b) {
  return a.name == b.name && a.model == b.model && a.attached_to == b.attached_to &&
         IsSame(a.X_MO.translation, b.X_MO.translation) &&
         IsSame(a.X_MO.rotation.coeffs(), b.X_MO.rotation.coeffs()) &&
         IsSame(a.V_MO.linear, b.V_MO.linear) && IsSame(a.V_MO.angular, b.V_MO.angular);
}

bool IsSameRobot(const robot::RobotState& a, const robot::RobotState& b) {
  return IsSame(a.X_MB.x, b.X_MB.x) && IsSame(a.X_MB.y, b.X_MB.y) &&
         IsSame(a.X_MB.yaw, b.X_MB.yaw) &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), b.joints.end(),
                    [](const auto& x, const auto& y) {
                      return x.first == y.first && IsSame(x.second, y.second);
                    });
}

/// What the rollout has in it, in its order.
std::vector<world::ObjectState> WithinOf(const RolloutReach& reach, const RolloutSetup& setup,
                                         const base::ActionCall& action) {
  std::vector<world::ObjectState> within;
  for (const world::ObjectState& object : setup.world_state.objects) {
    if (IsWithin(reach, setup, action, object)) within.push_back(object);
  }
  return within;
}

}  // namespace

std::optional<ReachedRollout> ResultFrom(const RolloutSetup& played, const ReachedRollout& rollout,
                                         const base::ActionCall& action, const RolloutSetup& now) {
  const bool is_same_rollout = played.scene == now.scene && played.skills == now.skills &&
                               played.uncertainty == now.uncertainty && played.seed == now.seed &&
                               IsSameRobot(played.robot_state, now.robot_state);
  if (!is_same_rollout) return std::nullopt;
  const auto before = WithinOf(rollout.reach, played, action);
  const auto after = WithinOf(rollout.reach, now, action);
  if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), IsSameObject)) {
    return std::nullopt;
  }
  ReachedRollout kept = rollout;
  kept.result.final_world = now.world_state;
  for (world::ObjectState& object : kept.result.final_world.objects) {
    if (!IsWithin(rollout.reach, now, action, object)) continue;
    object = *rollout.result.final_world.Find(object.name);
  }
  return kept;
}

}  // namespace hires::imagination
