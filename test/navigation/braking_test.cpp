#include "hires/navigation/braking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "hires/base/rng.h"

namespace hires::navigation::braking_test {
namespace {

using geometry::Twist2;

/// The same stop in many small steps: what the closed form replaces.
struct Integrated {
  double time{0.0}, distance{0.0}, speed{0.0};

  Integrated(const StopProfile& stop, double from_speed) : speed(from_speed) {
    const double dt = 1e-4;
    for (; time < stop.duration(); time += dt) {
      const double next = speed + dt * stop.AccelerationAt(time + 0.5 * dt);
      distance += 0.5 * dt * (speed + next);
      speed = next;
    }
  }
};

TEST(StopProfileTest, ALongStopRisesHoldsAndEases) {
  const StopProfile stop(0.55, 0.0, {1.0, 4.0});  // rise 0.25 s, hold 0.30 s, ease 0.25 s
  EXPECT_NEAR(stop.duration(), 0.80, 1e-12);
  EXPECT_NEAR(stop.distance(), 0.22, 1e-12);
  EXPECT_NEAR(stop.SpeedAt(0.25), 0.55 - 0.125, 1e-12);
  EXPECT_NEAR(stop.SpeedAt(0.55), 0.125, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.125), -0.5, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.40), -1.0, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.675), -0.5, 1e-12);
  EXPECT_EQ(stop.SpeedAt(0.81), 0.0);
  EXPECT_EQ(stop.AccelerationAt(0.81), 0.0);
  EXPECT_NEAR(stop.DistanceAt(9.0), 0.22, 1e-12);
}

TEST(StopProfileTest, AShortStopNeverReachesItsHardestDeceleration) {
  const StopProfile stop(0.16, 0.0, {1.0, 4.0});  // peak sqrt(4 x 0.16) = 0.8
  EXPECT_NEAR(stop.duration(), 0.4, 1e-12);
  EXPECT_NEAR(stop.distance(), 0.032, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.2), -0.8, 1e-12);
}

TEST(StopProfileTest, WhoSpeedsUpGetsFasterAtFirst) {
  const StopProfile stop(0.3, 0.5, {1.0, 2.0});
  EXPECT_NEAR(stop.SpeedAt(0.25), 0.3 + 0.0625, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.25), 0.0, 1e-12);
}

TEST(StopProfileTest, WhoBrakesTooHardIsEasedOff) {
  const StopProfile stop(0.5, -2.0, {1.0, 5.0});
  EXPECT_NEAR(stop.AccelerationAt(0.0), -2.0, 1e-12);
  EXPECT_NEAR(stop.AccelerationAt(0.2), -1.0, 1e-12);
  EXPECT_NEAR(stop.SpeedAt(0.2), 0.2, 1e-12);
  EXPECT_NEAR(stop.SpeedAt(stop.duration() - 1e-9), 0.0, 1e-9);
}

TEST(StopProfileTest, BrakingThatCannotBeEasedOffInTimeEndsWithTheSpeed) {
  const StopProfile stop(0.1, -1.0, {1.0, 4.0});  // sqrt(2 x 4 x 0.1) = 0.894 can be
  EXPECT_NEAR(stop.AccelerationAt(0.0), -std::sqrt(0.8), 1e-12);
  EXPECT_NEAR(stop.duration(), std::sqrt(0.8) / 4.0, 1e-12);
  EXPECT_NEAR(stop.SpeedAt(stop.duration() - 1e-9), 0.0, 1e-9);
}

TEST(StopProfileTest, WhoStandsNeedsNoTime) {
  for (const double acceleration : {0.0, -1.0}) {
    const StopProfile stop(0.0, acceleration, {1.0, 4.0});
    EXPECT_EQ(stop.duration(), 0.0);
    EXPECT_EQ(stop.distance(), 0.0);
  }
}

TEST(StopProfileTest, ClosedFormIsTheIntegral) {
  const base::Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    base::Rng draw = rng.Fork(i);
    const double speed = draw.Uniform(0.0, 1.5), acceleration = draw.Uniform(-2.0, 2.0);
    const BrakingLimits limits{draw.Uniform(0.2, 3.0), draw.Uniform(0.5, 20.0)};
    const StopProfile stop(speed, acceleration, limits);
    const Integrated slow(stop, speed);
    EXPECT_NEAR(slow.speed, 0.0, 1e-3) << "i = " << i;
    EXPECT_NEAR(slow.distance, stop.distance(), 1e-3) << "i = " << i;
    for (double t = 0.0; t < stop.duration(); t += 0.01) {
      EXPECT_GE(stop.SpeedAt(t), 0.0) << "i = " << i << " t = " << t;
      EXPECT_GE(stop.AccelerationAt(t), std::min(-limits.max_deceleration, acceleration) - 1e-9);
      EXPECT_LE(std::abs(stop.AccelerationAt(t + 1e-4) - stop.AccelerationAt(t)),
                1e-4 * limits.max_jerk + 1e-9)
          << "i = " << i << " t = " << t;
    }
  }
}

TEST(StopProfileTest, ShortFormulasAgreeWithTheProfile) {
  for (double speed = 0.05; speed < 1.2; speed += 0.05) {
    const BrakingLimits limits{1.1, 3.0};
    const StopProfile stop(speed, 0.0, limits);
    EXPECT_NEAR(StoppingDistance(speed, limits), stop.distance(), 1e-12) << speed;
    EXPECT_NEAR(StoppingTime(speed, limits), stop.duration(), 1e-12) << speed;
  }
}

TEST(StopProfileTest, RefusesWhatIsNoStop) {
  EXPECT_THROW(StopProfile(-0.1, 0.0, {1.0, 1.0}), std::logic_error);
  EXPECT_THROW(StopProfile(0.1, 0.0, {0.0, 1.0}), std::logic_error);
  EXPECT_THROW(StopProfile(0.1, 0.0, {1.0, 0.0}), std::logic_error);
}

TEST(PlanarStopTest, StaysOnItsArc) {
  const PlanarStop stop({0.4, 0.1, 0.5}, {}, {1.0, 3.0}, {});
  for (double t = 0.0; t < stop.duration(); t += 0.05) {
    const Twist2 V = stop.VelocityAt(t);
    EXPECT_NEAR(V.vy, 0.25 * V.vx, 1e-12);
    EXPECT_NEAR(V.wz, 1.25 * V.vx, 1e-12);
  }
  EXPECT_EQ(stop.VelocityAt(stop.duration()).vx, 0.0);
}

TEST(PlanarStopTest, StraightAheadItIsTheProfile) {
  const BrakingLimits limits{1.2, 3.5};
  const PlanarStop stop({0.55, 0.0, 0.0}, {-0.3, 0.0, 0.0}, limits, {});
  const StopProfile profile(0.55, -0.3, limits);
  EXPECT_NEAR(stop.duration(), profile.duration(), 1e-12);
  EXPECT_NEAR(stop.distance(), profile.distance(), 1e-12);
  EXPECT_NEAR(stop.VelocityAt(0.3).vx, profile.SpeedAt(0.3), 1e-12);
}

TEST(PlanarStopTest, WhatSpeedsUpEndsAtOnce) {
  const PlanarStop stop({0.3, 0.0, 0.0}, {2.0, 0.0, 0.0}, {1.0, 3.0}, {});
  EXPECT_LE(stop.VelocityAt(0.02).vx, 0.3);
}

/// Acceleration of a point of the base, in axes that stand still, by finite differences.
double LoadAcceleration(const PlanarStop& stop, double x, double t) {
  const double dt = 1e-4;
  const Twist2 a = stop.VelocityAt(t), b = stop.VelocityAt(t + dt);
  const double turn = a.wz * dt;  // of the base's axes meanwhile
  const double vx = std::cos(turn) * b.vx - std::sin(turn) * (b.vy + b.wz * x);
  const double vy = std::sin(turn) * b.vx + std::cos(turn) * (b.vy + b.wz * x);
  return std::hypot(vx - a.vx, vy - (a.vy + a.wz * x)) / dt;
}

TEST(PlanarStopTest, TheLoadIsNeverPushedHarderThanItBears) {
  const BrakingLimits limits{1.3, 3.5};
  const base::Rng rng(5);
  int judged = 0;
  for (int i = 0; i < 200; ++i) {
    base::Rng draw = rng.Fork(i);
    const Twist2 V{draw.Uniform(-0.55, 0.55), draw.Uniform(-0.1, 0.1), draw.Uniform(-1.0, 1.0)};
    const double on_arc =
        std::abs(V.wz) * (std::hypot(V.vx, V.vy) + std::abs(V.wz) * BrakingParams().load_reach);
    if (on_arc > 0.9 * limits.max_deceleration) continue;  // the arc alone asks for nearly all
    ++judged;
    const PlanarStop stop(V, {}, limits, {});
    for (double t = 0.0; t < stop.duration(); t += 0.01) {
      EXPECT_LE(LoadAcceleration(stop, 0.4, t), limits.max_deceleration + 1e-3)
          << "i = " << i << " t = " << t;
    }
  }
  EXPECT_GT(judged, 100);
}

TEST(PlanarStopTest, TurningOnTheSpotEndsWithinItsLimits) {
  const BrakingParams params;
  const PlanarStop stop({0.0, 0.0, 1.0}, {}, {10.0, 100.0}, params);
  for (double t = 0.0; t < stop.duration(); t += 0.01) {
    const double rate = (stop.VelocityAt(t).wz - stop.VelocityAt(t + 1e-4).wz) / 1e-4;
    EXPECT_LE(rate, params.max_angular_deceleration + 1e-6);
  }
  EXPECT_NEAR(stop.distance(), 0.0, 1e-12);
}

TEST(OvershootTest, StepAndSlowRiseAreBounded) {
  EXPECT_NEAR(OvershootShare(20.0, 0.56, 0.0), 0.1196, 1e-4);  // exp(-0.56 pi / sqrt(1 - 0.56^2))
  EXPECT_NEAR(OvershootShare(17.0, 0.2, 1.0), 2.0 / 17.0, 1e-12);
  EXPECT_EQ(OvershootShare(17.0, 1.0, 0.0), 0.0);
}

/// Largest value of a damped oscillation that follows a rise to 1 within `rise`.
double Peak(double w, double d, double rise) {
  double x = 0.0, v = 0.0, peak = 0.0;
  const double dt = 1e-4;
  for (double t = 0.0; t < rise + 10.0 / w; t += dt) {
    const double target = rise > 0.0 ? std::min(1.0, t / rise) : 1.0;
    v += dt * (w * w * (target - x) - 2.0 * d * w * v);
    x += dt * v;
    peak = std::max(peak, x);
  }
  return peak;
}

TEST(OvershootTest, NoOscillationOvershootsMore) {
  for (const double d : {0.0, 0.1, 0.2, 0.56, 0.7, 0.98}) {
    for (const double rise : {0.0, 0.1, 0.2, 0.37, 0.5, 1.0}) {
      EXPECT_LE(Peak(17.0, d, rise), 1.0 + OvershootShare(17.0, d, rise) + 2e-3)
          << "d = " << d << " rise = " << rise;
    }
  }
}

TEST(OvershootTest, RefusesWhatIsNoOscillation) {
  EXPECT_THROW(OvershootShare(0.0, 0.2, 0.1), std::logic_error);
  EXPECT_THROW(OvershootShare(1.0, -0.2, 0.1), std::logic_error);
  EXPECT_THROW(OvershootShare(1.0, 0.2, -0.1), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::braking_test
