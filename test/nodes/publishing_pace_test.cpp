#include "nodes/blackboard/publishing_pace.h"

#include <gtest/gtest.h>
#include <ros/poll_manager.h>

#include <atomic>
#include <thread>

namespace hires_ros::publishing_pace_test {
namespace {

bool Never() { return false; }

TEST(PublishingPaceTest, HalfAQueueIsPublishedWithoutWaiting) {
  PublishingPace pace(20, &Never);
  for (int i = 0; i < 10; ++i) {
    pace.Await();
    pace.Count();
  }
  EXPECT_EQ(pace.queue_size(), 21u);
}

TEST(PublishingPaceTest, BetweenThreeRoundsNoMoreThanAQueueIsPublished) {
  constexpr int kQueue = 20;
  constexpr int kMessages = 5000;
  PublishingPace pace(kQueue, &Never);
  std::atomic<int> published{0};
  std::thread publisher([&] {
    for (int i = 0; i < kMessages; ++i) {
      pace.Await();
      ++published;
      pace.Count();
    }
  });
  for (int at_last = 0, before = 0; published < kMessages; before = at_last) {
    at_last = published;
    EXPECT_LE(at_last - before, kQueue);
    pace.OnRound();
  }
  publisher.join();
}

TEST(PublishingPaceTest, NobodyWaitsForRoundsThatWillNotCome) {
  std::atomic<bool> is_ending{false};
  PublishingPace pace(2, [&] { return is_ending.load(); });
  pace.Await();
  pace.Count();
  std::thread publisher([&] { pace.Await(); });
  is_ending = true;
  publisher.join();
}

TEST(PublishingPaceTest, RoundsOfRoscppMakeRoom) {
  PublishingPace pace(2, &Never);
  const RoscppRounds rounds(&pace);
  ros::PollManager::instance()->start();
  for (int i = 0; i < 5; ++i) {
    pace.Await();
    pace.Count();
  }
  ros::PollManager::instance()->shutdown();
}

}  // namespace
}  // namespace hires_ros::publishing_pace_test
