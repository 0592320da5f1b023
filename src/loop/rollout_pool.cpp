#include "loop/rollout_pool.h"

#include <utility>

namespace hires::loop {

using imagination::RolloutResult;
using imagination::RolloutSetup;

RolloutPool::Result RolloutPool::Play(std::shared_ptr<const RolloutSetup> setup,
                                      const base::ActionCall& action, int index,
                                      std::shared_ptr<const std::atomic<bool>> unwanted) {
  const auto task = std::make_shared<std::packaged_task<RolloutResult()>>(
      [setup = std::move(setup), action, index, unwanted = std::move(unwanted)] {
        if (*unwanted) return RolloutResult();
        const auto rollout =
            imagination::PlayRollout(*setup, action, index, {[&] { return unwanted->load(); }, {}});
        return rollout.value_or(RolloutResult());
      });
  Result result = task->get_future().share();
  threads_.Post([task] { (*task)(); });
  return result;
}

}  // namespace hires::loop
