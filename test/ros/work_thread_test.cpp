#include "hires/ros/work_thread.h"

#include <gmock/gmock.h>

#include <future>
#include <vector>

#include "hires/ros/reaction_times.h"

namespace hires_ros {
namespace {

using ::testing::ElementsAre;

TEST(WorkThreadTest, WorksInTheOrderOfPosting) {
  std::vector<int> done;  // of the thread until `end` is ready
  std::promise<void> end;
  WorkThread thread;
  for (int i = 0; i < 3; ++i) thread.Post([&done, i] { done.push_back(i); });
  thread.Post([&] { end.set_value(); });
  end.get_future().wait();
  EXPECT_THAT(done, ElementsAre(0, 1, 2));
}

TEST(ReactionTimesTest, QuantilesAreThoseOfTheNearestRank) {
  ReactionTimes times;
  EXPECT_EQ(times.Quantile(0.99), 0.0);
  for (int i = 1; i <= 100; ++i) times.Add(i);
  EXPECT_EQ(times.Quantile(0.5), 50.0);
  EXPECT_EQ(times.Quantile(0.99), 99.0);
  EXPECT_EQ(times.Quantile(1.0), 100.0);
}

TEST(ReactionTimesTest, TheOldestGiveWay) {
  ReactionTimes times;
  for (int i = 0; i < 1000; ++i) times.Add(5.0);
  for (int i = 0; i < 1000; ++i) times.Add(1.0);
  EXPECT_EQ(times.size(), 1000u);
  EXPECT_EQ(times.Quantile(1.0), 1.0);
}

}  // namespace
}  // namespace hires_ros
