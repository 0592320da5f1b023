#include "localisation/laser_maximum.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/rounds.h"
#include "support/simulated_drive.h"

namespace hires::localisation::laser_maximum_test {
namespace {

using test_support::SimulatedDriveParams;
using ::testing::HasSubstr;

/// A drive as a file with ranges of that digit [m] tells it, which says no maximum.
RobotLog LogOf(const SimulatedDriveParams& params, double digit, int seed) {
  RobotLog log =
      test_support::DriveThrough(test_support::RoomsWithShelf(),
                                 test_support::CourseThroughTwoRooms(), params, base::Rng(seed))
          .log;
  for (RobotLog::Scan& scan : log.scans) {
    scan.reading.range_max = 80.0;
    for (float& range : scan.reading.ranges)
      range = static_cast<float>(std::round(range / digit) * digit);
  }
  return log;
}

TEST(LaserMaximumTest, WhatStandsForNothingIsKnownByItsFrequency) {
  const int count = hires::test_support::Rounds(24);
  for (int seed = 1; seed <= count; ++seed) {
    base::Rng draw(seed);
    SimulatedDriveParams params;
    params.range_max = 0.01 * std::floor(draw.Uniform(200.0, 400.0));
    params.range_noise = draw.Uniform(0.0, 0.02);
    params.beams = seed % 2 ? 181 : 361;
    const double digit = seed % 3 ? 0.01 : 0.001;
    RobotLog log = LogOf(params, digit, seed);
    EXPECT_THAT(TakeLaserMaximum(&log), HasSubstr("largest range")) << seed;
    for (const RobotLog::Scan& scan : log.scans)
      ASSERT_NEAR(scan.reading.range_max, params.range_max, 0.0051) << seed;
    EXPECT_EQ(TakeLaserMaximum(&log), "") << "the log says it now";
  }
}

TEST(LaserMaximumTest, WallsThatAreFarAreNone) {
  const int count = hires::test_support::Rounds(24);
  for (int seed = 1; seed <= count; ++seed) {
    base::Rng draw(100 + seed);
    SimulatedDriveParams params;  // no wall is as far as 30 m
    params.range_noise = seed % 4 ? draw.Uniform(0.003, 0.02) : 0.0;
    params.beams = seed % 2 ? 181 : 361;
    RobotLog log = LogOf(params, seed % 3 ? 0.01 : 0.001, seed);
    EXPECT_EQ(TakeLaserMaximum(&log), "") << seed;
    EXPECT_EQ(log.scans.front().reading.range_max, 80.0);
  }
}

/// A robot that faces one flat wall, which is the farthest thing it sees, for the whole drive.
TEST(LaserMaximumTest, AFlatWallIsNone) {
  const int count = hires::test_support::Rounds(24);
  for (int seed = 1; seed <= count; ++seed) {
    base::Rng rng(200 + seed);
    const double noise = rng.Uniform(0.005, 0.03), far = rng.Uniform(3.0, 20.0);
    const double digit = seed % 2 ? 0.01 : 0.001;
    RobotLog log;
    for (int i = 0; i < 300; ++i) {
      const double y = 0.01 * i;  // along the wall
      log.odometry.push_back({0.1 * i, {{0.0, y, 0.0}, {}}});
      RobotLog::Scan scan;
      scan.time = 0.1 * i;
      scan.reading = {-0.2, 0.01, 0.01, {}, 80.0};
      for (int k = 0; k <= 40; ++k) {
        const double range = far / std::cos(-0.2 + 0.01 * k) + rng.Normal(0.0, noise);
        scan.reading.ranges.push_back(static_cast<float>(std::round(range / digit) * digit));
      }
      log.scans.push_back(scan);
    }
    EXPECT_EQ(TakeLaserMaximum(&log), "") << seed;
  }
}

TEST(LaserMaximumTest, LogsOfNothingSayNothing) {
  RobotLog log;
  EXPECT_EQ(TakeLaserMaximum(&log), "");
  log.odometry.resize(1);
  EXPECT_EQ(TakeLaserMaximum(&log), "");
  log.scans.resize(2);
  log.scans[0].reading.ranges = {NAN, INFINITY};
  EXPECT_EQ(TakeLaserMaximum(&log), "");
}

}  // namespace
}  // namespace hires::localisation::laser_maximum_test
