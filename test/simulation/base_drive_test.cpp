#include "hires/simulation/base_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::simulation::base_drive_test {
namespace {

using geometry::Twist2;

constexpr double kDt = 0.001;

/// No lag, loop or sway: the base follows its ramp.
robot::BaseControllerParams Ideal() {
  robot::BaseControllerParams params;
  params.limits = {1.0, 2.0, 2.0, 2.0};
  params.command_timeout = 60.0;
  return params;
}

/// Limits that no test reaches, so that the loop alone shows.
robot::BaseControllerParams LoopAlone(double frequency, double damping) {
  robot::BaseControllerParams params = Ideal();
  params.limits = {1e3, 1e3, 1e9, 1e9};
  params.loop_frequency = frequency;
  params.loop_damping = damping;
  return params;
}

/// A drive with a clock of its own.
struct Drive {
  explicit Drive(const robot::BaseControllerParams& params, double time_step = kDt)
      : dt(time_step), drive(params, {}) {}

  void Send(const Twist2& velocity) { drive.Send(velocity, Now()); }
  const BaseMotion& Step(double slip = 0.0) {
    drive.Step(Now(), dt, slip);
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

bool SameBits(const BaseMotion& a, const BaseMotion& b) {
  return a.X_MB.x == b.X_MB.x && a.X_MB.y == b.X_MB.y && a.X_MB.yaw == b.X_MB.yaw &&
         a.V_B.vx == b.V_B.vx && a.V_B.vy == b.V_B.vy && a.V_B.wz == b.V_B.wz &&
         a.A_B.vx == b.A_B.vx && a.A_B.vy == b.A_B.vy && a.A_B.wz == b.A_B.wz &&
         a.pitch == b.pitch && a.roll == b.roll && a.timed_out == b.timed_out;
}

TEST(BaseDriveTest, TwoDrivenWheelsIgnoreSidewaysCommands) {
  robot::BaseControllerParams params = Ideal();
  params.drive = robot::Drive::kDifferential;
  Drive ordered(params), forward(params);
  ordered.Send({0.9, 0.9, 0.4});  // the forward part alone is within the limits
  forward.Send({0.9, 0.0, 0.4});
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(SameBits(ordered.Step(), forward.Step())) << i;
    ASSERT_EQ(ordered.drive.motion().V_B.vy, 0.0);
  }
}

/// [m] From 0.8 m/s until it stands, after `stop`.
double StoppingDistance(Drive* drive, const std::function<void(Drive*)>& stop) {
  drive->Send({0.8, 0.0, 0.0});
  drive->StepFor(2.0);
  EXPECT_DOUBLE_EQ(drive->drive.motion().V_B.vx, 0.8);
  const double begin = drive->drive.motion().X_MB.x;
  stop(drive);
  drive->StepFor(10.0);
  EXPECT_DOUBLE_EQ(drive->drive.motion().V_B.vx, 0.0);
  return drive->drive.motion().X_MB.x - begin;
}

void SendStop(Drive* drive) { drive->Send({}); }

/// v^2 / (2 a) in steps: the velocity of each step is the one at its end.
double ClosedForm(double deceleration) {
  return 0.8 * 0.8 / (2.0 * deceleration) - 0.5 * 0.8 * kDt;
}

TEST(BaseDriveTest, StoppingDistanceIsThatOfTheDeceleration) {
  for (const double deceleration : {0.5, 2.0, 5.0}) {
    robot::BaseControllerParams params = Ideal();
    params.limits.max_linear_deceleration = deceleration;
    Drive drive(params);
    EXPECT_NEAR(StoppingDistance(&drive, SendStop), ClosedForm(deceleration), 1e-6);
  }
}

TEST(BaseDriveTest, StoppingAngleIsThatOfTheAngularDeceleration) {
  robot::BaseControllerParams params = Ideal();
  params.limits.max_angular_deceleration = 0.5;
  Drive drive(params);
  drive.Send({0.0, 0.0, 0.6});
  drive.StepFor(1.0);
  const double begin = drive.drive.motion().X_MB.yaw;
  drive.Send({});
  drive.StepFor(3.0);
  const double angle = 0.6 * 0.6 / (2.0 * 0.5) - 0.5 * 0.6 * kDt;
  EXPECT_NEAR(drive.drive.motion().X_MB.yaw - begin, angle, 1e-6);
}

TEST(BaseDriveTest, EmergencyDecelerationStopsAfterATimeoutAlone) {
  robot::BaseControllerParams params = Ideal();
  params.limits.max_linear_deceleration = 0.5;
  params.emergency_deceleration = 4.0;
  Drive ordered(params);
  EXPECT_NEAR(StoppingDistance(&ordered, SendStop), ClosedForm(0.5), 1e-6);
  params.command_timeout = 2.0;  // as long as it drives; then one more step
  Drive late(params);
  EXPECT_NEAR(StoppingDistance(&late, [](Drive*) {}), ClosedForm(4.0), 0.8 * 2.0 * kDt);
}

TEST(BaseDriveTest, DecelerationDoesNotChangeHowItGainsSpeed) {
  robot::BaseControllerParams params = Ideal();
  Drive plain(params);
  params.limits.max_linear_deceleration = params.limits.max_angular_deceleration = 0.3;
  params.emergency_deceleration = 0.2;
  Drive gentle(params);
  for (Drive* drive : {&plain, &gentle}) drive->Send({0.9, 0.0, 0.4});
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(SameBits(plain.Step(), gentle.Step())) << i;
}

TEST(BaseDriveTest, DecelerationLikeTheAccelerationGivesTheSameBits) {
  robot::BaseControllerParams params = Ideal();
  params.command_timeout = 0.5;
  params.max_linear_jerk = 8.0;
  Drive plain(params);
  params.limits.max_linear_deceleration = params.limits.max_linear_acceleration;
  params.limits.max_angular_deceleration = params.limits.max_angular_acceleration;
  Drive same(params);
  base::Rng rng(3);
  for (int i = 0; i < 3000; ++i) {
    if (i % 300 == 0 && i < 2000) {
      const Twist2 velocity{rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), rng.Uniform(-2.0, 2.0)};
      plain.Send(velocity);
      same.Send(velocity);
    }
    ASSERT_TRUE(SameBits(plain.Step(), same.Step())) << i;
  }
}

robot::BaseControllerParams CarLike(double radius) {
  robot::BaseControllerParams params = Ideal();
  params.drive = robot::Drive::kCarLike;
  params.min_turning_radius = radius;
  return params;
}

TEST(BaseDriveTest, ACarDrivesItsSmallestCircleAndNoSmallerOne) {
  Drive car(CarLike(0.5));
  car.Send({0.5, 0.4, 2.0});  // 0.25 m would be its radius
  car.StepFor(2.0);
  EXPECT_NEAR(car.drive.motion().V_B.wz, 1.0, 1e-9);
  EXPECT_EQ(car.drive.motion().V_B.vy, 0.0);
  const geometry::Pose2 X_MB = car.drive.motion().X_MB;
  const Eigen::Vector2d centre = X_MB * Eigen::Vector2d(0.0, 0.5);
  car.StepFor(1.5);
  EXPECT_NEAR((car.drive.motion().X_MB.position() - centre).norm(), 0.5, 1e-4);

  Drive standing(CarLike(0.5));
  standing.Send({0.0, 0.0, 1.0});
  EXPECT_EQ(standing.StepFor(1.0).X_MB.yaw, 0.0);
  Drive wide(CarLike(0.5));  // where its steering is not hard over nothing changes
  robot::BaseControllerParams two_wheels = CarLike(0.5);
  two_wheels.drive = robot::Drive::kDifferential;
  Drive differential(two_wheels);
  wide.Send({0.5, 0.0, 0.9});
  differential.Send({0.5, 0.0, 0.9});
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(SameBits(wide.Step(), differential.Step())) << i;
}

TEST(BaseDriveTest, ACarKeepsToItsArcsBetweenRandomCommandsToo) {
  for (int seed = 1; seed <= 20; ++seed) {
    base::Rng rng(seed);
    robot::BaseControllerParams params = CarLike(rng.Uniform(0.3, 2.0));
    params.loop_frequency = seed % 2 == 0 ? 0.0 : 20.0;
    params.loop_damping = 0.4;
    params.max_linear_jerk = seed % 3 == 0 ? 8.0 : 0.0;
    Drive car(params);
    int num_hard_over = 0;
    for (int i = 0; i < 5000; ++i) {
      if (i % 100 == 0) {
        car.Send({rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), rng.Uniform(-2.0, 2.0)});
      }
      const Twist2 v = car.Step(0.1).V_B;
      ASSERT_LE(std::abs(v.wz), std::abs(v.vx) / params.min_turning_radius + 1e-9);
      ASSERT_EQ(v.vy, 0.0);
      num_hard_over += std::abs(v.wz) > 0.99 * std::abs(v.vx) / params.min_turning_radius ? 1 : 0;
    }
    EXPECT_GT(num_hard_over, 100) << "seed " << seed;
  }
}

TEST(BaseDriveTest, RampsAtTheLimitAndThenHolds) {
  Drive drive(Ideal());
  drive.Send({0.5, 0.0, 0.0});
  EXPECT_NEAR(drive.StepFor(0.1).V_B.vx, 0.2, 1e-12);
  EXPECT_NEAR(drive.drive.motion().A_B.vx, 2.0, 1e-9);
  // 250 steps of a ramp: dt^2 a (1 + 2 + ... + 250).
  EXPECT_NEAR(drive.StepFor(0.15).X_MB.x, kDt * kDt * 2.0 * 250 * 251 / 2, 1e-9);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.5, 1e-12);
  drive.StepFor(0.5);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.5, 1e-12);
  EXPECT_NEAR(drive.drive.motion().A_B.vx, 0.0, 1e-9);
}

TEST(BaseDriveTest, ClippingKeepsTheDirection) {
  Drive diagonal(Ideal());
  diagonal.Send({3.0, -4.0, 0.0});
  const Twist2 v = diagonal.StepFor(2.0).V_B;
  EXPECT_NEAR(v.vx, 0.6, 1e-12);
  EXPECT_NEAR(v.vy, -0.8, 1e-12);

  Drive turning(Ideal());  // 4 rad/s is twice too fast: everything is halved
  turning.Send({0.8, 0.0, -4.0});
  const Twist2 w = turning.StepFor(2.0).V_B;
  EXPECT_NEAR(w.vx, 0.4, 1e-12);
  EXPECT_NEAR(w.wz, -2.0, 1e-12);
}

TEST(BaseDriveTest, AllAxesOfAChangeArriveTogether) {
  Drive drive(Ideal());
  drive.Send({0.3, 0.1, 1.0});  // the turn takes longest: 0.5 s
  for (int i = 0; i < 499; ++i) {
    const Twist2 v = drive.Step().V_B;
    ASSERT_NEAR(v.vy, v.vx / 3.0, 1e-12);
    ASSERT_NEAR(v.wz, v.vx / 0.3, 1e-11);
    ASSERT_LT(v.vx, 0.3);
  }
  drive.Step();
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.3, 1e-12);
}

TEST(BaseDriveTest, OneShareForAllAxesFromAnyTwistToAnyOther) {
  for (int seed = 1; seed <= 200; ++seed) {
    base::Rng rng(seed);
    const auto draw = [&rng] {
      return Twist2{rng.Uniform(-0.7, 0.7), rng.Uniform(-0.7, 0.7), rng.Uniform(-2.0, 2.0)};
    };
    const Twist2 from = draw(), to = draw();
    Drive drive(Ideal());
    drive.Send(from);
    drive.StepFor(3.0);
    drive.Send(to);
    const double dx = to.vx - from.vx, dy = to.vy - from.vy, dw = to.wz - from.wz;
    const double longest = std::max({std::abs(dx), std::abs(dy), std::abs(dw)}) / 2.0;  // [s]
    for (int i = 1; i * kDt < longest; ++i) {
      const Twist2 v = drive.Step().V_B;
      const double share = i * kDt / longest;
      ASSERT_NEAR(v.vx, from.vx + share * dx, 1e-9) << "seed " << seed;
      ASSERT_NEAR(v.vy, from.vy + share * dy, 1e-9) << "seed " << seed;
      ASSERT_NEAR(v.wz, from.wz + share * dw, 1e-9) << "seed " << seed;
    }
    drive.Step();
    EXPECT_NEAR(drive.drive.motion().V_B.vx, to.vx, 1e-9) << "seed " << seed;
    EXPECT_NEAR(drive.drive.motion().V_B.wz, to.wz, 1e-9) << "seed " << seed;
  }
}

TEST(BaseDriveTest, BrakesToAStopWhenNoCommandComes) {
  robot::BaseControllerParams params = Ideal();
  params.command_timeout = 0.3;
  Drive drive(params);
  drive.Send({0.5, 0.0, 0.0});
  drive.StepFor(0.3);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.5, 1e-12);
  EXPECT_FALSE(drive.drive.motion().timed_out);
  drive.StepFor(0.1);
  EXPECT_TRUE(drive.drive.motion().timed_out);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.3, 0.005);
  EXPECT_NEAR(drive.StepFor(0.3).V_B.vx, 0.0, 1e-12);
  drive.Send({0.5, 0.0, 0.0});
  EXPECT_FALSE(drive.Step().timed_out);
  EXPECT_GT(drive.drive.motion().V_B.vx, 0.0);
}

TEST(BaseDriveTest, AControllerWithoutARampAtItsTimeoutStandsAtOnce) {
  robot::BaseControllerParams params = Ideal();
  params.command_timeout = 0.3;
  params.stops_at_timeout = true;
  Drive drive(params);
  drive.Send({0.5, 0.0, 0.0});
  EXPECT_NEAR(drive.StepFor(0.301).V_B.vx, 0.5, 1e-12);
  const BaseMotion last = drive.Step();
  EXPECT_TRUE(last.timed_out);
  EXPECT_EQ(last.V_B.vx, 0.0);
  EXPECT_FALSE(drive.Step().timed_out);
}

TEST(BaseDriveTest, ThenTheLoopAloneSoftensTheStop) {
  robot::BaseControllerParams params = LoopAlone(20.0, 0.7);
  params.command_timeout = 2.0;
  params.stops_at_timeout = true;
  Drive drive(params, 1e-5);
  drive.Send({0.55, 0.0, 0.0});
  const double x_silent = drive.StepFor(2.0).X_MB.x;
  double hardest = 0.0;
  while (drive.Now() < 4.0) hardest = std::min(hardest, drive.Step().A_B.vx);
  // Step response of a loop of second order: its steepest slope, and the area above it.
  const double w = 20.0, zeta = 0.7, root = std::sqrt(1.0 - zeta * zeta);
  EXPECT_NEAR(hardest, -0.55 * w * std::exp(-zeta / root * std::acos(zeta)), 0.01);  // 5.0
  EXPECT_NEAR(drive.drive.motion().X_MB.x - x_silent, 0.55 * 2.0 * zeta / w, 1e-4);
}

TEST(BaseDriveTest, ACommandToStandIsNeverLate) {
  robot::BaseControllerParams params = Ideal();
  params.command_timeout = 0.05;
  Drive drive(params);
  drive.Send({});
  EXPECT_FALSE(drive.StepFor(1.0).timed_out);
}

TEST(BaseDriveTest, CommandsTakeEffectAfterTheLagInTheirOrder) {
  robot::BaseControllerParams params = Ideal();
  params.command_lag = 0.05;
  Drive drive(params);
  drive.Send({0.5, 0.0, 0.0});
  EXPECT_EQ(drive.StepFor(0.02).V_B.vx, 0.0);
  drive.Send({-0.5, 0.0, 0.0});
  EXPECT_EQ(drive.StepFor(0.03).V_B.vx, 0.0);
  EXPECT_NEAR(drive.StepFor(0.02).V_B.vx, 0.04, 0.003);  // the first one's 0.02 s
  EXPECT_NEAR(drive.StepFor(0.04).V_B.vx, -0.04, 0.003);
}

TEST(BaseDriveTest, RefusesACommandFromThePast) {
  BaseDrive drive(Ideal(), {});
  drive.Send({}, 1.0);
  EXPECT_THROW(drive.Send({}, 0.5), std::logic_error);
}

struct StepResponse {
  double peak{0.0};       // share of the wanted velocity
  double peak_time{0.0};  // [s]
};

StepResponse RespondTo(const robot::BaseControllerParams& params, double dt) {
  Drive drive(params, dt);
  drive.Send({0.5, 0.0, 0.0});
  StepResponse response;
  while (drive.Now() < 1.0) {
    const double share = drive.Step().V_B.vx / 0.5;
    if (share > response.peak) response = {share, drive.Now()};
  }
  return response;
}

TEST(BaseDriveTest, LoopOvershootsAsItsClosedFormSays) {
  const double w = 20.0;
  for (const double zeta : {0.2, 0.5, 0.7}) {
    const double root = std::sqrt(1.0 - zeta * zeta);
    const double peak = 1.0 + std::exp(-geometry::kPi * zeta / root);
    const StepResponse fine = RespondTo(LoopAlone(w, zeta), 1e-5);
    EXPECT_NEAR(fine.peak, peak, 1e-3) << "zeta " << zeta;
    EXPECT_NEAR(fine.peak_time, geometry::kPi / (w * root), 1e-3) << "zeta " << zeta;
    const StepResponse real = RespondTo(LoopAlone(w, zeta), kDt);
    EXPECT_NEAR(real.peak, peak, 0.02) << "zeta " << zeta;
  }
}

TEST(BaseDriveTest, AWellDampedLoopNeverOvershoots) {
  EXPECT_LE(RespondTo(LoopAlone(20.0, 1.2), 1e-4).peak, 1.0 + 1e-9);
}

TEST(BaseDriveTest, LoopSettlesOnTheCommand) {
  Drive drive(LoopAlone(20.0, 0.7));
  drive.Send({0.4, -0.1, 0.3});
  const Twist2 v = drive.StepFor(3.0).V_B;
  EXPECT_NEAR(v.vx, 0.4, 1e-9);
  EXPECT_NEAR(v.vy, -0.1, 1e-9);
  EXPECT_NEAR(v.wz, 0.3, 1e-9);
}

TEST(BaseDriveTest, SlipTakesItsShareOfTheVelocity) {
  Drive drive(LoopAlone(30.0, 1.0));
  drive.Send({0.5, 0.0, 1.0});
  for (int i = 0; i < 2000; ++i) drive.Step(0.1);
  EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.45, 1e-9);
  EXPECT_NEAR(drive.drive.motion().V_B.wz, 0.9, 1e-9);
}

TEST(BaseDriveTest, ASuddenSlipDoesNotJumpThroughTheLoop) {
  Drive drive(LoopAlone(20.0, 0.7));
  drive.Send({0.5, 0.0, 0.0});
  drive.StepFor(3.0);
  const double before = drive.drive.motion().V_B.vx;
  EXPECT_NEAR(drive.Step(0.5).V_B.vx, before, 20.0 * 20.0 * 0.25 * kDt * kDt * 1.01);
}

/// Jerk of the ramp [m/s^3], which an ideal base follows, at its largest.
double LargestJerk(Drive* drive, const std::vector<Twist2>& commands, double each) {
  double largest = 0.0, before = drive->drive.motion().A_B.vx;
  for (const Twist2& command : commands) {
    drive->Send(command);
    for (long i = std::lround(each / drive->dt); i > 0; --i) {
      const double now = drive->Step().A_B.vx;
      largest = std::max(largest, std::abs(now - before) / drive->dt);
      before = now;
    }
  }
  return largest;
}

TEST(BaseDriveTest, JerkStaysWithinItsLimitForAnyCommands) {
  robot::BaseControllerParams params = Ideal();
  params.max_linear_jerk = 15.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    std::vector<Twist2> commands;
    for (int i = 0; i < 50; ++i) commands.push_back({rng.Uniform(-1.0, 1.0), 0.0, 0.0});
    Drive drive(params);
    EXPECT_LE(LargestJerk(&drive, commands, 0.1), 15.0 * (1.0 + 1e-6)) << "seed " << seed;
  }
}

TEST(BaseDriveTest, WithLimitedJerkTheTargetIsMet) {
  for (const double jerk : {5.0, 15.0, 100.0}) {
    robot::BaseControllerParams params = Ideal();
    params.max_linear_jerk = jerk;
    Drive drive(params);
    drive.Send({0.5, 0.2, 0.0});
    double highest = 0.0;
    for (int i = 0; i < 3000; ++i) highest = std::max(highest, drive.Step().V_B.vx);
    EXPECT_NEAR(drive.drive.motion().V_B.vx, 0.5, 1e-4) << "jerk " << jerk;
    EXPECT_NEAR(drive.drive.motion().V_B.vy, 0.2, 1e-4) << "jerk " << jerk;
    EXPECT_LE(highest, 0.5 + jerk * kDt * kDt) << "jerk " << jerk;
  }
}

TEST(BaseDriveTest, LimitedJerkTakesTheTimeOfItsClosedForm) {
  // Up with 10 m/s^3 to 2 m/s^2 in 0.2 s (0.2 m/s), 0.15 s at 2 m/s^2, 0.2 s down: 0.7 m/s.
  robot::BaseControllerParams params = Ideal();
  params.max_linear_jerk = 10.0;
  Drive drive(params);
  drive.Send({0.7, 0.0, 0.0});
  while (drive.Now() < 2.0 && drive.drive.motion().V_B.vx < 0.699) drive.Step();
  // The last 0.001 m/s takes sqrt(2 * 0.001 / 10) = 0.014 s of the 0.55 s.
  EXPECT_NEAR(drive.Now(), 0.55 - 0.014, 0.005);
}

robot::BaseControllerParams Leaning() {
  robot::BaseControllerParams params = Ideal();
  params.limits = {10.0, 2.0, 2.0, 2.0};
  params.sway_compliance = 0.005;
  return params;
}

TEST(BaseDriveTest, LeansBackWhenAcceleratingAndNoseDownWhenBraking) {
  Drive drive(Leaning());
  drive.Send({8.0, 0.0, 0.0});
  EXPECT_NEAR(drive.StepFor(3.9).pitch, -0.005 * 2.0, 1e-5);
  EXPECT_NEAR(drive.drive.motion().roll, 0.0, 1e-12);
  drive.Send({});
  EXPECT_NEAR(drive.StepFor(3.8).pitch, 0.005 * 2.0, 1e-5);
  EXPECT_NEAR(drive.StepFor(5.0).pitch, 0.0, 1e-5);
}

TEST(BaseDriveTest, LeansToTheRightWhenAcceleratingToTheLeft) {
  Drive drive(Leaning());
  drive.Send({0.0, 8.0, 0.0});
  EXPECT_NEAR(drive.StepFor(3.9).roll, 0.005 * 2.0, 1e-5);
  EXPECT_NEAR(drive.drive.motion().pitch, 0.0, 1e-12);
}

TEST(BaseDriveTest, LeaningSwingsAtItsFrequencyAndDamping) {
  robot::BaseControllerParams params = Leaning();
  params.sway_frequency = 15.0;
  params.sway_damping = 0.2;
  Drive drive(params, 1e-5);
  drive.Send({8.0, 0.0, 0.0});
  double most = 0.0;
  while (drive.Now() < 1.0) most = std::max(most, -drive.Step().pitch);
  const double overshoot = std::exp(-geometry::kPi * 0.2 / std::sqrt(1.0 - 0.04));
  EXPECT_NEAR(most, 0.01 * (1.0 + overshoot), 1e-5);
}

TEST(BaseDriveTest, ACircleEndsWhereItBegan) {
  Drive drive(LoopAlone(0.0, 1.0));
  drive.Send({0.5, 0.0, 1.0});
  const geometry::Pose2 X_MB = drive.StepFor(2.0 * geometry::kPi).X_MB;
  EXPECT_NEAR(X_MB.x, 0.0, 1e-3);
  EXPECT_NEAR(X_MB.y, 0.0, 1e-3);
  EXPECT_NEAR(std::abs(X_MB.yaw), 0.0, 1e-3);
}

TEST(BaseDriveTest, ABaseThatCannotAccelerateStands) {
  robot::BaseControllerParams params = Ideal();
  params.limits = {1.0, 1.0, 0.0, 0.0};
  Drive drive(params);
  drive.StepFor(0.1);
  drive.Send({0.5, 0.0, 0.5});
  const BaseMotion& motion = drive.StepFor(1.0);
  EXPECT_EQ(motion.X_MB.x, 0.0);
  EXPECT_EQ(motion.X_MB.yaw, 0.0);
}

TEST(BaseDriveTest, ACopyGoesOnWithTheSameBits) {
  robot::BaseControllerParams params = Leaning();
  params.command_lag = 0.03;
  params.max_linear_jerk = 20.0;
  params.loop_frequency = 20.0;
  params.loop_damping = 0.6;
  Drive original(params);
  base::Rng rng(5);
  for (int i = 0; i < 37; ++i) {
    original.Send({rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5), rng.Uniform(-1.0, 1.0)});
    original.StepFor(0.017);
  }
  Drive copy = original;
  original.Send({0.3, 0.1, 0.5});
  copy.Send({0.3, 0.1, 0.5});
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(SameBits(original.Step(0.01), copy.Step(0.01))) << "step " << i;
  }
}

/// [m] that a base that is told to stand goes on from 0.5 m/s.
double StoppingDistance(double traction) {
  robot::BaseControllerParams params = Ideal();
  params.loop_frequency = 20.0;
  params.loop_damping = 0.7;
  BaseDrive drive(params, {});
  double time = 0.0;
  const auto step_for = [&](double duration, double grip) {
    for (const double end = time + duration; time < end; time += kDt) {
      drive.Step(time, kDt, 0.0, grip);
    }
  };
  drive.Send({0.5, 0.0, 0.0}, time);
  step_for(2.0, std::numeric_limits<double>::infinity());
  const double from = drive.motion().X_MB.x;
  drive.Send({}, time);
  step_for(3.0, traction);
  return drive.motion().X_MB.x - from;
}

TEST(BaseDriveTest, WheelsThatSlideStopAsFrictionAlonePermits) {
  // v^2 / 2a, with less than half a turn of the loop, 0.05 s, before and behind it.
  EXPECT_NEAR(StoppingDistance(0.5), 0.25, 0.03);
  EXPECT_GT(StoppingDistance(0.5), 2.0 * StoppingDistance(1e6));
  EXPECT_EQ(StoppingDistance(1e6), StoppingDistance(std::numeric_limits<double>::infinity()));
}

TEST(BaseDriveTest, APushMovesABaseThatStandsAndItsLoopBringsItToRest) {
  robot::BaseControllerParams params = Ideal();
  params.loop_frequency = 20.0;
  params.loop_damping = 0.7;
  Drive pushed(params);
  pushed.drive.Push(Twist2{0.0, 1.0, 0.0});
  EXPECT_GT(pushed.StepFor(0.05).V_B.vy, 0.02);
  EXPECT_EQ(pushed.drive.motion().A_B.vx, 0.0);
  EXPECT_GT(pushed.drive.motion().A_B.vy, 0.0);
  pushed.drive.Push(std::nullopt);
  EXPECT_NEAR(pushed.StepFor(2.0).V_B.vy, 0.0, 1e-6);
}

}  // namespace
}  // namespace hires::simulation::base_drive_test
