#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace hires::base {

/// Carries messages from any thread to the one that owns the receiving state, in order of posting.
template <typename T>
class Mailbox {
 public:
  void Post(T message) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      messages_.push_back(std::move(message));
    }
    arrived_.notify_one();
  }

  /// The oldest message, or nothing if there is none now.
  std::optional<T> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return TakeLocked();
  }

  /// The oldest message, waiting for one at most `timeout`.
  std::optional<T> WaitAndTake(std::chrono::duration<double> timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    arrived_.wait_for(lock, timeout, [this] { return !messages_.empty(); });
    return TakeLocked();
  }

 private:
  std::optional<T> TakeLocked() {
    if (messages_.empty()) return std::nullopt;
    T message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<T> messages_;
};

}  // namespace hires::base
