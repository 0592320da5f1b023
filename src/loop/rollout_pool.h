#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "hires/imagination/rollout.h"

namespace hires::loop {

/// Threads that play rollouts in the order in which they were asked for.
class RolloutPool {
 public:
  using Result = std::shared_future<imagination::RolloutResult>;
  explicit RolloutPool(int num_threads);
  ~RolloutPool();  ///< what was not begun is not played
  RolloutPool(const RolloutPool&) = delete;
  RolloutPool& operator=(const RolloutPool&) = delete;

  /// @param unwanted  asked while it is played; then the result is not valid and nobody may wait
  /// for it.
  Result Play(std::shared_ptr<const imagination::RolloutSetup> setup,
              const base::ActionCall& action, int index,
              std::shared_ptr<const std::atomic<bool>> unwanted);

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::packaged_task<imagination::RolloutResult()>> waiting_;  // guarded
  bool is_ending_{false};                                                 // guarded
  std::vector<std::thread> threads_;
};

}  // namespace hires::loop
