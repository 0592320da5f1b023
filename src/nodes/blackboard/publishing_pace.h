#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>

namespace hires_ros {

/// Keeps a thread that publishes from outrunning roscpp's own thread, which hands messages to
/// sockets. What was published between two of its rounds is queued at once, and beyond the queue's
/// size the oldest messages are dropped, even where the subscriber reads at once and only that
/// thread was late. With a pause after half a queue, a message is dropped only for a subscriber
/// whose socket is full.
class PublishingPace {
 public:
  /// @param queue_size  Messages kept for a subscriber that is slow.
  /// @param is_ending   Asked while it waits: whether no more rounds will come.
  PublishingPace(int queue_size, std::function<bool()> is_ending);

  /// With what size to advertise: a new subscriber's snapshot must find room beside the others.
  std::uint32_t queue_size() const { return static_cast<std::uint32_t>(2 * limit_ + 1); }

  /// Before one message of a topic, or of several topics: waits until there is room.
  void Await();
  /// One message was published, or one of each of several topics.
  void Count();
  /// The other thread: all that was published before the last round but one is at the sockets.
  void OnRound();

 private:
  const int limit_;
  const std::function<bool()> is_ending_;
  std::mutex mutex_;
  std::condition_variable round_;
  int count_{0};  ///< since the last round
};

/// As long as it lives, each round of roscpp's thread is told to a pace.
class RoscppRounds {
 public:
  explicit RoscppRounds(PublishingPace* pace);
  ~RoscppRounds();
  RoscppRounds(const RoscppRounds&) = delete;
  RoscppRounds& operator=(const RoscppRounds&) = delete;

 private:
  boost::signals2::connection connection_;
};

}  // namespace hires_ros
