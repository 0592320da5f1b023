#include "localisation/way_comparison.h"

#include <gtest/gtest.h>

#include "hires/geometry/angles.h"

namespace hires::localisation::way_comparison_test {
namespace {

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

}  // namespace
}  // namespace hires::localisation::way_comparison_test
