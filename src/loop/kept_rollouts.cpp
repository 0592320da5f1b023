#include "loop/kept_rollouts.h"

namespace hires::loop {

using imagination::ReachedRollout;
using imagination::RolloutSetup;

void KeptRollouts::Keep(const std::shared_ptr<const RolloutSetup>& setup,
                        const base::ActionCall& action, int index, const ReachedRollout& rollout) {
  kept_[{base::ToString(action), index}].push_back({setup, rollout});
}

std::optional<ReachedRollout> KeptRollouts::Find(const RolloutSetup& now,
                                                 const base::ActionCall& action, int index) const {
  const auto known = kept_.find({base::ToString(action), index});
  if (known == kept_.end()) return std::nullopt;
  for (const Kept& kept : known->second) {
    if (auto same = imagination::ResultFrom(*kept.setup, kept.rollout, action, now)) return same;
  }
  return std::nullopt;
}

}  // namespace hires::loop
