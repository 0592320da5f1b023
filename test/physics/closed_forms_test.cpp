#include "hires/physics/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hires::physics::closed_forms_test {
namespace {

constexpr double kGravity = 9.81;
const UprightCylinder kMill{0.037, 0.274, 0.140};

/// The slow way: plays the pulse and what follows until the body lies or stands again.
bool FallsAfterPulse(const UprightCylinder& body, double acceleration, double duration) {
  const double r = body.radius, c = body.height / 2, alpha = std::atan2(r, c);
  const double arm = std::hypot(r, c);
  const double inertia = body.mass * ((3 * r * r + 4 * c * c) / 12 + arm * arm);
  constexpr double kStep = 1e-5;
  double tilt = 0.0, rate = 0.0;
  for (long i = 0; i < 1000000; ++i) {
    const double a = (i + 0.5) * kStep < duration ? acceleration : 0.0;
    rate += kStep * body.mass * arm *
            (a * std::cos(alpha - tilt) - kGravity * std::sin(alpha - tilt)) / inertia;
    tilt += kStep * rate;
    if (tilt > 2.0 * alpha) return true;
    if (tilt < 0.0) return false;
  }
  return false;
}

TEST(ClosedFormsTest, MillTipsAtGravityTimesRadiusOverHalfHeight) {
  EXPECT_NEAR(TippingAcceleration(kMill, kGravity), 2.649416, 1e-6);
}

TEST(ClosedFormsTest, SlidingStartsAtFrictionTimesGravity) {
  EXPECT_DOUBLE_EQ(SlidingAcceleration(0.2, kGravity), 1.962);
}

TEST(ClosedFormsTest, MillToppledBySuddenStopFromAThirdOfAMetrePerSecond) {
  // R = 0.141908 m, I_A / m = 0.0267366 m^2, worked by hand.
  EXPECT_NEAR(SuddenStopTopplingSpeed(kMill, kGravity), 0.37037, 2e-5);
}

TEST(ClosedFormsTest, HousnersPulseForTwiceTheTippingAcceleration) {
  // alpha = 0.26381, x = 2.04749, p = 7.2158 1/s, worked by hand.
  EXPECT_NEAR(HousnerPulseDuration(kMill, 2.0 * 2.649416, kGravity), 0.09288, 2e-5);
}

TEST(ClosedFormsTest, MassDoesNotMatter) {
  UprightCylinder heavy = kMill;
  heavy.mass = 5.0;
  EXPECT_NEAR(SuddenStopTopplingSpeed(heavy, kGravity), SuddenStopTopplingSpeed(kMill, kGravity),
              1e-12);
  EXPECT_NEAR(OverturningPulseDuration(heavy, 4.0, kGravity),
              OverturningPulseDuration(kMill, 4.0, kGravity), 1e-12);
}

TEST(ClosedFormsTest, ShortestPulseOverturnsAndAShorterOneDoesNot) {
  for (const double x : {1.05, 1.2, 1.5, 2.0, 3.0, 5.0}) {
    const double acceleration = x * TippingAcceleration(kMill, kGravity);
    const double duration = OverturningPulseDuration(kMill, acceleration, kGravity);
    EXPECT_TRUE(FallsAfterPulse(kMill, acceleration, duration + 1e-4)) << "x = " << x;
    EXPECT_FALSE(FallsAfterPulse(kMill, acceleration, duration - 1e-4)) << "x = " << x;
  }
}

TEST(ClosedFormsTest, VeryHardPulseActsLikeASuddenStop) {
  const double acceleration = 1000.0;
  const double speed = acceleration * OverturningPulseDuration(kMill, acceleration, kGravity);
  EXPECT_NEAR(speed / SuddenStopTopplingSpeed(kMill, kGravity), 1.0, 0.002);
}

TEST(ClosedFormsTest, HousnerApproachesTheNonlinearPulseForSlenderBodies) {
  double last_error = 1.0;
  for (const double radius : {0.03, 0.01, 0.003, 0.001}) {
    const UprightCylinder body{radius, 0.274, 0.14};
    const double acceleration = 2.0 * TippingAcceleration(body, kGravity);
    const double exact = OverturningPulseDuration(body, acceleration, kGravity);
    const double error = std::abs(HousnerPulseDuration(body, acceleration, kGravity) / exact - 1.0);
    EXPECT_LT(error, last_error) << "radius = " << radius;
    last_error = error;
  }
  EXPECT_LT(last_error, 1e-3);
}

TEST(ClosedFormsTest, HarderPulsesMayBeShorter) {
  double last = OverturningPulseDuration(kMill, 2.7, kGravity);
  for (double acceleration = 3.0; acceleration < 30.0; acceleration *= 1.3) {
    const double duration = OverturningPulseDuration(kMill, acceleration, kGravity);
    EXPECT_LT(duration, last) << "a = " << acceleration;
    last = duration;
  }
}

TEST(ClosedFormsTest, PulseTooWeakToTipBreaksThePrecondition) {
  EXPECT_THROW(OverturningPulseDuration(kMill, 2.6, kGravity), std::logic_error);
  EXPECT_THROW(HousnerPulseDuration(kMill, 2.5, kGravity), std::logic_error);
}

}  // namespace
}  // namespace hires::physics::closed_forms_test
