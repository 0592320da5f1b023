#include "nodes/localisation/pose_keeper.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hires_ros::pose_keeper_test {
namespace {

using hires::geometry::Pose2;

constexpr double kMaxSpeed = 2.0;  // [m/s]

KeptPlace Kept() { return {{5.0, 6.0, M_PI / 2}, {0.01, 0.01, 0.001}, {1.0, 2.0, 0.0}, 100.0}; }

TEST(PlaceNowTest, AddsWhatOdometryDroveSince) {
  const auto X_MB = PlaceNow(Kept(), {2.0, 2.0, 0.5}, 101.0, kMaxSpeed);
  ASSERT_TRUE(X_MB);
  EXPECT_NEAR(X_MB->x, 5.0, 1e-12);
  EXPECT_NEAR(X_MB->y, 7.0, 1e-12);
  EXPECT_NEAR(X_MB->yaw, M_PI / 2 + 0.5, 1e-12);
}

TEST(PlaceNowTest, KnowsNothingWhereClockOrOdometryBeganAgain) {
  EXPECT_FALSE(PlaceNow(Kept(), {1.0, 2.0, 0.0}, 99.0, kMaxSpeed));
  EXPECT_FALSE(PlaceNow(Kept(), {4.0, 2.0, 0.0}, 101.0, kMaxSpeed));
  EXPECT_TRUE(PlaceNow(Kept(), {4.0, 2.0, 0.0}, 102.0, kMaxSpeed));
  EXPECT_FALSE(PlaceNow(Kept(), {std::nan(""), 2.0, 0.0}, 101.0, kMaxSpeed));
}

}  // namespace
}  // namespace hires_ros::pose_keeper_test
