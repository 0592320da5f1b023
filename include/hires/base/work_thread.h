#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace hires::base {

/// One thread that does what it is given, in that order: calls that may block (services), so that
/// the caller never does.
class WorkThread {
 public:
  using Work = std::function<void()>;

  WorkThread();
  ~WorkThread();  ///< Forgets what waits; waits for what is being done.
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;

  void Post(Work work);  ///< `work` must not throw.

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Work> waiting_;  // guarded
  bool is_ending_{false};     // guarded
  std::thread thread_;
};

}  // namespace hires::base
