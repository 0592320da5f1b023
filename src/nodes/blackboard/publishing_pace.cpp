#include "nodes/blackboard/publishing_pace.h"

#include <ros/poll_manager.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace hires_ros {
namespace {

constexpr std::chrono::milliseconds kAskWhetherEnding{100};

}  // namespace

PublishingPace::PublishingPace(int queue_size, std::function<bool()> is_ending)
    : limit_(std::max(1, queue_size / 2)), is_ending_(std::move(is_ending)) {}

void PublishingPace::Await() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (count_ >= limit_ && !is_ending_()) round_.wait_for(lock, kAskWhetherEnding);
}

void PublishingPace::Count() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++count_;
}

void PublishingPace::OnRound() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    count_ = 0;
  }
  round_.notify_all();
}

// roscpp's thread calls first what was added first: its own queues come before this.
RoscppRounds::RoscppRounds(PublishingPace* pace)
    : connection_(
          ros::PollManager::instance()->addPollThreadListener([pace] { pace->OnRound(); })) {}

RoscppRounds::~RoscppRounds() {
  ros::PollManager::instance()->removePollThreadListener(connection_);
}

}  // namespace hires_ros
