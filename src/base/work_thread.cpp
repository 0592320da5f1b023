#include "hires/base/work_thread.h"

#include <utility>

namespace hires::base {

WorkThread::WorkThread() : thread_([this] { Run(); }) {}

WorkThread::~WorkThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void WorkThread::Post(Work work) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_ending_) return;
    waiting_.push_back(std::move(work));
  }
  changed_.notify_one();
}

void WorkThread::Run() {
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
