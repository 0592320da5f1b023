#include "navigation/velocity_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::navigation::velocity_window_test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

const robot::MotionSet kFast{0.55, 1.0, 2.5, 3.2};
const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};

TEST(SampleAxisTest, SamplesIncludeBothEnds) {
  EXPECT_THAT(SampleAxis(1.0, 2.0, 3), ElementsAre(1.0, 1.5, 2.0));
  EXPECT_THAT(SampleAxis(-2.0, -1.0, 1), ElementsAre(-2.0, -1.0));
}

TEST(SampleAxisTest, ZeroIsPutBetweenSamplesOfEitherSign) {
  EXPECT_THAT(SampleAxis(-1.0, 2.0, 2), ElementsAre(-1.0, 0.0, 2.0));
  EXPECT_THAT(SampleAxis(-1.0, 1.0, 3), ElementsAre(-1.0, 0.0, 1.0));
}

TEST(SampleAxisTest, ARangeWithoutLengthIsOneSample) {
  EXPECT_THAT(SampleAxis(0.5, 0.5, 20), ElementsAre(0.5));
  EXPECT_THROW(SampleAxis(1.0, 0.5, 3), std::logic_error);
}

// Standing still, fast: forward {0, 0.125, 0.25}, sideways 10 values within 0.1 and 0, turning 20
// values within 0.32 and 0. Of forward 0 remain the two outer sideways values with every turn, and
// of the nine others only the two turns of 0.32.
TEST(ReachableVelocitiesTest, FromStandstillTooSlowOnesAreLeftOut) {
  const auto velocities = ReachableVelocities({}, kFast, {});
  EXPECT_EQ(velocities.size(), 2u * 11 * 21 + 2 * 21 + 9 * 2);
}

// At 0.55 m/s forward {0.3, 0.425, 0.55}; of the last only straight ahead is within the limit.
TEST(ReachableVelocitiesTest, AtFullSpeedDiagonalsBeyondTheLimitAreLeftOut) {
  const auto velocities = ReachableVelocities({}, kFast, {0.55, 0.0, 0.0});
  EXPECT_EQ(velocities.size(), 2u * 11 * 21 + 21);
}

TEST(ReachableVelocitiesTest, EachIsWithinTheLimitsAndWithinReach) {
  const base::Rng root(31);
  const DwaParams params;
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const robot::MotionSet limits = seed % 2 == 0 ? kFast : kSlow;
    const geometry::Twist2 V{rng.Uniform(0.0, limits.max_linear_velocity), rng.Uniform(-0.1, 0.1),
                             rng.Uniform(-1.0, 1.0)};
    const double linear = limits.max_linear_acceleration * params.control_period + 1e-9;
    const double angular = limits.max_angular_acceleration * params.control_period + 1e-9;
    const auto velocities = ReachableVelocities(params, limits, V);
    EXPECT_FALSE(velocities.empty());
    for (const geometry::Twist2& sample : velocities) {
      EXPECT_GE(sample.vx, 0.0);
      EXPECT_LE(std::hypot(sample.vx, sample.vy), limits.max_linear_velocity + 1e-3);
      EXPECT_LE(std::abs(sample.vy), params.max_lateral_velocity);
      EXPECT_LE(std::abs(sample.wz), limits.max_angular_velocity);
      EXPECT_LE(std::abs(sample.vx - V.vx), linear);
      EXPECT_LE(std::abs(sample.vy - V.vy), linear);
      EXPECT_LE(std::abs(sample.wz - V.wz), angular);
    }
  }
}

TEST(ReachableVelocitiesTest, TooFastABaseIsAskedBackWithinTheLimits) {
  for (const auto& sample : ReachableVelocities({}, kSlow, {0.55, 0.0, 0.0})) {
    EXPECT_LE(sample.vx, 0.30);
  }
  for (const auto& sample : ReachableVelocities({}, kSlow, {-0.5, 0.0, 0.0})) {
    EXPECT_EQ(sample.vx, 0.0);
  }
}

TEST(ReachableVelocitiesTest, TwoDrivenWheelsHaveFineSamplesHoweverBriskTheyAre) {
  DwaParams params;
  params.max_lateral_velocity = 0.0;
  for (const double acceleration : {0.5, 2.5, 5.0, 50.0}) {
    const robot::MotionSet limits{0.8, 1.5, acceleration, 2.0 * acceleration};
    std::set<double> speeds, turns;
    for (const auto& sample : ReachableVelocities(params, limits, {0.4, 0.0, 0.0})) {
      speeds.insert(sample.vx);
      turns.insert(sample.wz);
    }
    const auto widest = [](const std::set<double>& samples) {
      double widest = 0.0;
      for (auto a = samples.begin(), b = std::next(a); b != samples.end(); ++a, ++b)
        widest = std::max(widest, *b - *a);
      return widest;
    };
    EXPECT_LE(widest(speeds), 0.051) << acceleration;
    EXPECT_LE(widest(turns), 0.08) << acceleration;
    EXPECT_LE(speeds.size(), 20u);
    EXPECT_LE(turns.size(), 41u);
  }
}

TEST(RampedTest, GoesOnFromTheLastCommandWhileTheBaseFollows) {
  EXPECT_NEAR(Ramped(0.5, 0.4, 1.0, 0.1), 0.6, 1e-12);
  EXPECT_NEAR(Ramped(0.5, 0.0, 1.0, 0.1), 0.4, 1e-12) << "it did not follow";
  EXPECT_NEAR(Ramped(0.5, 0.6, 0.0, 0.1), 0.4, 1e-12);
  EXPECT_NEAR(Ramped(0.05, 0.06, 0.0, 0.1), 0.0, 1e-12);
}

TEST(ReachableVelocitiesTest, AnInertRobotCanStartAllTheSame) {
  const robot::MotionSet inert{0.5, 1.0, 0.2, 0.5};  // reaches 0.02 m/s and 0.05 rad/s at first
  EXPECT_FALSE(ReachableVelocities({}, inert, {}).empty());
}

TEST(PoseAfterTest, AQuarterCircleEndsBesideItsCentre) {
  const geometry::Pose2 X = PoseAfter({1.0, 2.0, 0.0}, {0.5, 0.0, 0.5}, geometry::kPi);
  EXPECT_NEAR(X.x, 2.0, 1e-12);  // radius 1, centre at (1, 3)
  EXPECT_NEAR(X.y, 3.0, 1e-12);
  EXPECT_NEAR(X.yaw, geometry::kPi / 2, 1e-12);
}

TEST(PoseAfterTest, AgreesWithManySmallSteps) {
  const base::Rng root(32);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const geometry::Twist2 V{rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-2, 2)};
    geometry::Pose2 X{rng.Uniform(-5, 5), rng.Uniform(-5, 5), rng.Uniform(-3, 3)};
    const geometry::Pose2 X_End = PoseAfter(X, V, 1.7);
    const int steps = 20000;
    const double dt = 1.7 / steps;
    for (int i = 0; i < steps; ++i) {
      const double c = std::cos(X.yaw + 0.5 * V.wz * dt), s = std::sin(X.yaw + 0.5 * V.wz * dt);
      X.x += (V.vx * c - V.vy * s) * dt;
      X.y += (V.vx * s + V.vy * c) * dt;
      X.yaw += V.wz * dt;
    }
    EXPECT_NEAR(X_End.x, X.x, 1e-7) << "seed " << seed;
    EXPECT_NEAR(X_End.y, X.y, 1e-7) << "seed " << seed;
    EXPECT_NEAR(geometry::WrapToPi(X_End.yaw - X.yaw), 0.0, 1e-7) << "seed " << seed;
  }
}

TEST(BrakedTest, SpeedFallsByTheAccelerationAndKeepsItsDirection) {
  const geometry::Twist2 V = Braked({0.3, 0.4, -1.0}, kFast, 0.1);
  EXPECT_NEAR(V.vx, 0.15, 1e-12);
  EXPECT_NEAR(V.vy, 0.20, 1e-12);
  EXPECT_NEAR(V.wz, -0.68, 1e-12);
}

TEST(BrakedTest, SpeedFallsByTheDecelerationWhereThereIsOne) {
  robot::MotionSet limits = kFast;
  limits.max_linear_deceleration = 0.5;
  limits.max_angular_deceleration = 0.8;
  const geometry::Twist2 braked = Braked({0.3, 0.0, -0.5}, limits, 0.1);
  EXPECT_DOUBLE_EQ(braked.vx, 0.25);
  EXPECT_DOUBLE_EQ(braked.wz, -0.42);
}

TEST(TimeToCoverTest, IsThePeriodAndHalfTheTimeOfBraking) {
  robot::MotionSet limits = kFast;
  limits.max_linear_deceleration = 0.5;
  // 0.5 m/s for 0.6 s is 0.05 m in the period and v^2 / (2 a) = 0.25 m.
  EXPECT_DOUBLE_EQ(TimeToCover({0.5, 0.0, 0.0}, limits, 0.1), 0.6);
  limits.max_angular_deceleration = 0.25;
  EXPECT_DOUBLE_EQ(TimeToCover({0.5, 0.0, 0.5}, limits, 0.1), 1.1);
}

TEST(ReachableVelocitiesTest, DecelerationBoundsWhatIsSlower) {
  const DwaParams params;
  robot::MotionSet limits = kFast;
  limits.max_linear_deceleration = 0.5;
  limits.max_angular_deceleration = 0.8;
  double slowest = 1.0, fastest = 0.0, least = 1.0, most = 0.0;
  for (const geometry::Twist2& V : ReachableVelocities(params, limits, {0.3, 0.0, 0.5})) {
    slowest = std::min(slowest, V.vx);
    fastest = std::max(fastest, V.vx);
    least = std::min(least, V.wz);
    most = std::max(most, V.wz);
  }
  EXPECT_DOUBLE_EQ(slowest, 0.3 - 0.5 * params.control_period);
  EXPECT_DOUBLE_EQ(fastest, std::min(0.55, 0.3 + 2.5 * params.control_period));
  EXPECT_DOUBLE_EQ(least, 0.5 - 0.8 * params.control_period);
  EXPECT_DOUBLE_EQ(most, 0.5 + 3.2 * params.control_period);
}

TEST(BrakedTest, ItEndsAtStandstill) {
  const geometry::Twist2 V = Braked({0.1, 0.1, 0.1}, kFast, 0.1);
  EXPECT_EQ(V.vx, 0.0);
  EXPECT_EQ(V.vy, 0.0);
  EXPECT_EQ(V.wz, 0.0);
}

}  // namespace
}  // namespace hires::navigation::velocity_window_test
