#include "hires/mapping/map_doubt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/rounds.h"
#include "support/simulated_drive.h"

namespace hires::mapping::map_doubt_test {
namespace {

using localisation::RobotLog;
using test_support::DriveThrough;
using test_support::SimulatedDrive;
using test_support::SimulatedDriveParams;
using test_support::TrajectoryRms;
using testing::HasSubstr;
using testing::Not;

std::string DoubtOf(const MapResult& result) { return WhyDoubtful(result, result.evidence); }

SimulatedDrive TwoRoomsDrive(const SimulatedDriveParams& params, int seed) {
  return DriveThrough(test_support::TwoRooms(), test_support::CourseThroughTwoRooms(), params,
                      base::Rng(seed));
}

/// A plain corridor of 2 m round a block, one and a third times.
SimulatedDrive RingDrive(const SimulatedDriveParams& params, int seed) {
  world::OccupancyGrid ring{0.05, 420, 240, {0.0, 0.0}, {}};
  ring.cells.assign(std::size_t{420} * 240, world::Cell::kOccupied);
  for (int row = 10; row < 230; ++row) {
    for (int column = 10; column < 410; ++column) {
      const bool is_block = row >= 50 && row < 190 && column >= 50 && column < 370;
      if (!is_block) ring.cells[row * 420 + column] = world::Cell::kFree;
    }
  }
  return DriveThrough(
      ring,
      {{1.5, 1.5}, {19.5, 1.5}, {19.5, 10.5}, {1.5, 10.5}, {1.5, 1.5}, {19.5, 1.5}, {19.5, 6.0}},
      params, base::Rng(seed));
}

TEST(MapDoubtTest, NothingSpeaksAgainstGoodMaps) {
  SimulatedDriveParams params;
  for (int seed = 1; seed <= hires::test_support::Rounds(8); ++seed) {
    params.range_noise = 0.01 * (1 + seed % 3);
    params.scale_error = 0.02 * (1 + seed % 2);
    for (const bool is_ring : {false, true}) {
      SCOPED_TRACE(testing::Message() << seed << " " << is_ring);
      const SimulatedDrive drive = is_ring ? RingDrive(params, seed) : TwoRoomsDrive(params, seed);
      const MapResult result = MakeMap(drive.log);
      ASSERT_LE(TrajectoryRms(result.trajectory, drive.truth), 0.2);
      EXPECT_EQ(DoubtOf(result), "");
      EXPECT_EQ(WhatToDo(result, result.evidence), "");
      EXPECT_GT(result.evidence.num_beams, 1000);
    }
  }
}

/// People walk by: a fifth of the beams end nearer, each time elsewhere.
TEST(MapDoubtTest, PeopleAreNoReasonForDoubt) {
  for (int seed = 1; seed <= hires::test_support::Rounds(8); ++seed) {
    SimulatedDrive drive = TwoRoomsDrive({}, seed);
    base::Rng rng = base::Rng(seed).Fork(1);
    for (RobotLog::Scan& scan : drive.log.scans) {
      auto& ranges = scan.reading.ranges;
      for (int person = 0; person < 3; ++person) {
        const std::size_t first = rng.Index(static_cast<int>(ranges.size()) - 25);
        const float range = static_cast<float>(rng.Uniform(0.7, 3.0));
        for (std::size_t i = first; i < first + 25; ++i) ranges[i] = std::min(ranges[i], range);
      }
    }
    const MapResult result = MakeMap(drive.log);
    ASSERT_LE(TrajectoryRms(result.trajectory, drive.truth), 0.2) << seed;
    EXPECT_EQ(DoubtOf(result), "") << seed;
  }
}

/// Where no loop is tied, the second lap lies beside the first one.
TEST(MapDoubtTest, LapBesideAnotherIsDoubtful) {
  SimulatedDriveParams params;
  params.scale_error = params.step_error = 0.0;
  params.range_max = 8.0;
  params.veer_error = 0.0;
  MapperParams never;
  never.min_fit = 1.1;
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    SimulatedDrive drive = RingDrive(params, seed);
    geometry::Pose2 before = drive.log.odometry.front().reading.X_OB, X_OB = before;
    for (auto& odometry : drive.log.odometry) {  // ways to the east are told too long, others not
      geometry::Pose2 step = before.Inverse() * odometry.reading.X_OB;
      before = odometry.reading.X_OB;
      step.x *= std::cos(before.yaw) > 0.5 ? 1.04 + 0.01 * (seed % 4) : 1.0;
      X_OB = X_OB * step;
      odometry.reading.X_OB = X_OB;
    }
    const MapResult untied = MakeMap(drive.log, never);
    ASSERT_GT(TrajectoryRms(untied.trajectory, drive.truth), 0.1) << "else nothing is shown";
    EXPECT_THAT(DoubtOf(untied), HasSubstr("loops are not tied")) << seed;
    EXPECT_THAT(WhatToDo(untied, untied.evidence), HasSubstr("seen before"));
  }
}

TEST(MapDoubtTest, BeamsInReverseOrderAreDoubtful) {
  for (int seed = 1; seed <= hires::test_support::Rounds(8); ++seed) {
    SimulatedDrive drive = TwoRoomsDrive({}, seed);
    for (RobotLog::Scan& scan : drive.log.scans)
      std::reverse(scan.reading.ranges.begin(), scan.reading.ranges.end());
    const MapResult result = MakeMap(drive.log);
    ASSERT_GT(TrajectoryRms(result.trajectory, drive.truth), 0.5);
    EXPECT_NE(DoubtOf(result), "") << seed;
    EXPECT_THAT(WhatToDo(result, result.evidence), HasSubstr("order")) << seed;
  }
}

void ScaleRanges(float factor, RobotLog* log) {
  for (RobotLog::Scan& scan : log->scans) {
    for (float& range : scan.reading.ranges) range *= factor;
    scan.reading.range_max *= factor;
  }
}

/// Such a map agrees with itself: only odometry tells how large it is.
TEST(MapDoubtTest, RangesInAnotherUnitThanTheOdometryAreDoubtful) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    for (const float factor : {0.5F, 1.5F, 2.0F, 3.2808F}) {
      SimulatedDrive drive = TwoRoomsDrive({}, seed);
      ScaleRanges(factor, &drive.log);
      const MapResult result = MakeMap(drive.log);
      SCOPED_TRACE(testing::Message() << seed << " " << factor << " " << result.ways_alike);
      EXPECT_THAT(DoubtOf(result), HasSubstr("times as far as odometry tells"));
      EXPECT_THAT(WhatToDo(result, result.evidence),
                  HasSubstr(factor > 3.0F ? "are the ranges in feet" : "both in metres"));
    }
  }
}

TEST(MapDoubtTest, OdometryOfAnotherScaleIsDoubtful) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    for (const double factor : {0.5, 2.0}) {
      SimulatedDrive drive = TwoRoomsDrive({}, seed);
      for (RobotLog::Odometry& odometry : drive.log.odometry) {
        odometry.reading.X_OB.x *= factor;
        odometry.reading.X_OB.y *= factor;
      }
      const MapResult result = MakeMap(drive.log);
      SCOPED_TRACE(testing::Message() << seed << " " << factor << " " << result.ways_alike);
      EXPECT_THAT(DoubtOf(result), HasSubstr("times as far as odometry tells"));
    }
  }
}

/// Lasers of other fields of view, written as FLASER, which always means 180 degrees.
TEST(MapDoubtTest, AnotherFieldOfViewIsDoubtfulAndNamed) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    for (const double degrees : {130.0, 240.0}) {
      SimulatedDriveParams params;
      params.field_of_view = degrees * geometry::kPi / 180.0;
      params.beams = 342;
      SimulatedDrive drive = TwoRoomsDrive(params, seed);
      for (RobotLog::Scan& scan : drive.log.scans) {
        scan.reading.angle_min = -geometry::kPi / 2.0;
        scan.reading.angle_increment = geometry::kPi / (params.beams - 1);
        scan.is_field_assumed = true;  // as the log's reader says of 342 ranges
      }
      const MapResult result = MakeMap(drive.log);
      SCOPED_TRACE(testing::Message() << seed << " " << degrees << " " << result.turns_alike);
      EXPECT_TRUE(result.evidence.is_field_assumed);
      EXPECT_THAT(DoubtOf(result), HasSubstr("of the turns that odometry tells"));
      EXPECT_THAT(WhatToDo(result, result.evidence), HasSubstr("not the 180"));
    }
  }
}

/// Wheels of a base that skids tell more turns than it makes; the laser mends the map.
TEST(MapDoubtTest, ABaseThatSkidsIsNoReasonForDoubt) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    SimulatedDrive drive = TwoRoomsDrive({}, seed);
    geometry::Pose2 before = drive.log.odometry.front().reading.X_OB, X_OB = before;
    for (RobotLog::Odometry& odometry : drive.log.odometry) {
      geometry::Pose2 step = before.Inverse() * odometry.reading.X_OB;
      before = odometry.reading.X_OB;
      step.yaw *= 1.4;
      X_OB = X_OB * step;
      odometry.reading.X_OB = X_OB;
    }
    const MapResult result = MakeMap(drive.log);
    SCOPED_TRACE(testing::Message() << seed << " " << result.turns_alike);
    ASSERT_LE(TrajectoryRms(result.trajectory, drive.truth), 0.2);
    EXPECT_FALSE(result.evidence.is_field_assumed);
    EXPECT_EQ(DoubtOf(result), "");
  }
}

/// x and y in each other's place, or a laser that looks to the side, and the log says ahead: ways
/// are as long as odometry tells, but go elsewhere.
TEST(MapDoubtTest, WaysInAnotherDirectionThanTheOdometryAreDoubtful) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    SimulatedDrive swapped = TwoRoomsDrive({}, seed), aside = TwoRoomsDrive({}, seed);
    for (RobotLog::Odometry& odometry : swapped.log.odometry)
      std::swap(odometry.reading.X_OB.x, odometry.reading.X_OB.y);
    for (RobotLog::Scan& scan : aside.log.scans) scan.X_BL.yaw += geometry::kPi / 2.0;
    for (const SimulatedDrive* drive : {&swapped, &aside}) {
      const MapResult result = MakeMap(drive->log);
      SCOPED_TRACE(testing::Message() << seed << " " << result.num_disagreed);
      EXPECT_THAT(DoubtOf(result), HasSubstr("laser and odometry disagreed on"));
      EXPECT_THAT(WhatToDo(result, result.evidence), HasSubstr("the laser's place on the robot"));
    }
  }
}

/// Between scan and scan it tells other turns than the laser; over a while it does not.
TEST(MapDoubtTest, LateOdometryIsNoReasonForDoubt) {
  for (int seed = 1; seed <= hires::test_support::Rounds(4); ++seed) {
    for (const double late : {0.2, 0.4}) {
      SimulatedDrive drive = TwoRoomsDrive({}, seed);
      for (RobotLog::Odometry& odometry : drive.log.odometry) odometry.time += late;
      const MapResult result = MakeMap(drive.log);
      SCOPED_TRACE(testing::Message() << seed << " " << late << " " << result.turns_alike);
      EXPECT_NEAR(result.ways_alike, 1.0, 0.1);
      EXPECT_THAT(DoubtOf(result), Not(HasSubstr("of the turns")));
      EXPECT_THAT(DoubtOf(result), Not(HasSubstr("disagreed on")));
    }
  }
}

/// The robot is turned by hand where it stands, and nothing tells it.
TEST(MapDoubtTest, BreakOfTheMapIsDoubtful) {
  int num_wrong = 0;
  for (int seed = 1; seed <= hires::test_support::Rounds(12); ++seed) {
    SimulatedDrive drive = TwoRoomsDrive({}, seed);
    auto& odometry = drive.log.odometry;
    const std::size_t begin = odometry.size() / 2;
    const geometry::Pose2 X_OB = odometry[begin].reading.X_OB;
    const geometry::Pose2 turned{0.0, 0.0, (seed % 2 == 0 ? 1.0 : -1.0) * (0.9 + 0.05 * seed)};
    for (std::size_t i = begin; i < odometry.size(); ++i)
      odometry[i].reading.X_OB = X_OB * turned * X_OB.Inverse() * odometry[i].reading.X_OB;
    MapperParams params;
    params.max_angular_speed = 100.0;  // taken for a motion, not for a reset
    const MapResult result = MakeMap(drive.log, params);
    if (TrajectoryRms(result.trajectory, drive.truth) <= 0.5) continue;
    ++num_wrong;
    EXPECT_NE(DoubtOf(result), "") << seed;
  }
  EXPECT_GT(num_wrong, 0);
}

TEST(MapDoubtTest, CellsOfAnySizeAreJudgedAlike) {
  SimulatedDrive drive = TwoRoomsDrive({}, 1);
  for (const double resolution : {0.02, 0.2, 1.0}) {
    MapperParams params;
    params.resolution = resolution;
    const MapResult result = MakeMap(drive.log, params);
    EXPECT_EQ(DoubtOf(result), "") << resolution;
    EXPECT_GT(result.evidence.num_beams, 1000) << resolution;
  }
}

TEST(MapDoubtTest, EachReasonIsSaidWithARemedy) {
  MapCounts counts;
  counts.num_scans = 90;
  MapEvidence evidence;
  EXPECT_EQ(WhyDoubtful(counts, evidence), "");
  counts.num_searched = 3;
  EXPECT_EQ(WhyDoubtful(counts, evidence), "") << "alone no reason: the laser was right";
  counts.num_lost = 31;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("31 of 90 scans fitted nothing"));
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("odometry disagreed: 3"));
  EXPECT_THAT(WhatToDo(counts, evidence), HasSubstr("reaches walls"));
  counts = {};
  evidence.returns = {10, 4};
  EXPECT_EQ(WhyDoubtful(counts, evidence), "");
  evidence.returns = {10, 5};
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("5 of 10 places"));
  evidence = {};
  evidence.through_walls = 0.012;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("1.2 % of the beams went through"));
  evidence = {};
  counts.turns_alike = -0.9;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("opposite directions"));
  counts.turns_alike = 0.4;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("40 % of the turns"));
  counts = {};
  for (const double alike : {0.84, 1.2}) {
    counts.turns_alike = counts.ways_alike = alike;
    EXPECT_EQ(WhyDoubtful(counts, evidence), "");
  }
  counts = {};
  counts.turns_alike = 0.75;
  evidence.field_of_view = geometry::kPi;
  EXPECT_EQ(WhyDoubtful(counts, evidence), "") << "as of a base that skids";
  evidence.is_field_assumed = true;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("75 % of the turns"));
  EXPECT_THAT(WhatToDo(counts, evidence), HasSubstr("see 240 degrees, as the odometry's turns say, "
                                                    "and not the 180"));
  counts = {};
  for (const auto& [alike, question] :
       {std::pair<double, const char*>{3.3, "ranges in feet? Divide them by 3.2808"},
        {0.3, "odometry in feet"},
        {98.0, "ranges in centimetres"},
        {0.001, "odometry in millimetres"},
        {1.5, "both in metres"}}) {
    counts.ways_alike = alike;
    EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("times as far as odometry tells"));
    EXPECT_THAT(WhatToDo(counts, evidence), HasSubstr(question)) << alike;
  }
  counts = {};
  counts.num_stretches = 100;
  counts.num_disagreed = 75;
  EXPECT_EQ(WhyDoubtful(counts, evidence), "");
  counts.num_disagreed = 76;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("disagreed on 76 of 100 stretches"));
  counts = {};
  evidence.explained = 0.55;
  EXPECT_THAT(WhyDoubtful(counts, evidence), HasSubstr("55 % of the beams ended"));
  EXPECT_THAT(WhatToDo(counts, evidence), HasSubstr("order, angles and unit"));
  counts.num_scans = 100;
  counts.odometry_jumps = 20;
  EXPECT_THAT(WhatToDo(counts, evidence), Not(HasSubstr("millimetres")));
  counts.odometry_jumps = 21;
  EXPECT_THAT(WhatToDo(counts, evidence),
              HasSubstr("odometry jumped 21 times at 100 scans: is it"));
}

}  // namespace
}  // namespace hires::mapping::map_doubt_test
