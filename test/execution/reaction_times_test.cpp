#include "hires/execution/reaction_times.h"

#include <gtest/gtest.h>

namespace hires::execution::reaction_times_test {
namespace {

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
}  // namespace hires::execution::reaction_times_test
