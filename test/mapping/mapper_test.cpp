#include "hires/mapping/mapper.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

#include "hires/base/error.h"
#include "hires/mapping/map_judge.h"
#include "mapping/mapper_truth.h"
#include "support/rounds.h"
#include "support/simulated_drive.h"

namespace hires::mapping::mapper_test {
namespace {

using geometry::Pose2;
using hires::test_support::Rounds;
using localisation::RobotLog;
using mapper_truth::ExpectTrue;
using mapper_truth::TwoRoomsDrive;
using test_support::DriveThrough;
using test_support::SimulatedDrive;
using test_support::SimulatedDriveParams;
using test_support::TrajectoryRms;
using test_support::TwoRooms;

TEST(MapperTest, RoomsAreMappedWhereTheyAre) {
  for (int seed = 1; seed <= 3; ++seed) {
    const SimulatedDrive drive = TwoRoomsDrive({}, seed);
    const MapResult result = MakeMap(drive.log);
    ExpectTrue(result, drive, TwoRooms());
    EXPECT_GT(TrajectoryRms(test_support::OdometryAt(drive.truth, drive.log), drive.truth), 0.05)
        << "else nothing is shown";
    EXPECT_GT(result.num_loops, 0);
    EXPECT_EQ(result.num_lost, 0);
    EXPECT_EQ(result.odometry_jumps, 0);
    EXPECT_EQ(result.trajectory.front().X_MB.position().norm(), 0.0);
  }
}

TEST(MapperTest, OriginalMapsAreMappedAgain) {
  for (const test_support::Course& course : test_support::OriginalCourses()) {
    const std::string file = std::string(HIRES_SHARED_DATA) + "/" + course.map;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const world::OccupancyGrid world = world::LoadMap(file);
    SimulatedDriveParams params;
    for (const double error : {0.02, 0.05}) {
      SCOPED_TRACE(course.map + std::to_string(error));
      params.scale_error = error;
      const SimulatedDrive drive = DriveThrough(world, course.places, params, base::Rng(5));
      ExpectTrue(MakeMap(drive.log), drive, world);
    }
  }
}

/// Wheels that veer must not bend what the laser sees, and no door be taken for the next one.
TEST(MapperTest, LongCorridorsAreNeitherBentNorShortened) {
  const world::OccupancyGrid world = test_support::CorridorRoundABlock();
  SimulatedDriveParams params;
  params.beams = 181;
  params.veer_error = 0.04;
  for (int seed = 1; seed <= 2; ++seed) {
    const SimulatedDrive drive =
        DriveThrough(world, test_support::CourseRoundABlock(), params, base::Rng(seed));
    const MapResult result = MakeMap(drive.log);
    EXPECT_LE(TrajectoryRms(result.trajectory, drive.truth), 0.3) << seed;
    EXPECT_GT(TrajectoryRms(test_support::OdometryAt(drive.truth, drive.log), drive.truth), 10.0)
        << "else nothing is shown";
  }
}

/// Odometry that errs by a tenth, along 33 m of corridor.
/// Odometry that says more of all ways to the east, and less of those to the west.
void StretchEastward(double by, RobotLog* log) {
  Eigen::Vector2d told = log->odometry.front().reading.X_OB.position(), before = told;
  for (RobotLog::Odometry& odometry : log->odometry) {
    Pose2& X_OB = odometry.reading.X_OB;
    const Eigen::Vector2d step = X_OB.position() - before;
    before = X_OB.position();
    told += Eigen::Vector2d(step.x() + by * std::abs(step.x()), step.y());
    X_OB = {told.x(), told.y(), X_OB.yaw};
  }
}

/// Who comes back 9 m beside where he began still knows the place, and takes no niche of the
/// corridor for another.
TEST(MapperTest, LoopsThatAreMetresOffAreTied) {
  SimulatedDriveParams params;
  params.beams = 181;
  params.range_max = 8.0;
  params.scale_error = params.veer_error = 0.0;
  std::vector<Eigen::Vector2d> course = test_support::CourseRoundABlock();
  course.insert(course.end(), {{48.0, 2.0}, {48.0, 12.0}});
  for (int seed = 1; seed <= Rounds(8); ++seed) {
    SCOPED_TRACE(seed);
    SimulatedDrive drive =
        DriveThrough(test_support::CorridorRoundABlock(), course, params, base::Rng(seed));
    StretchEastward(0.1, &drive.log);
    const MapResult result = MakeMap(drive.log);
    EXPECT_GE(result.num_loops, 3);
    // The way to the first corner is odometry's for ever: nobody saw where it began.
    EXPECT_LE(TrajectoryRms(result.trajectory, drive.truth), 1.5);
  }
}

TEST(MapperTest, BadOdometryDoesNotStretchTheOriginalCorridor) {
  HIRES_LONG_CASE();
  const test_support::Course course = test_support::OriginalCourses().at(1);
  const std::string file = std::string(HIRES_SHARED_DATA) + "/" + course.map;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const world::OccupancyGrid world = world::LoadMap(file);
  SimulatedDriveParams params;
  params.scale_error = params.veer_error = 0.1;
  params.step_error = 0.3;
  for (int seed = 11; seed <= 13; ++seed) {
    const SimulatedDrive drive = DriveThrough(world, course.places, params, base::Rng(seed));
    ExpectTrue(MakeMap(drive.log), drive, world, 0.07);
  }
}

/// Back at the beginning the laser looks to the side: one wall does not tell where along it.
TEST(MapperTest, WhatIsNotToldIsNoLargeCorrection) {
  const test_support::Course course = test_support::OriginalCourses().at(0);
  const std::string file = std::string(HIRES_SHARED_DATA) + "/" + course.map;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const world::OccupancyGrid world = world::LoadMap(file);
  SimulatedDriveParams params;
  params.beams = 181;
  params.range_noise = 0.03;
  params.range_max = 8.0;
  const SimulatedDrive drive = DriveThrough(world, course.places, params, base::Rng(12));
  ExpectTrue(MakeMap(drive.log), drive, world);
}

TEST(MapperTest, MapMayLieInTheFrameOfTheWorld) {
  const SimulatedDrive drive = TwoRoomsDrive();
  MapperParams params;
  params.X_MBegin = drive.truth.front().X_MB;
  const MapResult result = MakeMap(drive.log, params);
  EXPECT_EQ(result.trajectory.front().X_MB.position(), params.X_MBegin.position());
  EXPECT_EQ(result.trajectory.front().X_MB.yaw, params.X_MBegin.yaw);
  const auto seen = FacesThatWereSeen(TwoRooms(), drive.log.scans, drive.truth, params.max_range);
  const WallErrors walls = JudgeWalls(result.grid, TwoRooms(), {}, seen);
  EXPECT_LE(walls.to_world.median, 0.05) << "without a motion that fits it";
  EXPECT_LE(walls.to_map.median, 0.05);
}

TEST(MapperTest, SameLogGivesTheSameMap) {
  const SimulatedDrive drive = TwoRoomsDrive();
  const MapResult one = MakeMap(drive.log), other = MakeMap(drive.log);
  EXPECT_EQ(one.grid.cells, other.grid.cells);
  ASSERT_EQ(one.trajectory.size(), other.trajectory.size());
  for (std::size_t i = 0; i < one.trajectory.size(); ++i) {
    EXPECT_EQ(one.trajectory[i].X_MB.x, other.trajectory[i].X_MB.x);
    EXPECT_EQ(one.trajectory[i].X_MB.yaw, other.trajectory[i].X_MB.yaw);
  }
}

TEST(MapperTest, LaserMayLookBackward) {
  SimulatedDriveParams params;
  params.X_BL = {-0.2, 0.1, geometry::kPi};
  const SimulatedDrive drive = TwoRoomsDrive(params);
  ExpectTrue(MakeMap(drive.log), drive, TwoRooms());
}

TEST(MapperTest, BlindScansStandWhereOdometrySays) {
  SimulatedDrive drive = TwoRoomsDrive();
  for (std::size_t i = 200; i < 225; ++i)
    for (float& range : drive.log.scans[i].reading.ranges)
      range = i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  const MapResult result = MakeMap(drive.log);
  EXPECT_EQ(result.num_lost, 25);
  ExpectTrue(result, drive, TwoRooms());
}

TEST(MapperTest, SilenceOfTenSecondsIsBridged) {
  SimulatedDrive drive = TwoRoomsDrive();
  const auto is_silent = [](const auto& reading) { return reading.time > 20 && reading.time < 30; };
  const auto forget = [&](auto* readings) {
    readings->erase(std::remove_if(readings->begin(), readings->end(), is_silent), readings->end());
  };
  forget(&drive.log.scans);
  forget(&drive.truth);
  forget(&drive.log.odometry);
  ExpectTrue(MakeMap(drive.log), drive, TwoRooms());
}

TEST(MapperTest, ScanWaitsForTheOdometryAfterIt) {
  const SimulatedDrive drive = TwoRoomsDrive();
  Mapper mapper;
  for (const RobotLog::Scan& scan : drive.log.scans) mapper.AddScan(scan);
  for (const RobotLog::Odometry& odometry : drive.log.odometry) mapper.AddOdometry(odometry);
  const MapResult late = mapper.Result();
  EXPECT_EQ(late.grid.cells, MakeMap(drive.log).grid.cells);
}

TEST(MapperTest, NewestPoseCountsAndSketchAreThoseOfTheResult) {
  const SimulatedDrive drive = TwoRoomsDrive();
  Mapper mapper;
  EXPECT_FALSE(mapper.newest());
  for (const RobotLog::Odometry& odometry : drive.log.odometry) mapper.AddOdometry(odometry);
  for (std::size_t i = 0; i < drive.log.scans.size(); ++i) {
    mapper.AddScan(drive.log.scans[i]);
    if (i % 100 != 0 && i + 1 != drive.log.scans.size()) continue;
    const MapCounts counts = mapper.counts();
    const auto newest = mapper.newest();
    const MapResult result = mapper.Result();
    ASSERT_TRUE(newest);
    EXPECT_EQ(newest->time, result.trajectory.back().time);
    const geometry::Pose2 last = result.trajectory.back().X_MB;
    EXPECT_EQ(newest->X_MB.position(), last.position());
    EXPECT_EQ(newest->X_MB.yaw, last.yaw);
    EXPECT_EQ(counts.num_keyframes, result.num_keyframes);
    EXPECT_EQ(counts.num_loops, result.num_loops);
    EXPECT_EQ(Draw(mapper.sketch()).cells, result.grid.cells);
  }
  EXPECT_GT(mapper.counts().num_loops, 0);
}

TEST(MapperTest, LogsWithoutMeasurementsAreRefused) {
  EXPECT_THROW(MakeMap({}), base::ConfigError);
  SimulatedDrive drive = TwoRoomsDrive();
  for (RobotLog::Scan& scan : drive.log.scans)
    std::fill(scan.reading.ranges.begin(), scan.reading.ranges.end(), 81.9F);
  try {
    MakeMap(drive.log);
    ADD_FAILURE() << "there is no map";
  } catch (const base::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("all its ranges are 81.9, as a laser says where"),
              std::string::npos)
        << error.what();
  }
}

TEST(MapperTest, RangesInAnotherUnitAreAskedAbout) {
  for (const auto& [factor, unit] :
       {std::pair<float, const char*>{100.0F, "centimetres"}, {1000.0F, "millimetres"}}) {
    SimulatedDrive drive = TwoRoomsDrive();
    for (RobotLog::Scan& scan : drive.log.scans) {
      for (float& range : scan.reading.ranges) range *= factor;
      scan.reading.range_max *= factor;
    }
    try {
      MakeMap(drive.log);
      ADD_FAILURE() << unit;
    } catch (const base::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(unit), std::string::npos) << error.what();
    }
  }
}

TEST(MapperTest, TimesThatGoBackAreTheCallersError) {
  Mapper mapper;
  mapper.AddScan({2.0, {}, {}, {}});
  EXPECT_THROW(mapper.AddScan({1.0, {}, {}, {}}), std::logic_error);
  mapper.AddOdometry({2.0, {}});
  EXPECT_THROW(mapper.AddOdometry({1.0, {}}), std::logic_error);
}

}  // namespace
}  // namespace hires::mapping::mapper_test
