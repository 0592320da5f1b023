#include "loop/rollout_pool.h"

#include <utility>

namespace hires::loop {

using imagination::RolloutResult;
using imagination::RolloutSetup;

RolloutPool::RolloutPool(int num_threads) {
  for (int i = 0; i < num_threads; ++i) threads_.emplace_back([this] { Run(); });
}

RolloutPool::~RolloutPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

RolloutPool::Result RolloutPool::Play(std::shared_ptr<const RolloutSetup> setup,
                                      const base::ActionCall& action, int index,
                                      std::shared_ptr<const std::atomic<bool>> unwanted) {
  std::packaged_task<RolloutResult()> task(
      [setup = std::move(setup), action, index, unwanted = std::move(unwanted)] {
        if (*unwanted) return RolloutResult();
        const auto rollout =
            imagination::PlayRollout(*setup, action, index, {[&] { return unwanted->load(); }, {}});
        return rollout.value_or(RolloutResult());
      });
  Result result = task.get_future().share();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(task));
  }
  changed_.notify_one();
  return result;
}

void RolloutPool::Run() {
  while (true) {
    std::packaged_task<RolloutResult()> task;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
      if (is_ending_) return;
      task = std::move(waiting_.front());
      waiting_.pop_front();
    }
    task();
  }
}

}  // namespace hires::loop
