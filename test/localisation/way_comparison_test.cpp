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
  EXPECT_FALSE(IsSignificantlyBetter(a, SharesAbout(0.945, 200, 2)));
  EXPECT_TRUE(IsSignificantlyBetter(a, SharesAbout(0.93, 200, 2)));
  EXPECT_FALSE(IsSignificantlyBetter(SharesAbout(0.93, 200, 2), a));
}

TEST(IsSignificantlyBetterTest, AFewScansTellNothing) {
  EXPECT_FALSE(IsSignificantlyBetter(SharesAbout(0.95, 9, 1), SharesAbout(0.5, 9, 2)));
  EXPECT_TRUE(IsSignificantlyBetter(SharesAbout(0.95, 10, 1), SharesAbout(0.5, 10, 2)));
}

}  // namespace
}  // namespace hires::localisation::way_comparison_test
