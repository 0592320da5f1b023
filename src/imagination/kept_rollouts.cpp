#include "hires/imagination/kept_rollouts.h"

#include <algorithm>
#include <cstring>

#include "imagination/rollout/reach_watch.h"

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

std::optional<RolloutResult> ResultFrom(const RolloutSetup& played, const RolloutResult& result,
                                        const base::ActionCall& action, const RolloutSetup& now) {
  const bool is_same_rollout = played.scene == now.scene && played.skills == now.skills &&
                               played.uncertainty->hash == now.uncertainty->hash &&
                               played.seed == now.seed &&
                               IsSameRobot(played.robot_state, now.robot_state);
  if (!is_same_rollout) return std::nullopt;
  const auto before = WithinOf(result.reach, played, action);
  const auto after = WithinOf(result.reach, now, action);
  if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), IsSameObject)) {
    return std::nullopt;
  }
  RolloutResult kept = result;
  kept.final_world = now.world_state;
  for (world::ObjectState& object : kept.final_world.objects) {
    if (!IsWithin(result.reach, now, action, object)) continue;
    const world::ObjectState* final = result.final_world.Find(object.name);
    if (final == nullptr) return std::nullopt;  // what came from another computer may lack it
    object = *final;
  }
  return kept;
}

void KeptRollouts::Keep(const std::shared_ptr<const RolloutSetup>& setup,
                        const base::ActionCall& action, int index, const RolloutResult& result) {
  if (most_ == 0) return;
  const Key key{base::ToString(action), index};
  std::deque<Kept>& kept = kept_[key];
  const bool is_known = std::any_of(kept.begin(), kept.end(),
                                    [&](const Kept& other) { return other.setup == setup; });
  if (is_known) return;
  kept.push_back({setup, result});
  order_.push_back(key);
  if (order_.size() <= most_) return;
  const auto oldest = kept_.find(order_.front());
  oldest->second.pop_front();
  if (oldest->second.empty()) kept_.erase(oldest);
  order_.pop_front();
}

std::optional<RolloutResult> KeptRollouts::Find(const RolloutSetup& now,
                                                const base::ActionCall& action, int index) const {
  const auto known = kept_.find({base::ToString(action), index});
  if (known == kept_.end()) return std::nullopt;
  for (const Kept& kept : known->second) {
    if (auto same = ResultFrom(*kept.setup, kept.result, action, now)) return same;
  }
  return std::nullopt;
}

KeptRollouts::Shortened KeptRollouts::Shorten(const Assign& assign, const RolloutSetup& now,
                                              const base::ActionCall& action) const {
  std::map<int, RolloutResult> known;
  int first = assign.first_index, end = assign.first_index + assign.count;
  for (int i = first; i < end; ++i) {
    if (auto result = Find(now, action, i)) known.emplace(i, *std::move(result));
  }
  while (first < end && known.count(first) > 0) ++first;
  while (first < end && known.count(end - 1) > 0) --end;
  Shortened shortened{{}, assign};
  shortened.rest.first_index = first;
  shortened.rest.count = end - first;
  for (auto& [index, result] : known) {
    if (index >= first && index < end) continue;  // amid others: it is played with them
    shortened.known.push_back(
        {assign.worker, assign.assignment, assign.alternative, index, std::move(result)});
  }
  return shortened;
}

}  // namespace hires::imagination
