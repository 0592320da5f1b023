#pragma once

#include <atomic>
#include <future>
#include <memory>

#include "hires/base/thread_pool.h"
#include "hires/imagination/rollout.h"

namespace hires::loop {

/// Threads that play rollouts in the order in which they were asked for. What was not begun when it
/// ends is not played.
class RolloutPool {
 public:
  using Result = std::shared_future<imagination::RolloutResult>;
  explicit RolloutPool(int num_threads) : threads_(num_threads) {}

  /// @param unwanted  asked while it is played; then the result is not valid and nobody may wait
  /// for it.
  Result Play(std::shared_ptr<const imagination::RolloutSetup> setup,
              const base::ActionCall& action, int index,
              std::shared_ptr<const std::atomic<bool>> unwanted);

 private:
  base::ThreadPool threads_;
};

}  // namespace hires::loop
