// The planar oracle against closed forms, and against values of two other programs.
#include "support/planar_oracle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/physics/closed_forms.h"

namespace hires::physics::planar_oracle_test {
namespace {

using namespace test_support;  // NOLINT

constexpr double kGravity = 9.81;
constexpr double kMostSlide = 0.1;  // [m]
constexpr double kNoSlip = 50.0;    // friction

double CylinderGyration(double radius, double height) {
  return (3.0 * radius * radius + height * height) / 12.0;
}

/// A mill as the closed forms know it, and as the oracle does.
const UprightCylinder kMill{0.037, 0.274, 0.140};
const PlanarBody kPlanarMill{0.037, 0.137, CylinderGyration(0.037, 0.274)};

double StopLimit(const PlanarBody& body, double friction, double time_step,
                 PlanarResult* beyond = nullptr) {
  return PlanarLimit(body, friction, kMostSlide, SuddenStop, 0.1, 2.0, time_step, beyond);
}

TEST(PlanarOracleTest, SuddenStopWithoutSlipIsTheClosedForm) {
  const PlanarBody tall{0.05, 0.3, (0.1 * 0.1 + 0.6 * 0.6) / 12.0};
  const double expected = SuddenStopTopplingSpeed(tall.b, tall.c, tall.gyration, kGravity);
  EXPECT_NEAR(expected, 0.3336, 1e-4);
  PlanarResult beyond;
  EXPECT_NEAR(StopLimit(tall, kNoSlip, 1e-4, &beyond), expected, 0.001 * expected);
  EXPECT_EQ(beyond.verdict, PlanarVerdict::kTips);
  EXPECT_NEAR(StopLimit(tall, kNoSlip, 1e-3), expected, 0.005 * expected);
}

TEST(PlanarOracleTest, SlideDistanceIsSpeedSquaredOverTwiceFrictionTimesGravity) {
  const PlanarBody puck{0.04, 0.015, CylinderGyration(0.04, 0.03)};
  for (const double friction : {0.02, 0.1, 0.3}) {
    PlanarResult beyond;
    const double expected = std::sqrt(2.0 * friction * kGravity * kMostSlide);
    EXPECT_NEAR(StopLimit(puck, friction, 1e-4, &beyond), expected, 0.001 * expected);
    EXPECT_EQ(beyond.verdict, PlanarVerdict::kSlides);
    const PlanarResult shorter =
        PlanarOracle(puck, friction, SuddenStop(0.5 * expected), 1e-4).Run(kMostSlide);
    EXPECT_NEAR(shorter.last_slide, kMostSlide / 4.0, 1e-4);
    EXPECT_NEAR(shorter.max_tilt, 0.0, 1e-12);
  }
}

TEST(PlanarOracleTest, TippingBeginsAtGravityTimesSupportOverHeight) {
  const double onset = TippingAcceleration(kMill, kGravity);
  const auto tilt = [&](double acceleration) {
    PlanarOracle oracle(kPlanarMill, kNoSlip, Pulse(acceleration, 2.0), 1e-3);
    for (int i = 1; i <= 1000; ++i) oracle.Step(i * 1e-3);
    return oracle.tilt();
  };
  EXPECT_NEAR(tilt(0.999 * onset), 0.0, 1e-12);
  EXPECT_LT(tilt(1.001 * onset), -0.01);  // the plate is pulled forward below it
}

TEST(PlanarOracleTest, SlidingBeginsAtFrictionTimesGravity) {
  const double friction = 0.2, onset = SlidingAcceleration(friction, kGravity);
  const auto slide = [&](double acceleration) {
    PlanarOracle oracle(kPlanarMill, friction, Pulse(acceleration, 2.0), 1e-3);
    for (int i = 1; i <= 1000; ++i) oracle.Step(i * 1e-3);
    return oracle.Slide();
  };
  EXPECT_NEAR(slide(0.999 * onset), 0.0, 1e-12);
  EXPECT_NEAR(slide(1.1 * onset), -0.5 * 0.1 * onset, 1e-3);
}

TEST(PlanarOracleTest, OverturningPulseIsTheClosedForm) {
  for (const double x : {1.2, 2.0, 5.0}) {
    const double acceleration = x * TippingAcceleration(kMill, kGravity);
    const double expected = OverturningPulseDuration(kMill, acceleration, kGravity);
    const double found = PlanarLimit(
        kPlanarMill, kNoSlip, kMostSlide,
        [&](double duration) { return Pulse(acceleration, duration); }, 0.5 * expected,
        1.5 * expected, 1e-4);
    EXPECT_NEAR(found, expected, 0.003 * expected) << "x = " << x;
  }
}

/// b/c < mu: the body leans on its front edge and slides on;.
TEST(PlanarOracleTest, LeaningEdgeOfASlidingCanCarriesMoreThanItsWeight) {
  const double b = 0.033, c = 0.1, mu = 0.4, gyration = CylinderGyration(b, 0.2);
  // N = g / (1 - b (mu c - b) / k^2) = 10.48 N per kg, more than g.
  const double force = kGravity / (1.0 - b * (mu * c - b) / gyration);
  EXPECT_NEAR(force, 10.4815, 0.001);
  PlanarOracle oracle({b, c, gyration}, mu, SuddenStop(0.5), 1e-4);
  oracle.Step(1e-4);
  // tilt rate = N (mu c - b) / k^2 dt
  EXPECT_NEAR(oracle.tilt(), force * (mu * c - b) / gyration * 1e-8, 1e-12);
}

TEST(PlanarOracleTest, SlippingAndTippingMeetsValuesOfAnotherPlanarProgram) {
  const struct {
    const char* name;
    PlanarBody body;
    double friction, expected;
  } cases[] = {
      {"can", {0.033, 0.1, CylinderGyration(0.033, 0.2)}, 0.4, 0.532},
      {"vessel", {0.045, 0.13, CylinderGyration(0.045, 0.3)}, 0.5, 0.598},
      {"cone", {0.05, 0.1, 3.0 / 80.0 * (4.0 * 0.05 * 0.05 + 0.4 * 0.4)}, 0.9, 0.738},
  };
  // Their bracket is 0.004 to 0.006 m/s wide.
  for (const auto& one : cases) {
    PlanarResult beyond;
    EXPECT_NEAR(StopLimit(one.body, one.friction, 1e-4, &beyond), one.expected, 0.006) << one.name;
    EXPECT_NEAR(StopLimit(one.body, one.friction, 1e-3), one.expected, 0.006) << one.name;
    EXPECT_EQ(beyond.verdict, PlanarVerdict::kTips) << one.name;
  }
}

TEST(PlanarOracleTest, EveryStepSatisfiesCoulombAndSignorini) {
  for (const double friction : {0.02, 0.3, 0.6, 1.0, 3.0}) {
    for (const double ratio : {0.1, 0.5, 1.0, 2.0}) {
      const PlanarBody body{0.1 * ratio, 0.1, CylinderGyration(0.1 * ratio, 0.2)};
      for (const double speed : {0.2, 0.6, 1.5}) {
        const PlanarResult result = PlanarOracle(body, friction, SuddenStop(speed), 1e-3).Run(1.0);
        EXPECT_LT(result.violation, 1e-9)
            << "friction " << friction << ", b/c " << ratio << ", " << speed << " m/s";
      }
    }
  }
}

TEST(PlanarOracleTest, BodyRestsOnAnUnevenFloorThatPitchesThePlate) {
  const auto pose = [](double time) {
    return PlatePose{0.3 * time, 0.0005 * std::sin(10.0 * time), 0.002 * std::sin(7.0 * time)};
  };
  const PlanarResult result =
      PlanarOracle(kPlanarMill, 0.5, {pose, 0.3, 2.0}, 1e-3).Run(kMostSlide);
  EXPECT_EQ(result.verdict, PlanarVerdict::kStays);
  EXPECT_LT(result.slide, 1e-3);
  EXPECT_LT(result.max_tilt, 1e-3);
  EXPECT_LT(result.violation, 1e-9);
}

}  // namespace
}  // namespace hires::physics::planar_oracle_test
