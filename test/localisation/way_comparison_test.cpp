#include "localisation/way_comparison.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::localisation::way_comparison_test {
namespace {

/// About `mean`, each with an error of its own.
ExplainedShares SharesAbout(double mean, std::size_t count, std::uint64_t seed) {
  base::Rng rng(seed);
  ExplainedShares shares;
  for (std::size_t i = 0; i < count; ++i) shares.push_back(rng.Normal(mean, 0.005));
  return shares;
}

/// Without some, as a share of all.
ExplainedShares Without(double share, ExplainedShares shares) {
  base::Rng rng(3);
  for (std::optional<double>& explained : shares)
    if (rng.Uniform(0.0, 1.0) < share) explained.reset();
  return shares;
}

TimedPath TurnOnTheSpot(double yaw) {
  TimedPath path;
  for (int i = 0; i < 50; ++i)
    path.push_back({0.2 * i, {3.0, 2.0, geometry::WrapToPi(yaw + 0.12 * i)}});
  return path;
}

TEST(IsSameWayTest, AnotherHeadingIsAnotherWay) {
  const TimedPath here = TurnOnTheSpot(1.0);
  EXPECT_TRUE(IsSameWay(here, here));
  EXPECT_TRUE(IsSameWay(here, TurnOnTheSpot(1.3)));
  EXPECT_TRUE(IsSameWay(here, TurnOnTheSpot(0.7)));
  EXPECT_FALSE(IsSameWay(here, TurnOnTheSpot(1.0 + geometry::kPi)));
  EXPECT_FALSE(IsSameWay(here, TurnOnTheSpot(1.0 - geometry::kPi / 2)));
}

TEST(IsSameWayTest, WaysThatNeverSpeakOfTheSameScanAreNotTheSame) {
  TimedPath later = TurnOnTheSpot(1.0);
  for (TimedPose& pose : later) pose.time += 0.1;
  EXPECT_FALSE(IsSameWay(TurnOnTheSpot(1.0), later));
}

TEST(PosesApartTest, ARobotThatStandsHasOneViewAndOneThatMovesAnother) {
  TimedPath path;
  for (int i = 0; i < 100; ++i) path.push_back({0.2 * i, {0.001 * (i % 7), 0.0, 0.0}});
  for (int i = 0; i <= 20; ++i) path.push_back({20.0 + 0.2 * i, {0.1 * i, 0.0, 0.0}});
  for (int i = 0; i <= 20; ++i) path.push_back({30.0 + 0.2 * i, {2.0, 0.0, 0.1 * i}});
  const TimedPath apart = PosesApart(path, 0.49, 0.49);
  ASSERT_EQ(apart.size(), 1u + 4u + 4u);
  EXPECT_EQ(apart[1].X_MB.x, 0.5);
  EXPECT_EQ(apart[4].X_MB.x, 2.0);
  EXPECT_EQ(apart[8].X_MB.yaw, 2.0);
  EXPECT_TRUE(PosesApart({}, 0.5, 0.5).empty());
}

TEST(IsSignificantlyBetterTest, ADifferenceThatIsSmallIsNoneHoweverSteadyItIs) {
  const ExplainedShares a = SharesAbout(0.95, 200, 1);
  EXPECT_FALSE(IsSignificantlyBetter(a, SharesAbout(0.947, 200, 2)));
  EXPECT_TRUE(IsSignificantlyBetter(a, SharesAbout(0.94, 200, 2)));
  EXPECT_FALSE(IsSignificantlyBetter(SharesAbout(0.94, 200, 2), a));
}

TEST(IsSignificantlyBetterTest, AFewScansTellNothing) {
  EXPECT_FALSE(IsSignificantlyBetter(SharesAbout(0.95, 9, 1), SharesAbout(0.5, 9, 2)));
  EXPECT_TRUE(IsSignificantlyBetter(SharesAbout(0.95, 10, 1), SharesAbout(0.5, 10, 2)));
}

TEST(IsSignificantlyBetterTest, AMissingPoseIsNoBeamThatIsNotExplained) {
  const ExplainedShares a = SharesAbout(0.95, 200, 1), b = SharesAbout(0.95, 200, 2);
  EXPECT_FALSE(IsSignificantlyBetter(a, Without(0.3, b)));
  EXPECT_FALSE(IsSignificantlyBetter(Without(0.3, a), b));
  EXPECT_TRUE(IsSignificantlyBetter(Without(0.3, a), SharesAbout(0.94, 200, 2)));
}

TEST(IsSignificantlyBetterTest, AWayThatLacksMoreThanHalfOfThePosesIsWorse) {
  const ExplainedShares a = SharesAbout(0.95, 200, 1), b = SharesAbout(0.95, 200, 2);
  EXPECT_TRUE(IsSignificantlyBetter(a, Without(0.6, b)));
  EXPECT_FALSE(IsSignificantlyBetter(Without(0.6, b), a));
  EXPECT_FALSE(IsSignificantlyBetter(Without(0.6, a), Without(0.6, b)));
}

TEST(IsSignificantlyBetterTest, MorePosesAndMoreExplainedBeamsOfTheOtherDecideNothing) {
  const ExplainedShares whole = SharesAbout(0.93, 200, 1);
  const ExplainedShares part = Without(0.6, SharesAbout(0.95, 200, 2));
  EXPECT_FALSE(IsSignificantlyBetter(whole, part));
  EXPECT_FALSE(IsSignificantlyBetter(part, whole));
}

TEST(IsBetterTest, ManyMorePosesComeBeforeMoreExplainedBeams) {
  const ExplainedShares more = SharesAbout(0.95, 200, 1), fewer = SharesAbout(0.94, 200, 2);
  EXPECT_TRUE(IsBetter(more, fewer));
  EXPECT_TRUE(IsBetter(Without(0.3, more), fewer));
  EXPECT_FALSE(IsBetter(fewer, Without(0.3, more)));
  EXPECT_FALSE(IsBetter(Without(0.6, more), fewer));
  EXPECT_TRUE(IsBetter(fewer, Without(0.6, more)));
  EXPECT_FALSE(IsBetter(more, more));
}

TEST(MeanExplainedTest, ScansWithoutAPoseOfOneAreLeftOut) {
  const MeanShares mean = MeanExplained({0.9, {}, 0.7, 0.1}, {0.8, 0.5, 0.6, {}});
  EXPECT_NEAR(mean.a, 0.8, 1e-12);
  EXPECT_NEAR(mean.b, 0.7, 1e-12);
  EXPECT_EQ(MeanExplained({{}, 0.5}, {0.5, {}}).a, 0.0);
}

}  // namespace
}  // namespace hires::localisation::way_comparison_test
