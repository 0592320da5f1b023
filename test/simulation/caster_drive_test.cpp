#include "hires/simulation/caster_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/simulation/base_drive.h"

namespace hires::simulation::caster_drive_test {
namespace {

using geometry::Twist2;
using robot::CasterParams;

constexpr double kDt = 0.001;

/// [m/s], [rad/s]. A base that turns under its velocity v pushes its tyres by w v; what holds
/// against it grows with their creep, to the full grip of 7.8 m/s^2 at 1 cm/s: w v = 1.6 makes 2
/// mm/s.
constexpr double kCreep = 3e-3;

/// A PR2's base and nothing else: no lag, no leaning, a time-out that no test meets by chance.
robot::BaseControllerParams OnCasters(int version, double wheel_damping = 0.25) {
  robot::BaseControllerParams params;
  params.limits = {1.0, 2.0, 2.0, 2.0};
  params.command_timeout = 60.0;
  params.stops_at_timeout = true;
  params.casters.emplace();
  params.casters->version = version;
  params.casters->wheel_damping = wheel_damping;
  return params;
}

/// A drive with a clock of its own.
struct Drive {
  explicit Drive(const robot::BaseControllerParams& params, double time_step = kDt)
      : dt(time_step), drive(params, {}) {}

  void Send(const Twist2& velocity) { drive.Send(velocity, Now()); }
  const BaseMotion& Step() {
    drive.Step(Now(), dt, 0.0);
    ++steps;
    return drive.motion();
  }
  const BaseMotion& StepFor(double duration) {
    for (long i = std::lround(duration / dt); i > 0; --i) Step();
    return drive.motion();
  }
  double Now() const { return static_cast<double>(steps) * dt; }

  double dt;
  BaseDrive drive;
  long steps{0};
};

Twist2 DrawTwist(base::Rng* rng) {
  return {rng->Uniform(-0.6, 0.6), rng->Uniform(-0.6, 0.6), rng->Uniform(-1.5, 1.5)};
}

/// [rad] between two directions of a caster, which may point forward or backward along them.
double Between(double a, double b) {
  const double apart = std::abs(geometry::WrapToPi(a - b));
  return std::min(apart, geometry::kPi - apart);
}

/// Where a twist sends the axis of each caster.
std::vector<double> Wanted(const Twist2& v, const CasterParams& params) {
  std::vector<double> angles;
  for (const double x : {params.at, -params.at}) {
    for (const double y : {params.at, -params.at}) {
      angles.push_back(std::atan2(v.vy + x * v.wz, v.vx - y * v.wz));
    }
  }
  return angles;
}

TEST(CasterDriveTest, TranslationAndTurningAreClippedApart) {
  Drive drive(OnCasters(2, 0.0));
  drive.Send({0.8, 0.0, -4.0});
  const Twist2 v = drive.StepFor(3.0).V_B;
  EXPECT_NEAR(v.vx, 0.8, kCreep);
  EXPECT_NEAR(v.wz, -2.0, kCreep);
  drive.Send({3.0, -4.0, 0.5});
  const Twist2 w = drive.StepFor(4.0).V_B;
  EXPECT_NEAR(w.vx, 0.6, kCreep);
  EXPECT_NEAR(w.vy, -0.8, kCreep);
  EXPECT_NEAR(w.wz, 0.5, kCreep);
}

TEST(CasterDriveTest, EveryTwistIsDrivenInTheEndButForWhatDampingTakes) {
  for (int seed = 1; seed <= 40; ++seed) {
    base::Rng rng(seed);
    const auto params = OnCasters(1 + seed % 2, rng.Uniform(0.0, 0.5));
    const double share = robot::RollingShare(*params.casters);
    Drive drive(params);
    Twist2 wanted;
    for (int i = 0; i < 3; ++i) {  // from whatever was before
      wanted = DrawTwist(&rng);
      drive.Send(wanted);
      drive.StepFor(3.0);
    }
    const Twist2 v = drive.drive.motion().V_B;
    EXPECT_NEAR(v.vx, share * wanted.vx, kCreep) << "seed " << seed;
    EXPECT_NEAR(v.vy, share * wanted.vy, kCreep) << "seed " << seed;
    EXPECT_NEAR(v.wz, share * wanted.wz, kCreep) << "seed " << seed;
  }
}

TEST(CasterDriveTest, CastersComeToWhereTheTwistSendsThemBySmallTurns) {
  for (int seed = 1; seed <= 40; ++seed) {
    base::Rng rng(seed);
    CasterParams params;
    params.version = 1 + seed % 2;
    CasterDrive casters(params);
    Twist2 V_B;
    for (int i = 0; i < 4; ++i) {
      const Twist2 commanded = DrawTwist(&rng);
      const auto wanted = Wanted(commanded, params);
      const auto before = casters.Angles();
      double farthest = 0.0;
      for (int step = 0; step < 2000; ++step) {
        casters.Step(commanded, 100.0, kDt, &V_B);
        for (int c = 0; c < CasterDrive::kNumCasters; ++c) {
          farthest =
              std::max(farthest, std::abs(geometry::WrapToPi(casters.Angles()[c] - before[c])));
        }
      }
      for (int c = 0; c < CasterDrive::kNumCasters; ++c) {
        EXPECT_LT(Between(casters.Angles()[c], wanted[c]), 2e-3) << "seed " << seed;
      }
      // Of the two ends of its direction the nearer one; some way is overshoot.
      EXPECT_LT(farthest, 0.5 * geometry::kPi + 0.3) << "seed " << seed;
    }
  }
}

TEST(CasterDriveTest, WithoutACommandCastersStayAndTheBaseComesToRest) {
  for (const int version : {1, 2}) {
    CasterParams params;
    params.version = version;
    CasterDrive casters(params);
    Twist2 V_B;
    for (int i = 0; i < 2000; ++i) casters.Step({0.2, 0.3, 0.4}, 100.0, kDt, &V_B);
    const auto before = casters.Angles();
    for (int i = 0; i < 2000; ++i) casters.Step({}, 100.0, kDt, &V_B);
    EXPECT_EQ(V_B.vx, 0.0);
    EXPECT_EQ(V_B.vy, 0.0);
    EXPECT_EQ(V_B.wz, 0.0);
    for (int c = 0; c < CasterDrive::kNumCasters; ++c) {
      EXPECT_NEAR(casters.Angles()[c], before[c], 2e-3);
    }
  }
}

TEST(CasterDriveTest, ASteadyRampIsTrailedByTheLagOfTheWheels) {
  for (const int version : {1, 2}) {
    for (const double damping : {0.0, 0.25, 0.5}) {
      auto params = OnCasters(version, damping);
      params.limits.max_linear_acceleration = 1.0;  // within all efforts
      Drive drive(params);
      drive.Send({1.0, 0.0, 0.0});
      const BaseMotion motion = drive.StepFor(0.45);
      const double share = robot::RollingShare(*params.casters);
      const double lag = robot::RollingLag(*params.casters);
      EXPECT_NEAR(motion.A_B.vx, share, std::exp(-0.45 / lag) + 0.005) << version;
      // A filter of version 2 adds a millisecond, the cycle another half.
      EXPECT_NEAR(motion.V_B.vx, share * (0.45 - lag * (1.0 - std::exp(-0.45 / lag))), 0.0025)
          << version << ", damping " << damping;
    }
  }
}

/// What becomes of a base that rolls straight on when its wheels' target is 0 at once: at the limit
/// of effort E, dv/dt = -(a + b v), until P v / r = E; then v falls as exp(-t / lag).
struct MotorStop {
  MotorStop(const CasterParams& p, double v) {
    const double r = p.wheel_radius, gain = p.version == 1 ? 3.0 : 5.0;
    const double mass = p.mass + 8.0 * p.wheel_inertia / (r * r);
    const double a = 8.0 * p.wheel_effort / (r * mass);
    const double b = 8.0 * p.wheel_damping / (r * r * mass);
    const double limit = p.wheel_effort * r / gain;
    hardest = a + b * v;
    const double saturated =
        b > 0.0 ? std::log((a + b * v) / (a + b * limit)) / b : (v - limit) / a;
    way = b > 0.0 ? (v - limit - a * saturated) / b : (v * v - limit * limit) / (2.0 * a);
    way += limit * mass * r * r / (8.0 * (gain + p.wheel_damping));
  }
  double hardest{0.0};  // [m/s^2]
  double way{0.0};      // [m]
};

TEST(CasterDriveTest, AtItsTimeoutTheBaseStopsAsHardAsItsWheelsCan) {
  for (const int version : {1, 2}) {
    for (const double damping : {0.0, 0.25, 0.5}) {
      auto params = OnCasters(version, damping);
      params.command_timeout = 2.0;
      Drive drive(params);
      drive.Send({0.55, 0.0, 0.0});
      const BaseMotion silent = drive.StepFor(2.001);
      EXPECT_FALSE(silent.timed_out);
      const MotorStop stop(*params.casters, silent.V_B.vx);
      EXPECT_NEAR(robot::HardestStop(*params.casters, silent.V_B.vx), stop.hardest, 1e-9);
      EXPECT_TRUE(drive.Step().timed_out);
      double hardest = 0.0;
      while (drive.Now() < 4.0) hardest = std::max(hardest, -drive.Step().A_B.vx);
      EXPECT_NEAR(hardest, stop.hardest, 0.02) << version << ", damping " << damping;
      EXPECT_NEAR(drive.drive.motion().X_MB.x - silent.X_MB.x, stop.way, 0.002)
          << version << ", damping " << damping;
      EXPECT_EQ(drive.drive.motion().V_B.vx, 0.0);
      EXPECT_NEAR(drive.drive.motion().X_MB.y, 0.0, 1e-9);
    }
  }
}

TEST(CasterDriveTest, ACommandToStandIsARampAndNotAStop) {
  for (const int version : {1, 2}) {
    Drive drive(OnCasters(version, 0.0));
    drive.Send({0.55, 0.0, 0.0});
    drive.StepFor(2.0);
    drive.Send({});
    double hardest = 0.0;
    for (int i = 0; i < 1000; ++i) hardest = std::max(hardest, -drive.Step().A_B.vx);
    EXPECT_GT(hardest, 1.9) << version;  // the ramp's 2.0 takes 0.28 s, the lag 0.07 s at most
    EXPECT_LE(hardest, 2.0 + 1e-6) << version;
  }
}

TEST(CasterDriveTest, WheelsThatRollWhileCastersTurnPushTheBaseAside) {
  Drive drive(OnCasters(2));
  drive.Send({0.0, 0.3, 0.0});  // casters point forward
  double forward = 0.0;
  for (int i = 0; i < 1000; ++i) forward = std::max(forward, std::abs(drive.Step().V_B.vx));
  EXPECT_GT(forward, 0.005);
  EXPECT_LT(forward, 0.1);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.0, 1e-3);
}

TEST(CasterDriveTest, TyresHoldAgainstAPushUntilTheirFrictionIsSpent) {
  const auto params = OnCasters(2);
  const double most = params.casters->grip * 9.81;
  Drive held(params), sliding(params);
  held.drive.Push(Twist2{0.0, 0.9 * most, 0.0});
  sliding.drive.Push(Twist2{0.0, most + 2.0, 0.0});
  EXPECT_LT(held.StepFor(0.2).V_B.vy, 0.02);
  // Casters point forward, so wheels roll freely along and slide across.
  EXPECT_NEAR(sliding.StepFor(0.2).V_B.vy, 2.0 * 0.2, 0.03);
}

TEST(CasterDriveTest, NoCommandsMakeItFasterOrHarderThanItsMotorsAndTyresCan) {
  for (int seed = 1; seed <= 30; ++seed) {
    base::Rng rng(seed);
    auto params = OnCasters(1 + seed % 2, rng.Uniform(0.0, 0.5));
    params.command_timeout = 0.2;
    const CasterParams& casters = *params.casters;
    const double most = robot::HardestStop(casters, 1.5) + casters.grip * 9.81;
    Drive drive(params);
    for (int i = 0; i < 5000; ++i) {
      if (rng.Bernoulli(0.01)) {
        drive.Send({rng.Uniform(-2.0, 2.0), rng.Uniform(-2.0, 2.0), rng.Uniform(-4.0, 4.0)});
      }
      const BaseMotion& motion = drive.Step();
      // The base frame turns: w v on top of what acts on the base.
      const double turned = std::abs(motion.V_B.wz) * std::hypot(motion.V_B.vx, motion.V_B.vy);
      ASSERT_LE(std::hypot(motion.V_B.vx, motion.V_B.vy), 1.4) << "seed " << seed;
      ASSERT_LE(std::abs(motion.V_B.wz), 2.8) << "seed " << seed;
      ASSERT_LE(std::hypot(motion.A_B.vx, motion.A_B.vy), most + turned) << "seed " << seed;
    }
  }
}

TEST(CasterDriveTest, HalfTheStepGivesNearlyTheSame) {
  for (int seed = 1; seed <= 10; ++seed) {
    const auto params = OnCasters(1 + seed % 2);
    Drive coarse(params), fine(params, 0.5 * kDt);
    base::Rng rng(seed);
    for (int i = 0; i < 5; ++i) {
      const Twist2 command = DrawTwist(&rng);
      coarse.Send(command);
      fine.Send(command);
      coarse.StepFor(0.5);
      fine.StepFor(0.5);
    }
    const geometry::Pose2 a = coarse.drive.motion().X_MB, b = fine.drive.motion().X_MB;
    EXPECT_LT((a.position() - b.position()).norm(), 0.01) << "seed " << seed;
    EXPECT_LT(std::abs(geometry::WrapToPi(a.yaw - b.yaw)), 0.02) << "seed " << seed;
  }
}

TEST(CasterDriveTest, ACopyGoesOnWithTheSameBits) {
  for (const int version : {1, 2}) {
    Drive original(OnCasters(version));
    base::Rng rng(5);
    for (int i = 0; i < 37; ++i) {
      original.Send(DrawTwist(&rng));
      original.StepFor(0.017);
    }
    Drive copy = original;
    for (int i = 0; i < 1000; ++i) {
      const BaseMotion a = original.Step(), b = copy.Step();
      ASSERT_EQ(a.X_MB.x, b.X_MB.x);
      ASSERT_EQ(a.X_MB.yaw, b.X_MB.yaw);
      ASSERT_EQ(a.A_B.vy, b.A_B.vy);
    }
  }
}

TEST(CasterDriveTest, ARobotThatStandsStaysAsItIs) {
  CasterDrive casters{CasterParams{}};
  Twist2 V_B;
  for (int i = 0; i < 1000; ++i) casters.Step({}, 100.0, kDt, &V_B);
  for (const double angle : casters.Angles()) EXPECT_EQ(angle, 0.0);
  EXPECT_EQ(V_B.vx, 0.0);
}

}  // namespace
}  // namespace hires::simulation::caster_drive_test
