// Odometry that jumps, comes late, misses turns, or is good enough not to be touched.
#include <gtest/gtest.h>

#include <map>

#include "hires/mapping/mapper.h"
#include "mapping/mapper_truth.h"
#include "support/rounds.h"
#include "support/simulated_drive.h"

namespace hires::mapping::mapper_odometry_test {
namespace {

using geometry::Pose2;
using hires::test_support::Rounds;
using localisation::RobotLog;
using mapper_truth::Errors;
using mapper_truth::ErrorsOf;
using mapper_truth::ExpectTrue;
using mapper_truth::TwoRoomsDrive;
using test_support::DriveThrough;
using test_support::SimulatedDrive;
using test_support::SimulatedDriveParams;
using test_support::TrajectoryRms;
using test_support::TwoRooms;

/// Half way through the drive odometry moves the base by `jump`.
void Reset(const geometry::Pose2& jump, std::size_t more, RobotLog* log) {
  auto& odometry = log->odometry;
  const std::size_t begin = odometry.size() / 2 + more;
  const geometry::Pose2 X_OB = odometry[begin].reading.X_OB;
  for (std::size_t i = begin; i < odometry.size(); ++i)
    odometry[i].reading.X_OB = X_OB * jump * X_OB.Inverse() * odometry[i].reading.X_OB;
}

/// As a log of lines FLASER.
void LetScansTellOdometry(RobotLog* log) {
  for (RobotLog::Scan& scan : log->scans) {
    for (const auto& reading : log->odometry)
      if (reading.time == scan.time) scan.X_OB = reading.reading.X_OB;
  }
}

TEST(MapperOdometryTest, OdometryThatIsResetIsNoMotion) {
  for (const geometry::Pose2& jump :
       {geometry::Pose2{10.0, -5.0, 1.0}, geometry::Pose2{0.3, 0.0, geometry::kPi},
        geometry::Pose2{0.0, 0.0, -2.0}}) {
    for (const bool scans_tell : {false, true}) {
      SCOPED_TRACE(testing::Message() << jump.x << " " << jump.yaw << " " << scans_tell);
      SimulatedDrive drive = TwoRoomsDrive();
      Reset(jump, 0, &drive.log);
      if (scans_tell) LetScansTellOdometry(&drive.log);
      const MapResult result = MakeMap(drive.log);
      EXPECT_EQ(result.odometry_jumps, 1);
      ExpectTrue(result, drive, TwoRooms());
    }
  }
}

/// Between two readings of which one is of the new frame nothing is interpolated.
TEST(MapperOdometryTest, OdometryMayBeResetBetweenScans) {
  HIRES_LONG_CASE();
  for (std::size_t more = 0; more < 4; ++more) {
    SimulatedDrive drive = TwoRoomsDrive();
    Reset({0.3, 0.0, geometry::kPi}, more, &drive.log);
    for (RobotLog::Scan& scan : drive.log.scans) scan.time += 0.02;
    for (localisation::TimedPose& pose : drive.truth) pose.time += 0.02;
    const MapResult result = MakeMap(drive.log);
    EXPECT_EQ(result.odometry_jumps, 1);
    ExpectTrue(result, drive, TwoRooms());
  }
}

bool IsTurnInPlace(const RobotLog& log, std::size_t i) {
  const auto& odometry = log.odometry;
  return i > 0 && odometry[i].reading.X_OB.position() == odometry[i - 1].reading.X_OB.position();
}

/// Readings of each turn in place come and are stamped within 10 ms at its end.
void SendTurnsInBursts(SimulatedDrive* drive) {
  std::map<double, double> stamp_of;
  auto& odometry = drive->log.odometry;
  for (std::size_t begin = 0; begin < odometry.size();) {
    std::size_t end = begin + 1;
    while (end < odometry.size() && IsTurnInPlace(drive->log, end)) ++end;
    const double last = odometry[end - 1].time;
    for (std::size_t i = begin; i < end; ++i) {
      const double share = static_cast<double>(i - begin + 1) / static_cast<double>(end - begin);
      stamp_of[odometry[i].time] =
          end - begin > 1 && i > begin ? last - 0.01 * (1.0 - share) : odometry[i].time;
    }
    begin = end;
  }
  for (auto& reading : odometry) reading.time = stamp_of.at(reading.time);
  for (RobotLog::Scan& scan : drive->log.scans) scan.time = stamp_of.at(scan.time);
  for (localisation::TimedPose& pose : drive->truth) pose.time = stamp_of.at(pose.time);
}

TEST(MapperOdometryTest, BurstsOfLateReadingsAreNoReset) {
  SimulatedDriveParams params;
  params.turn_rate = 3.0;  // 0.15 rad from reading to reading
  for (int seed = 1; seed <= 2; ++seed) {
    SimulatedDrive drive = TwoRoomsDrive(params, seed);
    const MapResult before = MakeMap(drive.log);
    SendTurnsInBursts(&drive);
    for (const bool scans_tell : {false, true}) {
      if (scans_tell) LetScansTellOdometry(&drive.log);
      const MapResult result = MakeMap(drive.log);
      EXPECT_EQ(result.odometry_jumps, 0);
      EXPECT_LE(TrajectoryRms(result.trajectory, drive.truth),
                0.02 + TrajectoryRms(before.trajectory, drive.truth));
    }
  }
}

/// Every second turn in place is told by a share only.
void MissTurns(double told, RobotLog* log) {
  const RobotLog whole = *log;
  geometry::Pose2 X_OB = whole.odometry.front().reading.X_OB;
  int num_turns = 0;
  for (std::size_t i = 1; i < whole.odometry.size(); ++i) {
    geometry::Pose2 step =
        whole.odometry[i - 1].reading.X_OB.Inverse() * whole.odometry[i].reading.X_OB;
    const bool is_turn = IsTurnInPlace(whole, i);
    if (is_turn && !IsTurnInPlace(whole, i - 1)) ++num_turns;
    if (is_turn && num_turns % 2 == 0) step.yaw = told * geometry::WrapToPi(step.yaw);
    X_OB = X_OB * step;
    log->odometry[i].reading.X_OB = X_OB;
  }
}

TEST(MapperOdometryTest, TurnsThatTheOdometryMissesDoNotAddUp) {
  SimulatedDriveParams params;
  params.odometry_period = 0.04;
  for (int seed = 1; seed <= hires::test_support::Rounds(8); ++seed) {
    for (const double told : {0.0, 0.5}) {
      SCOPED_TRACE(testing::Message() << seed << " " << told);
      SimulatedDrive drive = TwoRoomsDrive(params, seed);
      MissTurns(told, &drive.log);
      EXPECT_LE(TrajectoryRms(MakeMap(drive.log).trajectory, drive.truth), 0.1);
    }
  }
}

/// A hall with rooms of some 4 m on both sides, a door to each.
world::OccupancyGrid HallWithRooms(base::Rng* rng, std::vector<Eigen::Vector2d>* course) {
  constexpr double kCell = 0.05, kRoom = 4.0, kHall = 2.0;
  world::OccupancyGrid grid{kCell, 180, 212, {0.0, 0.0}, {}};
  grid.cells.assign(std::size_t{180} * 212, world::Cell::kOccupied);
  const auto clear = [&](double x0, double y0, double x1, double y1) {
    for (int row = static_cast<int>(y0 / kCell); row < static_cast<int>(y1 / kCell); ++row)
      for (int column = static_cast<int>(x0 / kCell); column < static_cast<int>(x1 / kCell);
           ++column)
        grid.cells[row * grid.width + column] = world::Cell::kFree;
  };
  const double hall = 0.2 + kRoom + 0.1, middle = hall + 0.5 * kHall;
  clear(0.2, hall, 8.6, hall + kHall);
  course->push_back({0.9, middle});
  for (int i = 0; i < 4; ++i) {
    const bool is_up = i % 2 == 1;
    const double left = 0.2 + (i / 2) * (kRoom + 0.2);
    const double depth = rng->Uniform(3.0, kRoom), width = rng->Uniform(3.0, kRoom);
    const double near = is_up ? hall + kHall + 0.1 : hall - 0.1;
    const double far = is_up ? near + depth : near - depth;
    const double door = rng->Uniform(left + 0.8, left + width - 0.8);
    clear(left, std::min(near, far), left + width, std::max(near, far));
    clear(door - 0.5, hall - 0.2, door + 0.5, hall + kHall + 0.2);
    course->push_back({door, middle});
    course->push_back({door, 0.5 * (near + far)});
    course->push_back({door, middle});
  }
  return grid;
}

/// Anchored at the last keyframe alone, five of the 80 drives were off by 0.7 to 1.5 m.
TEST(MapperOdometryTest, TurnsThatTheLaserAloneFollowsDoNotAddUp) {
  SimulatedDriveParams params = test_support::ExactOdometry();
  params.beams = 181;
  params.range_noise = 0.01;
  params.X_BL = {};
  for (int round = 0; round < hires::test_support::Rounds(80); ++round) {
    base::Rng rng = base::Rng(11).Fork(30 + round);
    std::vector<Eigen::Vector2d> course;
    const world::OccupancyGrid rooms = HallWithRooms(&rng, &course);
    params.turn_rate = rng.Uniform(0.6, 0.9);
    SimulatedDrive drive = DriveThrough(test_support::WithBoxes(rooms, course, 12, rng.Split()),
                                        course, params, rng.Split());
    MissTurns(0.0, &drive.log);
    EXPECT_LE(TrajectoryRms(MakeMap(drive.log).trajectory, drive.truth), 0.3) << round;
  }
}

/// Normals have noise, which tells nothing of how far along the hall the robot is.
TEST(MapperOdometryTest, AHallPullsNobodyAlongIt) {
  world::OccupancyGrid hall{0.05, 840, 80, {0.0, 0.0}, {}};
  hall.cells.assign(std::size_t{840} * 80, world::Cell::kOccupied);
  for (int row = 20; row < 60; ++row)
    for (int column = 20; column < 820; ++column)
      hall.cells[row * 840 + column] = world::Cell::kFree;
  SimulatedDriveParams params = test_support::ExactOdometry();
  params.scale_error = 0.002;
  params.beams = 181;
  for (int round = 0; round < hires::test_support::Rounds(12); ++round) {
    params.range_noise = 0.02 * (round % 3);
    SCOPED_TRACE(testing::Message() << round << " " << params.range_noise);
    const SimulatedDrive drive =
        DriveThrough(hall, {{2.0, 2.0}, {40.0, 2.0}, {2.0, 2.0}}, params, base::Rng(9).Fork(round));
    EXPECT_LE(TrajectoryRms(MakeMap(drive.log).trajectory, drive.truth), 0.25);
  }
}

TEST(MapperOdometryTest, LimitsOfSpeedChangeNoDriveWithoutAReset) {
  MapperParams none;
  none.max_linear_speed = none.max_angular_speed = 100.0;
  SimulatedDrive drive = TwoRoomsDrive();
  for (const bool scans_tell : {false, true}) {
    if (scans_tell) LetScansTellOdometry(&drive.log);
    const MapResult one = MakeMap(drive.log), other = MakeMap(drive.log, none);
    EXPECT_EQ(one.grid.cells, other.grid.cells);
    for (std::size_t i = 0; i < one.trajectory.size(); ++i) {
      EXPECT_EQ(one.trajectory[i].X_MB.position(), other.trajectory[i].X_MB.position());
      EXPECT_EQ(one.trajectory[i].X_MB.yaw, other.trajectory[i].X_MB.yaw);
    }
  }
}

/// Where odometry turns too far by a tenth, and the laser does not see how far.
TEST(MapperOdometryTest, RatesOfAnInertialUnitMakeTheMapTruer) {
  const world::OccupancyGrid hall = test_support::LargeHall();
  SimulatedDriveParams params = test_support::ExactOdometry();
  params.range_max = 5.0;
  for (int seed = 1; seed <= 2; ++seed) {
    SimulatedDrive drive =
        DriveThrough(hall, test_support::CourseThroughLargeHall(), params, base::Rng(seed));
    RobotLog with = drive.log;
    with.inertia = test_support::RatesOf(drive.log, 0.01, {}, base::Rng(seed));
    test_support::ScaleTurns(1.1, &drive.log);
    with.odometry = drive.log.odometry;
    localisation::FilterOdometry({}, &with);
    const Errors wheels = ErrorsOf(MakeMap(drive.log), drive, hall);
    const Errors joined = ErrorsOf(MakeMap(with), drive, hall);
    EXPECT_GT(wheels.rms, 0.4);
    EXPECT_GT(wheels.walls.to_world.median, 0.1);
    EXPECT_GT(wheels.walls.to_map.median, 0.1);
    EXPECT_LT(joined.rms, 0.15);
    EXPECT_LT(joined.walls.to_world.median, 0.05);
    EXPECT_LT(joined.walls.to_map.median, 0.05);
  }
}

}  // namespace
}  // namespace hires::mapping::mapper_odometry_test
