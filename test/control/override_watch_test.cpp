#include "hires/control/override_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hires::control::override_watch_test {
namespace {

using geometry::Twist2;

const OverrideParams kParams{1.0, 0.15, 0.35};

TEST(OverrideWatchTest, ABaseThatFollowsIsNotOverridden) {
  OverrideWatch watch(kParams);
  watch.Command({0.5, 0.0, 0.5});
  for (double t = 0.0; t < 5.0; t += 0.1) watch.See(t, {0.4, 0.0, 0.3});
  EXPECT_FALSE(watch.is_overridden());
}

TEST(OverrideWatchTest, ARampIsNoOverride) {
  OverrideWatch watch(kParams);
  watch.Command({0.55, 0.0, 0.0});
  for (double t = 0.0; t < 3.0; t += 0.05) {
    watch.See(t, {std::min(0.55, 1.4 * t), 0.0, 0.0});
    EXPECT_FALSE(watch.is_overridden()) << t;
  }
}

TEST(OverrideWatchTest, OtherMotionForASecondIsOneUntilTheBaseFollowsAgain) {
  for (const Twist2& other :
       {Twist2{-0.3, 0.0, 0.0}, Twist2{0.3, 0.3, 0.0}, Twist2{0.3, 0.0, 0.5}}) {
    OverrideWatch watch(kParams);
    watch.Command({0.3, 0.0, 0.0});
    watch.See(10.0, other);
    watch.See(11.0, other);
    EXPECT_FALSE(watch.is_overridden());
    watch.See(11.05, other);
    EXPECT_TRUE(watch.is_overridden());
    watch.See(11.1, {0.3, 0.0, 0.0});
    EXPECT_FALSE(watch.is_overridden());
  }
}

TEST(OverrideWatchTest, WhereNobodyDrivesForUsNothingIsOverridden) {
  OverrideWatch watch(kParams);
  watch.See(0.0, {0.5, 0.0, 0.0});
  watch.See(5.0, {0.5, 0.0, 0.0});
  EXPECT_FALSE(watch.is_overridden());
  watch.Command({});
  watch.See(5.0, {0.5, 0.0, 0.0});
  watch.See(7.0, {0.5, 0.0, 0.0});
  EXPECT_TRUE(watch.is_overridden());
  watch.Forget();
  EXPECT_FALSE(watch.is_overridden());
  watch.See(9.0, {0.5, 0.0, 0.0});
  EXPECT_FALSE(watch.is_overridden());
}

TEST(OverrideWatchTest, AClockThatBeginsAnewBeginsTheSecondAnew) {
  OverrideWatch watch(kParams);
  watch.Command({});
  watch.See(100.0, {0.5, 0.0, 0.0});
  watch.See(1.0, {0.5, 0.0, 0.0});
  EXPECT_FALSE(watch.is_overridden());
  watch.See(2.1, {0.5, 0.0, 0.0});
  EXPECT_TRUE(watch.is_overridden());
}

}  // namespace
}  // namespace hires::control::override_watch_test
