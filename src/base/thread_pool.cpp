#include "hires/base/thread_pool.h"

#include <utility>

#include "hires/base/check.h"

namespace hires::base {

ThreadPool::ThreadPool(int num_threads) {
  HIRES_CHECK(num_threads >= 1, "a pool without a thread does nothing");
  for (int i = 0; i < num_threads; ++i) threads_.emplace_back([this] { Run(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::Post(Work work) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_ending_) return;
    waiting_.push_back(std::move(work));
  }
  changed_.notify_one();
}

void ThreadPool::Run() {
  while (true) {
    Work work;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
      if (is_ending_) return;
      work = std::move(waiting_.front());
      waiting_.pop_front();
    }
    work();
  }
}

}  // namespace hires::base
