#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/simulation/self_localisation.h"

namespace hires::simulation::wheel_odometry_test {
namespace {

using geometry::Pose2;

CasterParams Pr2Casters() {
  CasterParams params;
  for (const double x : {0.2246, -0.2246})
    for (const double y : {0.2246, -0.2246}) params.casters_B.emplace_back(x, y);
  return params;
}

/// Rolls a way of n equal steps.  @returns where the base is then, from where it began.
Pose2 RollOn(const Pose2& step, int n, WheelOdometry* odometry) {
  Pose2 X_OB;
  for (int i = 0; i < n; ++i) {
    odometry->Roll(step);
    X_OB = X_OB * step;
  }
  return X_OB;
}

/// To the left, of radius 1 m.
Pose2 Arc(double angle) { return {std::sin(angle), 1.0 - std::cos(angle), angle}; }

void ExpectNear(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(geometry::WrapToPi(a.yaw - b.yaw), 0.0, tolerance);
}

TEST(WheelOdometryTest, WheelsThatDoNotErrTellEveryMotionExactly) {
  for (const Pose2& step : {Pose2{0.01, 0.0, 0.0}, Pose2{-0.01, 0.0, 0.0}, Pose2{0.0, 0.01, 0.0},
                            Pose2{0.0, 0.0, 0.02}, Pose2{0.01, -0.004, -0.02}, Pose2{}}) {
    WheelOdometry odometry(Pr2Casters(), base::Rng(1));
    ExpectNear(odometry.X_OB(), Pose2{}, 0.0);
    const Pose2 X_OB = RollOn(step, 500, &odometry);
    ExpectNear(odometry.X_OB(), X_OB, 1e-9);
  }
}

TEST(WheelOdometryTest, ItDoesNotMatterInHowManyStepsAWayIsTold) {
  WheelOdometry often(Pr2Casters(), base::Rng(1)), seldom(Pr2Casters(), base::Rng(1));
  RollOn(Arc(0.001), 1000, &often);
  RollOn(Arc(0.02), 50, &seldom);
  ExpectNear(often.X_OB(), seldom.X_OB(), 1e-4);
}

TEST(WheelOdometryTest, LargerWheelsTellAllWaysShorterByOneFactor) {
  CasterParams params = Pr2Casters();
  params.wear = 0.02;
  WheelOdometry ahead(params, base::Rng(3)), turning(params, base::Rng(3));
  const double x = RollOn({0.01, 0.0, 0.0}, 1000, &ahead).x;
  const double yaw = 0.001 * 1000;
  RollOn({0.0, 0.0, 0.001}, 1000, &turning);
  const double factor = ahead.X_OB().x / x;
  EXPECT_GT(std::abs(factor - 1.0), 1e-4);
  EXPECT_LT(std::abs(factor - 1.0), 0.1);
  EXPECT_NEAR(turning.X_OB().yaw / yaw, factor, 1e-9);
}

/// Eight wheels' slips are independent: the mean of them strays by the root of way / 8.
TEST(WheelOdometryTest, SlipStraysByTheRootOfTheWayOverTheWheels) {
  CasterParams params = Pr2Casters();
  params.slip = 0.01;
  double squares = 0.0;
  constexpr int kDrives = 400;
  for (int seed = 0; seed < kDrives; ++seed) {
    WheelOdometry odometry(params, base::Rng(seed));
    const double x = RollOn({0.04, 0.0, 0.0}, 100, &odometry).x;  // 4 m
    // Along the way; across it, turns of the odometry bend the way.
    squares += std::pow(odometry.X_OB().x - x, 2);
  }
  const double expected = 0.01 * std::sqrt(4.0 / 8.0);
  EXPECT_NEAR(std::sqrt(squares / kDrives), expected, 0.12 * expected);  // 3 deviations of 400
}

TEST(WheelOdometryTest, CountsAreLostAtTheEndAlone) {
  CasterParams params = Pr2Casters();
  params.resolution = 0.01;
  WheelOdometry odometry(params, base::Rng(1));
  const Pose2 X_OB = RollOn({0.0007, 0.0, 0.0}, 3000, &odometry);
  ExpectNear(odometry.X_OB(), X_OB, 0.0101);
}

TEST(WheelOdometryTest, TheSameSeedGivesTheSameBits) {
  CasterParams params = Pr2Casters();
  params.wear = params.radius_error = 0.01;
  params.slip = params.scrub = 0.01;
  WheelOdometry a(params, base::Rng(5)), b(params, base::Rng(5)), c(params, base::Rng(6));
  for (WheelOdometry* odometry : {&a, &b, &c}) RollOn({0.01, 0.003, 0.01}, 100, odometry);
  EXPECT_EQ(a.X_OB().x, b.X_OB().x);
  EXPECT_EQ(a.X_OB().yaw, b.X_OB().yaw);
  EXPECT_NE(a.X_OB().x, c.X_OB().x);
}

}  // namespace
}  // namespace hires::simulation::wheel_odometry_test
