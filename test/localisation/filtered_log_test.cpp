#include "hires/localisation/filtered_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/localisation/heading_feed.h"
#include "support/simulated_drive.h"

namespace hires::localisation::filtered_log_test {
namespace {

using geometry::Pose2;
using geometry::WrapToPi;
using test_support::SimulatedDrive;

/// Odometry turns too far by a tenth; no inertia yet.
struct ErringDrive {
  SimulatedDrive exact, wheels;
};

ErringDrive DriveThroughRooms() {
  const world::OccupancyGrid rooms = test_support::TwoRooms();
  test_support::SimulatedDriveParams params = test_support::ExactOdometry();
  params.beams = 2;
  ErringDrive drive;
  drive.exact = test_support::DriveThrough(rooms, test_support::CourseThroughTwoRooms(), params,
                                           base::Rng(1));
  drive.wheels = drive.exact;
  test_support::ScaleTurns(1.1, &drive.wheels.log);
  return drive;
}

double ErrorOf(const RobotLog& log, const SimulatedDrive& drive) {
  return test_support::TrajectoryRms(test_support::OdometryAt(drive.truth, log), drive.truth);
}

RobotLog Filtered(RobotLog log, std::vector<RobotLog::Inertia> inertia) {
  log.inertia = std::move(inertia);
  FilterOdometry({}, &log);
  return log;
}

/// Turns on the spot at 0.1 rad/s for `duration` [s]; wheels say a tenth more.
RobotLog TurnOnTheSpot(double duration, double unit_period) {
  RobotLog log;
  for (int i = 0; 0.1 * i <= duration; ++i)
    log.odometry.push_back({0.1 * i, {{0.0, 0.0, WrapToPi(0.011 * i)}, {}}});
  for (int i = 0; unit_period * i <= duration; ++i)
    log.inertia.push_back({unit_period * i, {}, 0.1});
  return log;
}

void ForgetBetween(double begin, double end, std::vector<RobotLog::Inertia>* inertia) {
  const auto is_between = [&](const auto& reading) {
    return reading.time > begin && reading.time < end;
  };
  inertia->erase(std::remove_if(inertia->begin(), inertia->end(), is_between), inertia->end());
}

double LastYaw(RobotLog log) {
  FilterOdometry({}, &log);
  return log.odometry.back().reading.X_OB.yaw;
}

TEST(FilterOdometryTest, OdometryWithoutInertiaStaysAsItIs) {
  RobotLog log = DriveThroughRooms().wheels.log;
  log.odometry[7].reading.V_B = {0.1, 0.2, std::numeric_limits<double>::quiet_NaN()};
  const RobotLog before = log;
  EXPECT_EQ(FilterOdometry({}, &log), 0);
  ASSERT_EQ(log.odometry.size(), before.odometry.size());
  for (std::size_t i = 0; i < log.odometry.size(); ++i) {
    const Pose2 off = before.odometry[i].reading.X_OB.Inverse() * log.odometry[i].reading.X_OB;
    EXPECT_LT(off.position().norm() + std::abs(WrapToPi(off.yaw)), 1e-9);
    EXPECT_EQ(log.odometry[i].time, before.odometry[i].time);
  }
  EXPECT_EQ(log.odometry[7].reading.V_B.vy, 0.2);
}

TEST(FilterOdometryTest, RatesCorrectWheelsThatTurnTooFar) {
  const ErringDrive drive = DriveThroughRooms();
  EXPECT_GT(ErrorOf(drive.wheels.log, drive.exact), 1.0);
  for (const double period : {0.002, 0.01, 0.05, 0.1, 0.2}) {
    const auto rates = test_support::RatesOf(drive.exact.log, period, {}, base::Rng(2));
    EXPECT_LT(ErrorOf(Filtered(drive.wheels.log, rates), drive.exact), 0.4) << period << " s";
  }
}

TEST(FilterOdometryTest, YawGoesBeforeTheRateWhereTheUnitTellsIt) {
  const ErringDrive drive = DriveThroughRooms();
  std::vector<RobotLog::Inertia> inertia;
  for (const RobotLog::Odometry& odometry : drive.exact.log.odometry) {
    inertia.push_back({odometry.time, WrapToPi(odometry.reading.X_OB.yaw + 2.5),
                       std::numeric_limits<double>::quiet_NaN()});
  }
  EXPECT_LT(ErrorOf(Filtered(drive.wheels.log, inertia), drive.exact), 0.02);
}

TEST(FilterOdometryTest, TurnWithinAGapOfTheRatesIsThatOfTheWheels) {
  RobotLog log = TurnOnTheSpot(6.0, 0.01);
  EXPECT_NEAR(LastYaw(log), 0.6, 2e-3);
  ForgetBetween(1.995, 4.0, &log.inertia);
  EXPECT_NEAR(LastYaw(log), 0.6 + 0.02, 2e-3) << "a tenth of the 0.2 rad in the gap";
}

TEST(FilterOdometryTest, TurnWithinAGapOfAUnitThatTellsYawIsTheUnits) {
  RobotLog log = TurnOnTheSpot(6.0, 0.01);
  for (RobotLog::Inertia& inertia : log.inertia) inertia.yaw = 0.1 * inertia.time - 1.0;
  ForgetBetween(1.995, 2.9, &log.inertia);
  EXPECT_NEAR(LastYaw(log), 0.6, 2e-3);
}

TEST(FilterOdometryTest, TurnWithinALongGapOfAUnitThatTellsYawIsThatOfTheWheels) {
  RobotLog log = TurnOnTheSpot(6.0, 0.01);
  for (RobotLog::Inertia& inertia : log.inertia) inertia.yaw = 0.1 * inertia.time - 1.0;
  ForgetBetween(1.995, 4.0, &log.inertia);
  EXPECT_NEAR(LastYaw(log), 0.6 + 0.02, 2e-3) << "it may have restarted in 2 s";
}

TEST(HeadingFeedTest, RatesThatAreALittleLateAreLeftOut) {
  OdometryFilter alone({}), mixed({});
  HeadingFeed steady(&alone), interleaved(&mixed);
  for (int i = 0; i < 300; ++i) {
    const RobotLog::Inertia now{0.01 * i, {}, 0.5}, late{0.01 * i - 0.05, {}, -3.0};
    steady.Take(now);
    interleaved.Take(now);
    if (i > 0) {
      EXPECT_EQ(interleaved.Take(late), FilterOutcome::kLate);
    }
    for (OdometryFilter* filter : {&alone, &mixed})
      filter->OnOdometry(now.time, {Pose2{0.0, 0.0, 0.4 * now.time}, {}});
  }
  EXPECT_NEAR(alone.X_FB().yaw, 0.5 * 2.99, 0.01);
  EXPECT_EQ(mixed.X_FB().yaw, alone.X_FB().yaw);
}

TEST(HeadingFeedTest, AClockThatBeginsAgainIsAnotherZero) {
  OdometryFilter filter({});
  HeadingFeed feed(&filter);
  for (const double start : {100.0, 0.0}) {
    for (int i = 0; i <= 100; ++i) {
      const double time = start + 0.01 * i;
      const double yaw = 0.15 * (time - start + (start == 0.0 ? 1.0 : 0.0));
      EXPECT_EQ(filter.OnOdometry(time, {Pose2{0.0, 0.0, yaw}, {}}),
                start == 0.0 && i == 0 ? FilterOutcome::kTimeWentBack : FilterOutcome::kTaken);
      EXPECT_EQ(feed.Take({time, {}, 0.2}), FilterOutcome::kTaken) << time;
    }
  }
  EXPECT_NEAR(filter.X_FB().yaw, 0.4, 0.01);
}

TEST(FilterOdometryTest, UnitMayTellYawAtTimesOnly) {
  RobotLog log = TurnOnTheSpot(6.0, 0.01);
  for (RobotLog::Inertia& inertia : log.inertia)
    if (inertia.time > 2.0 && inertia.time < 4.0) inertia.yaw = 0.1 * inertia.time - 1.0;
  EXPECT_NEAR(LastYaw(log), 0.6, 3e-3);
}

TEST(FilterOdometryTest, RatesTooSeldomToBeIntegratedChangeNothing) {
  EXPECT_NEAR(LastYaw(TurnOnTheSpot(6.0, 0.5)), 0.66, 1e-9);
}

TEST(FilterOdometryTest, InertiaFromBeforeAndAfterTheOdometryDoesNoHarm) {
  RobotLog log = TurnOnTheSpot(30.0, 0.01);
  auto& odometry = log.odometry;
  odometry.erase(odometry.begin() + 100, odometry.end());
  odometry.erase(odometry.begin(), odometry.begin() + 50);
  EXPECT_NEAR(LastYaw(log), 0.55 + 0.1 * 4.9, 2e-3);
}

TEST(FilterOdometryTest, ResetOfTheOdometryIsCountedAndMovesNothing) {
  RobotLog log = TurnOnTheSpot(6.0, 0.01);
  for (std::size_t i = 30; i < log.odometry.size(); ++i)
    log.odometry[i].reading.X_OB = Pose2{50.0, 5.0, 1.0} * log.odometry[i].reading.X_OB;
  EXPECT_EQ(FilterOdometry({}, &log), 1);
  EXPECT_LT(log.odometry.back().reading.X_OB.position().norm(), 1e-9);
  EXPECT_NEAR(log.odometry.back().reading.X_OB.yaw, 0.6, 2e-3);
}

}  // namespace
}  // namespace hires::localisation::filtered_log_test
