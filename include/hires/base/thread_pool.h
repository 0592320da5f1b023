#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace hires::base {

/// Threads that do what they are given, each work on one of them, begun in the order in which works
/// came. With one thread it is done in that order, and whoever gives calls that may block
/// (services) does not wait for them.
class ThreadPool {
 public:
  using Work = std::function<void()>;

  /// @pre num_threads >= 1.
  explicit ThreadPool(int num_threads = 1);
  ~ThreadPool();  ///< Forgets what waits; waits for what is being done.
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  void Post(Work work);  ///< `work` must not throw.

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Work> waiting_;  // guarded
  bool is_ending_{false};     // guarded
  std::vector<std::thread> threads_;
};

}  // namespace hires::base
