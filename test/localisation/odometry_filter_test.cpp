#include "hires/localisation/odometry_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::localisation::odometry_filter_test {
namespace {

using geometry::Pose2;
using geometry::WrapToPi;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Pose2 kStep{0.025, 0.0, 0.01};  // in kPeriod
constexpr double kPeriod = 0.05;      // [s]

/// One thing the filter hears; yaw of the unit, or a pose of the wheels.
struct Event {
  double time;
  bool is_inertia;
  Pose2 X_OB;
};

FilterOutcome Hear(const Event& event, OdometryFilter* filter) {
  if (event.is_inertia) return filter->OnInertia(event.time, {event.X_OB.yaw, 0.0});
  return filter->OnOdometry(event.time, {event.X_OB, {}});
}

/// An arc by steady steps.
std::vector<Event> Wheels(int steps, const Pose2& start = {}) {
  std::vector<Event> events{{0.0, false, start}};
  for (int i = 1; i <= steps; ++i)
    events.push_back({i * kPeriod, false, events.back().X_OB * kStep});
  return events;
}

OdometryFilter After(const std::vector<Event>& events) {
  OdometryFilter filter({});
  for (const Event& event : events) Hear(event, &filter);
  return filter;
}

void ExpectPose(const Pose2& is, const Pose2& wanted, double tolerance) {
  EXPECT_NEAR(is.x, wanted.x, tolerance);
  EXPECT_NEAR(is.y, wanted.y, tolerance);
  EXPECT_NEAR(WrapToPi(is.yaw - wanted.yaw), 0.0, tolerance);
}

TEST(OdometryFilterTest, OdometryAloneIsIntegrated) {
  const std::vector<Event> events = Wheels(400, {1.0, -2.0, 0.7});
  ExpectPose(After(events).X_FB(), events.back().X_OB, 1e-9);
}

TEST(OdometryFilterTest, VariancesGrowAsTheParametersSay) {
  std::vector<Event> straight{{0.0, false, {}}};
  for (int i = 1; i <= 100; ++i) straight.push_back({i * kPeriod, false, {0.05 * i, 0.0, 0.0}});
  const Eigen::Matrix3d P = After(straight).Covariance();
  const OdometryFilterParams params;
  EXPECT_NEAR(P(0, 0), 5.0 * params.position_per_metre, 1e-9);
  EXPECT_NEAR(P(2, 2), 5.0 * params.yaw_per_metre, 1e-9);
  // Heading errs by a random walk, so across the way: q s^3 / 3.
  EXPECT_NEAR(P(1, 1), 5.0 * params.position_per_metre + params.yaw_per_metre * 125.0 / 3.0, 5e-4);
}

TEST(OdometryFilterTest, VarianceDoesNotDependOnHowOftenTheWheelsReport) {
  const std::vector<Event> all = Wheels(400);
  std::vector<Event> some;
  for (std::size_t i = 0; i < all.size(); i += 4) some.push_back(all[i]);
  const Eigen::Matrix3d often = After(all).Covariance(), seldom = After(some).Covariance();
  // Up to 1.5 steps of 100: when within a step the heading erred.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(often(axis, axis) / seldom(axis, axis), 1.0, 0.02) << axis;
}

TEST(OdometryFilterTest, CovarianceStaysSymmetricAndPositive) {
  base::Rng rng(3);
  OdometryFilter filter({});
  Pose2 X_OB;
  for (int i = 0; i < 2000; ++i) {
    X_OB = X_OB * Pose2{0.02, 0.0, rng.Normal(0.0, 0.02)};
    filter.OnInertia(i * kPeriod + 0.01, {X_OB.yaw + rng.Normal(0.0, 1e-3), 0.0});
    filter.OnOdometry(i * kPeriod, {X_OB, {}});
    const Eigen::Matrix3d P = filter.Covariance();
    ASSERT_EQ(P, P.transpose());
    ASSERT_GE(P.eigenvalues().real().minCoeff(), -1e-12);
  }
}

TEST(OdometryFilterTest, HeadingOfTheUnitCorrectsWheelsThatTurnTooFar) {
  OdometryFilter filter({});
  Pose2 wheels, truth;
  constexpr double kZero = 2.5;  // [rad] of the unit
  for (int i = 0; i <= 400; ++i) {
    filter.OnInertia(i * kPeriod, {WrapToPi(truth.yaw + kZero), 0.0});
    filter.OnOdometry(i * kPeriod, {wheels, {}});
    truth = truth * Pose2{0.025, 0.0, 0.01};
    wheels = wheels * Pose2{0.025, 0.0, 0.011};
  }
  // Wheels alone are 0.4 rad and metres off by then.
  EXPECT_NEAR(WrapToPi(filter.X_FB().yaw - 400 * 0.01), 0.0, 0.01);
  EXPECT_LT(filter.Covariance()(2, 2), 1e-4);
}

TEST(OdometryFilterTest, EstimateDoesNotDependOnTheOrderOfArrival) {
  OdometryFilter waits({}), comes_in_order({});
  const std::vector<Event> wheels = Wheels(200);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const Event inertia{wheels[i].time - 0.01, true, wheels[i].X_OB};
    const Event next{wheels[i].time - 0.03, true, wheels[i].X_OB};
    Hear(next, &waits);
    Hear(inertia, &waits);
    Hear(wheels[i], &waits);
  }
  std::vector<Event> early;
  for (const Event& wheel : wheels) {
    early.push_back({wheel.time - 0.03, true, wheel.X_OB});
    early.push_back({wheel.time - 0.01, true, wheel.X_OB});
  }
  for (const Event& event : early) Hear(event, &comes_in_order);
  for (const Event& event : wheels) Hear(event, &comes_in_order);
  EXPECT_EQ(waits.Covariance(), comes_in_order.Covariance());
  ExpectPose(waits.X_FB(), comes_in_order.X_FB(), 0.0);
}

TEST(OdometryFilterTest, InertiaFromBeforeTheFirstOdometryIsLeftOut) {
  OdometryFilter with({}), without({});
  for (int i = 0; i < 20; ++i) with.OnInertia(0.1 * i, {0.3 * std::sin(i), 0.0});
  for (OdometryFilter* filter : {&with, &without}) {
    filter->OnOdometry(2.0, {Pose2{0.0, 0.0, 0.0}, {}});
    filter->OnOdometry(2.1, {Pose2{0.1, 0.0, 0.0}, {}});
  }
  EXPECT_EQ(with.Covariance(), without.Covariance());
  ExpectPose(with.X_FB(), {0.1, 0.0, 0.0}, 1e-12);
}

TEST(OdometryFilterTest, JumpMovesNothingAndAddsTheVarianceThatIsStated) {
  OdometryFilter filter = After(Wheels(100));
  const Pose2 before = filter.X_FB();
  const Eigen::Matrix3d P = filter.Covariance();
  filter.OnInertia(5.01, {0.0, 0.0});  // waits: from before the jump
  EXPECT_EQ(filter.OnOdometry(5.05, {Pose2{50.0, 0.0, 1.0}, {}}), FilterOutcome::kJumped);
  const OdometryFilterParams params;
  ExpectPose(filter.X_FB(), before, 0.0);
  const Eigen::Vector3d grown = (filter.Covariance() - P).diagonal();
  EXPECT_NEAR(grown[0], params.jump_position_sd * params.jump_position_sd, 1e-12);
  EXPECT_NEAR(grown[1], params.jump_position_sd * params.jump_position_sd, 1e-12);
  EXPECT_NEAR(grown[2], params.jump_yaw_sd * params.jump_yaw_sd, 1e-12);
  filter.OnOdometry(5.10, {Pose2{50.0, 0.0, 1.0} * kStep, {}});
  ExpectPose(filter.X_FB(), before * kStep, 1e-12);
}

TEST(OdometryFilterTest, UnitTellsTheHeadingAfterAJumpOfTheWheels) {
  OdometryFilter filter({});
  filter.OnInertia(0.0, {1.0, 0.0});
  filter.OnOdometry(0.0, {Pose2{}, {}});
  filter.OnInertia(0.1, {1.1, 0.0});  // it did turn while the wheels were reset
  EXPECT_EQ(filter.OnOdometry(0.1, {Pose2{9.0, 9.0, 3.0}, {}}), FilterOutcome::kJumped);
  filter.OnInertia(0.2, {1.1, 0.0});
  filter.OnOdometry(0.2, {Pose2{9.0, 9.0, 3.0}, {}});
  EXPECT_NEAR(filter.X_FB().yaw, 0.1, 1e-3);
}

TEST(OdometryFilterTest, NewZeroOfTheUnitTurnsNothing) {
  OdometryFilter filter({});
  const std::vector<Event> wheels = Wheels(100);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (i == 50) filter.BeginNewZero();
    filter.OnInertia(wheels[i].time, {wheels[i].X_OB.yaw + (i < 50 ? 0.0 : 0.2), 0.0});
    Hear(wheels[i], &filter);
  }
  ExpectPose(filter.X_FB(), wheels.back().X_OB, 1e-9);
}

TEST(OdometryFilterTest, NewZeroIsKnownAlsoWhereItsFirstReadingIsDropped) {
  OdometryFilter filter({});
  filter.OnInertia(0.0, {0.0, 0.0});
  filter.OnOdometry(0.0, {Pose2{}, {}});
  filter.BeginNewZero();
  filter.OnInertia(0.1, {0.2, 0.0});  // from before the jump
  filter.OnOdometry(0.15, {Pose2{9.0, 9.0, 0.0}, {}});
  filter.OnInertia(0.2, {0.2, 0.0});
  filter.OnOdometry(0.2, {Pose2{9.0, 9.0, 0.0}, {}});
  EXPECT_NEAR(filter.X_FB().yaw, 0.0, 1e-9);
}

TEST(OdometryFilterTest, TimeThatGoesBackKeepsTheEstimateAndAddsVariance) {
  OdometryFilter filter = After(Wheels(100));
  const Pose2 before = filter.X_FB();
  const double variance = filter.Covariance()(2, 2);
  EXPECT_EQ(filter.OnOdometry(0.0, {Pose2{}, {}}), FilterOutcome::kTimeWentBack);
  const OdometryFilterParams params;
  ExpectPose(filter.X_FB(), before, 0.0);
  EXPECT_EQ(filter.time(), 0.0);
  EXPECT_NEAR(filter.Covariance()(2, 2) - variance, params.jump_yaw_sd * params.jump_yaw_sd, 1e-12);
  EXPECT_EQ(filter.OnOdometry(kPeriod, {kStep, {}}), FilterOutcome::kTaken);
  ExpectPose(filter.X_FB(), before * kStep, 1e-12);
}

/// Wheels and a second source whose readings come when newer ones have been heard already.
TEST(OdometryFilterTest, OdometryThatIsALittleLateIsLeftOutAndChangesNothing) {
  const std::vector<Event> wheels = Wheels(200);
  OdometryFilter alone({}), mixed({});
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    alone.OnInertia(wheels[i].time, {wheels[i].X_OB.yaw, 0.0});
    mixed.OnInertia(wheels[i].time, {wheels[i].X_OB.yaw, 0.0});
    Hear(wheels[i], &alone);
    Hear(wheels[i], &mixed);
    EXPECT_EQ(Hear(wheels[i - 1], &mixed), FilterOutcome::kLate);
  }
  EXPECT_EQ(mixed.time(), wheels.back().time);
  EXPECT_EQ(mixed.Covariance(), alone.Covariance());
  ExpectPose(mixed.X_FB(), alone.X_FB(), 0.0);
}

TEST(OdometryFilterTest, UnitThatRestartsInAGapTurnsNothing) {
  const std::vector<Event> wheels = Wheels(200);
  const OdometryFilterParams params;
  for (const double restarted : {0.0, 0.1, 0.25, 1.0}) {
    OdometryFilter filter(params);
    for (const Event& wheel : wheels) {
      const bool is_before = wheel.time<3.0, is_after = wheel.time> 3.2 + params.imu_timeout;
      if (is_before || is_after)
        filter.OnInertia(wheel.time, {wheel.X_OB.yaw + (is_after ? restarted : 0.0), 0.0});
      Hear(wheel, &filter);
    }
    ExpectPose(filter.X_FB(), wheels.back().X_OB, 1e-9);
  }
}

TEST(OdometryFilterTest, BadReadingsAreNamedAndChangeNothing) {
  OdometryFilter filter = After(Wheels(10));
  const Pose2 before = filter.X_FB();
  EXPECT_EQ(filter.OnOdometry(kNan, {Pose2{}, {}}), FilterOutcome::kNotFinite);
  EXPECT_EQ(filter.OnOdometry(1.0, {Pose2{kNan, 0.0, 0.0}, {}}), FilterOutcome::kNotFinite);
  EXPECT_EQ(filter.OnOdometry(1.0, {Pose2{}, {kNan, 0.0, 0.0}}), FilterOutcome::kNotFinite);
  EXPECT_EQ(filter.OnInertia(1.0, {kNan, 0.0}), FilterOutcome::kNotFinite);
  EXPECT_EQ(filter.OnInertia(0.1, {0.0, 0.0}), FilterOutcome::kLate);
  ExpectPose(filter.X_FB(), before, 0.0);
}

TEST(OdometryFilterTest, GapsAreNamed) {
  OdometryFilter filter = After(Wheels(10));
  EXPECT_EQ(filter.OnOdometry(3.0, {Pose2{0.3, 0.0, 0.1}, {}}), FilterOutcome::kAfterGap);
  EXPECT_EQ(filter.OnInertia(3.1, {0.0, 0.0}), FilterOutcome::kTaken);
  EXPECT_EQ(filter.OnInertia(9.0, {0.0, 0.0}), FilterOutcome::kAfterGap);
}

TEST(OdometryFilterTest, InertiaWithoutOdometryDoesNotPileUp) {
  OdometryFilter filter({});
  FilterOutcome outcome = FilterOutcome::kTaken;
  for (int i = 0; i < 5000; ++i) outcome = filter.OnInertia(0.01 * i, {0.0, 0.0});
  EXPECT_EQ(outcome, FilterOutcome::kTooMany);
  EXPECT_FALSE(filter.has_estimate());
}

}  // namespace
}  // namespace hires::localisation::odometry_filter_test
