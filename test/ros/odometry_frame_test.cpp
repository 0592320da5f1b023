#include "hires/ros/odometry_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hires_ros {
namespace {

using hires::geometry::Pose2;

OdometryReading At(const Pose2& X_RB) { return {X_RB, {0.3, 0.0, 0.1}}; }

void ExpectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.yaw, b.yaw, 1e-12);
}

geometry_msgs::TransformStamped Transform(const std::string& parent, const std::string& child) {
  return MakeTransform(parent, child, hires::geometry::Lift({1.0, 2.0, 0.5}), ros::Time(1.0));
}

TEST(PoseBetweenTest, TellsOfTheTwoFramesAlone) {
  const auto X_MO = PoseBetween(Transform("/map", "odom_combined"), "map", "odom_combined");
  ASSERT_TRUE(X_MO);
  ExpectNear(*X_MO, {1.0, 2.0, 0.5});
  EXPECT_FALSE(PoseBetween(Transform("map", "odom"), "map", "odom_combined"));
  EXPECT_FALSE(PoseBetween(Transform("odom_combined", "map"), "map", "odom_combined"));
}

TEST(PoseBetweenTest, WhatIsNoNumberTellsNothing) {
  auto transform = Transform("map", "odom");
  transform.transform.translation.x = std::nan("");
  EXPECT_FALSE(PoseBetween(transform, "map", "odom"));
}

TEST(OdometryFrameTest, AReadingInTheFrameStaysAsItIs) {
  OdometryFrame frame("odom_combined");
  for (const char* id : {"odom_combined", "/odom_combined"}) {
    const auto reading = frame.Take(1.0, id, At({1.0, 2.0, 0.3}));
    ASSERT_TRUE(reading);
    EXPECT_EQ(reading->X_OB.x, 1.0);  // not even rounded
    EXPECT_EQ(reading->V_B.vx, 0.3);
  }
}

TEST(OdometryFrameTest, WheelsInAFrameOfTheirOwnTellNoPlaceUntilTfDoes) {
  OdometryFrame frame("odom_combined");
  EXPECT_FALSE(frame.Take(1.0, "odom", At({})));
  frame.OnTransform(1.0, {2.0, 0.0, M_PI / 2});
  const auto reading = frame.Take(1.01, "odom", At({0.1, 0.0, 0.0}));
  ASSERT_TRUE(reading);
  ExpectNear(reading->X_OB, {2.0, 0.1, M_PI / 2});  // the wheels say how it went on
  EXPECT_EQ(reading->V_B.wz, 0.1);
}

TEST(OdometryFrameTest, ALateTransformIsHeldAgainstTheReadingOfItsTime) {
  OdometryFrame frame("odom_combined");
  frame.Take(1.00, "odom", At({0.0, 0.0, 0.0}));
  frame.Take(1.01, "odom", At({0.5, 0.0, 0.0}));
  frame.OnTransform(1.0, {10.0, 0.0, 0.0});
  ExpectNear(frame.Take(1.02, "odom", At({0.6, 0.0, 0.0}))->X_OB, {10.6, 0.0, 0.0});
}

TEST(OdometryFrameTest, ATransformAheadOfTheWheelsIsHeldAgainstThemWhenTheyCome) {
  OdometryFrame frame("odom_combined");
  frame.Take(1.00, "odom", At({0.0, 0.0, 0.0}));
  frame.OnTransform(1.05, {10.0, 0.0, 0.0});
  ExpectNear(frame.Take(1.05, "odom", At({0.5, 0.0, 0.0}))->X_OB, {10.0, 0.0, 0.0});
  ExpectNear(frame.Take(1.06, "odom", At({0.6, 0.0, 0.0}))->X_OB, {10.1, 0.0, 0.0});
}

TEST(OdometryFrameTest, ATransformOfAnotherTimeTellsNothing) {
  OdometryFrame frame("odom_combined");
  frame.OnTransform(1.0, {10.0, 0.0, 0.0});
  EXPECT_FALSE(frame.Take(1.2, "odom", At({})));
}

TEST(OdometryFrameTest, AClockThatBeginsAnewIsFollowed) {
  OdometryFrame frame("odom_combined");
  frame.Take(100.0, "odom", At({5.0, 0.0, 0.0}));
  frame.OnTransform(100.0, {10.0, 0.0, 0.0});
  frame.Take(1.0, "odom", At({0.0, 0.0, 0.0}));
  frame.OnTransform(1.0, {3.0, 0.0, 0.0});
  ExpectNear(frame.Take(1.1, "odom", At({0.5, 0.0, 0.0}))->X_OB, {3.5, 0.0, 0.0});
}

}  // namespace
}  // namespace hires_ros
