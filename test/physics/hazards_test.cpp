#include "physics/hazards.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/physics/closed_forms.h"

namespace hires::physics::hazards_test {
namespace {

constexpr double kGravity = 9.81, kStep = 0.002;

/// The mill of the dissertation as a body on the edge of its foot.
EdgeRocker EdgeOf(const UprightCylinder& body) {
  const double r = body.radius, c = body.height / 2;
  return {r, c, (3.0 * r * r + body.height * body.height) / 12.0 + r * r + c * c};
}

bool TipsIn(EdgeRocker rotation, double acceleration, double duration, double step = kStep) {
  const double end = duration + 20.0;
  for (double time = 0.0; time < end && !rotation.is_over(); time += step)
    rotation.Step(time + 0.5 * step < duration ? acceleration : 0.0, kGravity, step);
  return rotation.is_over();
}

TEST(EdgeRockerTest, RobotOfTheFieldReportTipsAtItsFootprint) {
  EXPECT_NEAR((EdgeRocker{0.15, 0.947, 1.0}.TippingAcceleration(kGravity)), 1.554, 5e-4);
}

TEST(EdgeRockerTest, RestsForEverBelowTippingAcceleration) {
  const EdgeRocker edge{0.15, 0.947, 1.0};
  EXPECT_FALSE(TipsIn(edge, 0.999 * edge.TippingAcceleration(kGravity), 100.0));
  EXPECT_TRUE(TipsIn(edge, 1.01 * edge.TippingAcceleration(kGravity), 100.0));
}

TEST(EdgeRockerTest, PulseThatOverturnsLastsAsLongAsByRungeKutta) {
  const UprightCylinder mill;
  for (const double factor : {1.2, 2.0, 5.0}) {
    const double a = factor * TippingAcceleration(mill, kGravity);
    const double shortest = OverturningPulseDuration(mill, a, kGravity);
    EXPECT_FALSE(TipsIn(EdgeOf(mill), a, 0.99 * shortest, 1e-5)) << factor;
    EXPECT_TRUE(TipsIn(EdgeOf(mill), a, 1.01 * shortest, 1e-5)) << factor;
  }
}

TEST(EdgeRockerTest, StopWithinOneStepTipsFromTheSpeedOfTheClosedForm) {
  const UprightCylinder mill;
  const double v = SuddenStopTopplingSpeed(mill, kGravity);
  EXPECT_FALSE(TipsIn(EdgeOf(mill), 0.98 * v / kStep, kStep));
  EXPECT_TRUE(TipsIn(EdgeOf(mill), 1.02 * v / kStep, kStep));
}

TEST(EdgeRockerTest, FallsBackOntoItsSupportAndStays) {
  EdgeRocker rotation{0.15, 0.947, 1.0};
  for (int i = 0; i < 20; ++i) rotation.Step(3.0, kGravity, kStep);
  EXPECT_GT(rotation.tilt, 0.0);
  for (int i = 0; i < 1000; ++i) rotation.Step(0.0, kGravity, kStep);
  EXPECT_EQ(rotation.tilt, 0.0);
}

TEST(SloshFrequencyTest, DeepAndShallowVesselsGiveTheirLimits) {
  const double R = 0.036;
  EXPECT_NEAR(SloshFrequency(R, 1.0, kGravity), std::sqrt(1.8412 * kGravity / R), 1e-9);
  // Shallow: a wave of speed sqrt(g h) and wave number 1.841 / R.
  EXPECT_NEAR(SloshFrequency(R, 1e-4, kGravity), 1.8412 / R * std::sqrt(kGravity * 1e-4), 1e-3);
}

TEST(SurfaceRiseTest, TeaOfTheFieldReportSpillsAfterASuddenStart) {
  EXPECT_NEAR(SurfaceRise(2.0, 0.036, kGravity), 0.00734, 1e-5);
  EXPECT_NEAR(kSuddenSlosh * SurfaceRise(1.09, 0.036, kGravity), 0.008, 1e-5);
}

TEST(SurfaceRiseTest, ModeFromRestComesToTwiceTheSteadyHeight) {
  const double omega = SloshFrequency(0.036, 0.074, kGravity), dt = 1e-5;
  double z = 0.0, rate = 0.0, highest = 0.0;
  for (double time = 0.0; time < 1.0; time += dt) {
    rate += dt * omega * omega * (SurfaceRise(2.0, 0.036, kGravity) - z);
    z += dt * rate;
    highest = std::max(highest, z);
  }
  EXPECT_NEAR(highest, kSuddenSlosh * SurfaceRise(2.0, 0.036, kGravity), 1e-5);
}

TEST(SpeedLossAtStepTest, WheelKeepsTheSquareOfTheCosine) {
  EXPECT_DOUBLE_EQ(SpeedLossAtStep(1.0, 0.025, 0.10), 0.4375);
  EXPECT_DOUBLE_EQ(SpeedLossAtStep(1.0, 0.0, 0.10), 0.0);
  EXPECT_DOUBLE_EQ(SpeedLossAtStep(1.0, 0.12, 0.10), 1.0);
}

}  // namespace
}  // namespace hires::physics::hazards_test
