#include "hires/navigation/base_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "navigation/guarded_base.h"

namespace hires::navigation::base_guard_test {
namespace {

using geometry::Twist2;
using test_support::GuardedBase;
using test_support::kTick;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(BaseGuardTest, StandsUntilSomebodyAsks) {
  GuardedBase base;
  base.has_request = false;
  base.command = Twist2{0.3, 0.0, 0.0};
  base.TickFor(0.5);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_EQ(ToString(base.guard.failure()), "no_request");
  EXPECT_EQ(base.guard.request(), 0u);
  EXPECT_FALSE(base.sent.has_value());
}

TEST(BaseGuardTest, PassesWhatARequestAllows) {
  GuardedBase base;
  base.Drive({0.3, 0.05, 0.4});
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_EQ(base.guard.request(), 1u);
  EXPECT_EQ(ToString(base.guard.failure()), "");
  ASSERT_TRUE(base.sent);
  EXPECT_EQ(base.sent->vx, 0.3);
  EXPECT_EQ(base.sent->vy, 0.05);
  EXPECT_EQ(base.sent->wz, 0.4);
}

TEST(BaseGuardTest, ClipsSpeedsAndKeepsTheirDirection) {
  GuardedBase base;
  base.Drive({0.6, 0.8, 0.5});
  ASSERT_TRUE(base.sent);
  EXPECT_NEAR(std::hypot(base.sent->vx, base.sent->vy), 0.55, 1e-12);
  EXPECT_NEAR(base.sent->vy / base.sent->vx, 8.0 / 6.0, 1e-12);
  EXPECT_NEAR(base.sent->wz, 0.275, 1e-12);
  base.Drive({0.1, 0.0, -2.0});
  EXPECT_NEAR(base.sent->wz, -1.0, 1e-12);
  EXPECT_NEAR(base.sent->vx, 0.05, 1e-12);
}

TEST(BaseGuardTest, ACommandFromBeforeTheRequestMovesNothing) {
  GuardedBase base;
  base.has_request = false;
  base.command = Twist2{0.3, 0.0, 0.0};
  base.TickFor(0.1);
  base.has_request = true;
  base.command.reset();
  base.TickFor(0.1);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_FALSE(base.sent.has_value());
}

/// Something goes wrong while the base drives at 0.5 m/s.
struct Trouble {
  std::string name;
  std::function<void(GuardedBase*)> happen;
  std::string reason;
  double patience;  ///< [s] after which the guard must have seen it
};

class TroubleTest : public ::testing::TestWithParam<Trouble> {};

TEST_P(TroubleTest, EndsInAGentleStopAndThenNothingMoves) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  GetParam().happen(&base);
  const double before = base.now;
  while (base.guard.state() == GuardState::kPassing && base.now < before + 5.0) base.Tick();
  EXPECT_EQ(base.guard.state(), GuardState::kBraking);
  EXPECT_LE(base.now - before, GetParam().patience + 2.0 * kTick);
  EXPECT_THAT(ToString(base.guard.failure()), StartsWith(GetParam().reason));
  EXPECT_EQ(base.guard.request(), 1u);
  EXPECT_NEAR(base.guard.stop_time(), StoppingTime(0.5, {1.2, 3.5}), 1e-9);
  EXPECT_NEAR(base.guard.stop_distance(), StoppingDistance(0.5, {1.2, 3.5}), 1e-9);
  base.TickFor(base.guard.stop_time() + 2.0 * kTick);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  ASSERT_TRUE(base.sent);
  EXPECT_EQ(base.sent->vx, 0.0);
  base.command = Twist2{0.5, 0.0, 0.0};
  base.TickFor(2.0);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_FALSE(base.sent.has_value());  // zeros have ended too
  EXPECT_THAT(ToString(base.guard.failure()), StartsWith(GetParam().reason));
}

INSTANTIATE_TEST_SUITE_P(
    All, TroubleTest,
    ::testing::Values(
        Trouble{"MotorsHalted", [](GuardedBase* b) { b->guard.OnMotorsHalted(true); },
                "motors_halted", 0.0},
        Trouble{"Odometry", [](GuardedBase* b) { b->has_odometry = false; },
                "stale_pose: 0.32 s, odometry", 0.3},
        Trouble{"BaseTransform", [](GuardedBase* b) { b->has_base_transform = false; },
                "stale_pose: 0.32 s, base_transform", 0.3},
        Trouble{"MapTransform", [](GuardedBase* b) { b->has_map_transform = false; },
                "stale_pose: 0.32 s, map_transform", 0.3},
        Trouble{"Scan", [](GuardedBase* b) { b->has_scan = false; },
                "stale_scan: 0.32 s, at most 0.3 s (scan_patience)", 0.3},
        Trouble{"Localisation", [](GuardedBase* b) { b->guard.OnLocalisation(0.62, 0.1); },
                "localisation_lost: sd 0.62 m", 0.0},
        Trouble{"Heading", [](GuardedBase* b) { b->guard.OnLocalisation(0.1, 0.9); },
                "localisation_lost: sd 0.90 rad", 0.0},
        Trouble{"NoNumber", [](GuardedBase* b) { b->guard.OnLocalisation(kNan, 0.1); },
                "localisation_lost: sd nan m", 0.0},
        Trouble{"Hindrance",
                [](GuardedBase* b) { b->guard.OnHindrance(base::FailureCode::kGuardEnds); },
                "guard_ends", 0.0},
        Trouble{"MiddleLayer", [](GuardedBase* b) { b->has_request = false; },
                "silent_middle_layer: 0.12 s, at most 0.1 s (request_patience)", 0.1},
        Trouble{"Commands", [](GuardedBase* b) { b->command.reset(); },
                "silent_commands: 0.26 s, at most 0.25 s (command_patience)", 0.25},
        Trouble{"BadCommand",
                [](GuardedBase* b) {
                  b->command = Twist2{kNan, 0.0, 0.0};
                },
                "bad_command", 0.0},
        Trouble{"Suspended", [](GuardedBase* b) { b->now += 1.0; },
                "late_guard: 1.02 s, at most 0.15 s (update_patience)", 0.0},
        Trouble{"BadRequest", [](GuardedBase* b) { b->request.limits.max_linear_velocity = -1.0; },
                "bad_request: max_linear_velocity is -1", 0.0},
        Trouble{"Over", [](GuardedBase* b) { b->request.id = 0; }, "request_over", 0.0}),
    [](const auto& info) { return info.param.name; });

TEST(BaseGuardTest, StopsOfADeadMiddleLayerBeginBeforeTheControllersTimeout) {
  GuardedBase base;
  base.Drive({0.55, 0.0, 0.0});
  base.has_request = false;
  base.command.reset();
  const double died = base.now;
  double longest_gap = 0.0, last_sent = base.now;
  while (base.guard.state() != GuardState::kStanding) {
    if (base.Tick()) {
      longest_gap = std::max(longest_gap, base.now - last_sent);
      last_sent = base.now;
    }
    if (base.guard.state() == GuardState::kPassing) {
      EXPECT_LT(base.now - died, 0.2);
    }
  }
  EXPECT_LT(longest_gap, 0.2);
}

TEST(BaseGuardTest, OneLateCycleIsBridged) {
  GuardedBase base;
  base.Drive({0.4, 0.0, 0.0});
  base.command.reset();
  base.TickFor(0.2);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  ASSERT_TRUE(base.sent);
  EXPECT_EQ(base.sent->vx, 0.4);
}

TEST(BaseGuardTest, WhoStandsMayBeSilent) {
  GuardedBase base;
  base.Drive({0.0, 0.0, 0.0});
  base.command.reset();
  base.TickFor(3.0);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_FALSE(base.sent.has_value());
}

TEST(BaseGuardTest, TroubleAtAStandNeedsNoRamp) {
  GuardedBase base;
  base.Drive({0.0, 0.0, 0.0});
  base.guard.OnMotorsHalted(true);
  base.Tick();
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_EQ(base.guard.stop_time(), 0.0);
}

TEST(BaseGuardTest, ANewRequestDrivesOnceAllIsWell) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.guard.OnMotorsHalted(true);
  base.TickFor(2.0);
  base.request.id = 2;
  base.TickFor(0.5);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_EQ(base.guard.request(), 2u);  // it is the new one that is refused now
  EXPECT_EQ(ToString(base.guard.failure()), "motors_halted");
  base.guard.OnMotorsHalted(false);
  base.TickFor(0.1);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_EQ(base.guard.request(), 2u);
  EXPECT_EQ(base.sent->vx, 0.5);
}

TEST(BaseGuardTest, AStoppedRequestNeverComesBack) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.has_scan = false;
  base.TickFor(2.0);
  base.has_scan = true;
  base.TickFor(2.0);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  base.request.id = 2;
  base.TickFor(0.5);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  base.request.id = 1;  // of no use: number 2 is silent now
  base.TickFor(2.0);
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_THAT(ToString(base.guard.failure()), StartsWith("silent_middle_layer"));
}

TEST(BaseGuardTest, ARequestThatComesWhileBrakingWaitsForTheStand) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.request.id = 0;
  base.Tick();
  base.request.id = 2;
  double speed = base.sent->vx;
  while (base.guard.state() == GuardState::kBraking) {
    base.Tick();
    if (base.guard.state() != GuardState::kBraking) break;
    EXPECT_LE(base.sent->vx, speed);
    speed = base.sent->vx;
  }
  base.TickFor(0.2);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_EQ(base.guard.request(), 2u);
}

TEST(BaseGuardTest, AnotherRequestMayTakeOver) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.request.id = 7;
  base.request.limits.max_linear_velocity = 0.3;
  base.Tick();
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  EXPECT_EQ(base.guard.request(), 7u);
  EXPECT_NEAR(base.sent->vx, 0.3, 1e-12);
}

/// Where the ramp begins of a base that was told 0.5 m/s.
double RampBegin(double measured) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.measured = {measured, 0.0, 0.0};
  base.guard.OnMotorsHalted(true);
  base.Tick();
  return base.sent->vx;
}

TEST(BaseGuardTest, RampsFromTheMeasuredSpeedButForWhatTheWheelsTrail) {
  EXPECT_NEAR(RampBegin(0.05), 0.25, 1e-9);  // it has only begun to drive, or is held back
  EXPECT_NEAR(RampBegin(0.4), 0.5, 1e-9);    // it follows
  EXPECT_NEAR(RampBegin(0.54), 0.5, 1e-9);   // it slows down
  EXPECT_NEAR(RampBegin(0.9), 0.55, 1e-9);   // somebody pushes; never beyond the request's limits
}

TEST(BaseGuardTest, WithoutOdometryItRampsFromWhatWasSent) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.has_odometry = false;
  base.measured = {};
  base.TickFor(0.34);
  EXPECT_EQ(base.guard.state(), GuardState::kBraking);
  EXPECT_GT(base.sent->vx, 0.45);
}

TEST(BaseGuardTest, StampsFromTheFutureCountAsNow) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.has_scan = false;
  base.guard.OnScan(base.now + 100.0, base.now);
  base.TickFor(0.4);
  EXPECT_THAT(ToString(base.guard.failure()), StartsWith("stale_scan"));
}

TEST(BaseGuardTest, OldMessagesAreAsOldAsTheirStamps) {
  GuardedBase base;
  base.Drive({0.5, 0.0, 0.0});
  base.has_scan = false;
  for (int i = 0; i < 20; ++i) {
    base.guard.OnScan(base.now - 0.35, base.now);
    base.Tick();
  }
  EXPECT_THAT(ToString(base.guard.failure()), StartsWith("stale_scan: 0.3"));
}

TEST(BaseGuardTest, SaysWhatNeverCame) {
  struct Missing {
    std::function<void(GuardedBase*)> omit;
    std::string reason;
  };
  for (const Missing& missing :
       {Missing{[](GuardedBase* b) { b->has_odometry = false; }, "no_pose: odometry"},
        Missing{[](GuardedBase* b) { b->has_base_transform = false; }, "no_pose: base_transform"},
        Missing{[](GuardedBase* b) { b->has_map_transform = false; }, "no_pose: map_transform"},
        Missing{[](GuardedBase* b) { b->has_scan = false; }, "no_scan"}}) {
    GuardedBase base;
    missing.omit(&base);
    base.Drive({0.5, 0.0, 0.0});
    EXPECT_EQ(base.guard.state(), GuardState::kStanding);
    EXPECT_EQ(ToString(base.guard.failure()), missing.reason);
    EXPECT_EQ(ToString(base.guard.WhatForbidsDriving(base.now)), missing.reason);
  }
  BaseGuard guard{BaseGuardParams{}};
  guard.OnRequest({1, {0.5, 1.0, 1.0, 1.0}, {1.0, 1.0}}, 0.0);
  guard.Update(0.0);
  EXPECT_EQ(ToString(guard.failure()), "no_motors_state");
}

TEST(BaseGuardTest, WhatTheRobotDoesNotHaveIsNotMissed) {
  BaseGuardParams params;
  params.needs_scan = params.needs_motors_state = params.needs_localisation = false;
  BaseGuard guard(params);
  guard.OnOdometry({}, 0.0, 0.0);
  guard.OnTransform(PoseSource::kBaseTransform, 0.0, 0.0);
  guard.OnTransform(PoseSource::kMapTransform, 0.0, 0.0);
  EXPECT_FALSE(guard.WhatForbidsDriving(0.0));  // also while nobody asks
  guard.OnRequest({1, {0.5, 1.0, 1.0, 1.0}, {1.0, 1.0}}, 0.0);
  guard.Update(0.0);
  EXPECT_EQ(guard.state(), GuardState::kPassing);
}

TEST(BaseGuardTest, UnknownAndOverboldBrakingBecomesTheGuardsOwn) {
  BaseGuardParams params;
  params.braking.unknown_load = {0.8, 2.0};
  params.braking.hardest = {1.5, 6.0};
  const auto stop_time = [&](const BrakingLimits& asked) {
    GuardedBase base(params);
    base.request.braking = asked;
    base.Drive({0.5, 0.0, 0.0});
    base.guard.OnMotorsHalted(true);
    base.Tick();
    return base.guard.stop_time();
  };
  EXPECT_NEAR(stop_time({0.0, 0.0}), StoppingTime(0.5, {0.8, 2.0}), 1e-9);
  EXPECT_NEAR(stop_time({9.0, 90.0}), StoppingTime(0.5, {1.5, 6.0}), 1e-9);
  EXPECT_NEAR(stop_time({1.0, 3.0}), StoppingTime(0.5, {1.0, 3.0}), 1e-9);
}

TEST(BaseGuardTest, WhoIsHeldWaitsAndIsNotRefused) {
  GuardedBase base;
  base.guard.OnHold(true);
  base.Drive({0.4, 0.0, 0.0});
  EXPECT_EQ(base.guard.state(), GuardState::kStanding);
  EXPECT_EQ(base.guard.request(), 0u);
  EXPECT_EQ(base.guard.Applicant(base.now), 1u);
  base.guard.OnHold(false);
  base.TickFor(0.1);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  base.guard.OnHold(true);  // who drives already goes on
  base.TickFor(0.5);
  EXPECT_EQ(base.guard.state(), GuardState::kPassing);
  base.request.id = 2;  // but nobody takes over from him
  base.Tick();
  EXPECT_EQ(base.guard.state(), GuardState::kBraking);
  EXPECT_EQ(ToString(base.guard.failure()), "request_over");
}

TEST(BaseGuardTest, WhoIsSilentOrOverIsNoApplicant) {
  GuardedBase base;
  EXPECT_EQ(base.guard.Applicant(base.now), 0u);
  base.Drive({0.4, 0.0, 0.0});
  EXPECT_EQ(base.guard.Applicant(base.now), 1u);
  EXPECT_EQ(base.guard.Applicant(base.now + 0.2), 0u);
  base.guard.OnMotorsHalted(true);
  base.Tick();
  EXPECT_EQ(base.guard.Applicant(base.now), 0u);
}

TEST(DriveRequestTest, DefectsAreNamed) {
  DriveRequest request{1, {0.5, 1.0, 1.0, 1.0}, {1.0, 2.0}};
  EXPECT_EQ(Defect(request), "");
  request.braking = {0.0, 0.0};
  EXPECT_EQ(Defect(request), "");
  request.braking = {0.001, 2.0};
  EXPECT_THAT(Defect(request), HasSubstr("max_braking is 0.001"));
  request.braking = {1.0, kNan};
  EXPECT_THAT(Defect(request), HasSubstr("max_braking_jerk is nan"));
  request.braking = {1.0, 2.0};
  request.limits.max_angular_acceleration = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Defect(request), HasSubstr("max_angular_acceleration is inf"));
}

}  // namespace
}  // namespace hires::navigation::base_guard_test
