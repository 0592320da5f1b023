#include "planning/search/search_limits.h"

#include <gtest/gtest.h>

namespace hires::planning::search_limits_test {
namespace {

Progress WithBytes(std::size_t bytes) {
  Progress progress;
  progress.bytes = bytes;
  return progress;
}

TEST(SearchLimitsTest, ItIsTimeToAskEvery256Expansions) {
  const PlanRequest request;
  SearchLimits limits(request);
  int questions = 0;
  for (int i = 0; i < 1024; ++i) questions += limits.CountExpansion() ? 1 : 0;
  EXPECT_EQ(questions, 4);
  EXPECT_EQ(limits.expansions(), 1024u);
}

TEST(SearchLimitsTest, WithoutALimitThereIsAPlanOrNone) {
  const PlanRequest request;
  SearchLimits limits(request);
  EXPECT_FALSE(limits.Ask(WithBytes(1)));
  EXPECT_FALSE(limits.IsTooDeep(request.max_depth - 1));
  EXPECT_FALSE(limits.IsTooDear(1e300));
  EXPECT_TRUE(limits.none_reached());
  EXPECT_EQ(limits.Outcome(true), PlanOutcome::kFound);
  EXPECT_EQ(limits.Outcome(false), PlanOutcome::kNoPlan);
}

TEST(SearchLimitsTest, APathGivenUpLeavesNoPlanUnproven) {
  PlanRequest request;
  request.max_depth = 3;
  request.max_cost = 2.0;
  SearchLimits limits(request);
  EXPECT_FALSE(limits.IsTooDear(2.0));
  EXPECT_TRUE(limits.IsTooDear(2.5));
  EXPECT_FALSE(limits.none_reached());
  EXPECT_EQ(limits.Outcome(false), PlanOutcome::kLimitCost);
  EXPECT_TRUE(limits.IsTooDeep(3));
  EXPECT_EQ(limits.Outcome(false), PlanOutcome::kLimitDepth);
  EXPECT_EQ(limits.Outcome(true), PlanOutcome::kFound);
}

TEST(SearchLimitsTest, TheFirstReasonToStopStays) {
  PlanRequest request;
  int asked = 0;
  request.stop = [&](const Progress&) { return ++asked == 1 ? Stop::kMemory : Stop::kContinue; };
  SearchLimits limits(request);
  EXPECT_TRUE(limits.Ask(WithBytes(7)));
  EXPECT_TRUE(limits.Ask(WithBytes(5)));
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(limits.stopped());
  EXPECT_EQ(limits.most_bytes(), 7u);
  EXPECT_EQ(limits.Outcome(true), PlanOutcome::kLimitMemory);
}

}  // namespace
}  // namespace hires::planning::search_limits_test
