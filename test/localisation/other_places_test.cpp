#include "localisation/other_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hires/geometry/angles.h"
#include "hires/localisation/localise_log.h"
#include "support/rounds.h"
#include "support/simulated_drive.h"

namespace hires::localisation::other_places_test {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using test_support::SimulatedDrive;
using world::OccupancyGrid;

void Fill(int left, int lower, int right, int upper, OccupancyGrid* grid) {
  for (int row = lower; row < upper; ++row)
    for (int column = left; column < right; ++column)
      grid->cells[static_cast<std::size_t>(row) * grid->width + column] = world::Cell::kOccupied;
}

/// 12 m x 8 m, two rooms with a door of 2 m between them and a pillar in each: the same when it is
/// turned by half.
OccupancyGrid SameTurnedByHalf() {
  OccupancyGrid grid{0.05, 240, 160, {0.0, 0.0}, {}};
  grid.cells.assign(static_cast<std::size_t>(grid.width) * grid.height, world::Cell::kFree);
  Fill(0, 0, 240, 2, &grid);
  Fill(0, 158, 240, 160, &grid);
  Fill(0, 0, 2, 160, &grid);
  Fill(238, 0, 240, 160, &grid);
  Fill(118, 0, 122, 60, &grid);
  Fill(118, 100, 122, 160, &grid);
  Fill(180, 110, 190, 116, &grid);
  Fill(50, 44, 60, 50, &grid);
  return grid;
}

/// With a cupboard in a corner of the right room.
OccupancyGrid NearlySameTurnedByHalf() {
  OccupancyGrid grid = SameTurnedByHalf();
  Fill(220, 2, 238, 30, &grid);
  return grid;
}

SimulatedDrive DriveIn(const OccupancyGrid& grid, int seed) {
  const std::vector<Vector2d> course{{2.0, 2.0},  {2.0, 4.0}, {8.0, 4.0}, {8.0, 2.5},
                                     {10.0, 4.0}, {8.0, 4.0}, {4.0, 4.0}, {3.5, 6.5}};
  return test_support::DriveThrough(grid, course, {}, base::Rng(seed));
}

Pose2 TurnedByHalf(const Pose2& X_MB) { return Pose2{12.0, 8.0, geometry::kPi} * X_MB; }

double Off(const Pose2& X_MB, const Pose2& truth) {
  return (X_MB.position() - truth.position()).norm();
}

LocalisedLog Localise(const SimulatedDrive& drive, const OccupancyGrid& map, int seed,
                      const MonteCarloParams& params = {}) {
  return LocaliseAnywhere(drive.log, map, params, base::Rng(seed), "localising");
}

LocalisedLog LocaliseByFilterAlone(const SimulatedDrive& drive, const OccupancyGrid& map, int seed,
                                   const MonteCarloParams& params = {}) {
  MonteCarloLocalisation filter(map, params, base::Rng(seed));
  filter.GlobalLocalisation();
  return LocaliseLog(drive.log, filter, "localising");
}

DriveSketch SketchOf(const SimulatedDrive& drive) {
  DriveSketch sketch;
  for (std::size_t i = 0; i < drive.log.scans.size(); i += 10) {
    const RobotLog::Scan& scan = drive.log.scans[i];
    sketch.way_M.push_back(drive.truth[i].X_MB.position());
    for (std::size_t k = 0; k < scan.reading.ranges.size(); k += 5) {
      const double angle = scan.reading.angle_min + k * scan.reading.angle_increment;
      const Vector2d end_L = scan.reading.ranges[k] * Vector2d(std::cos(angle), std::sin(angle));
      sketch.echoes_M.push_back(drive.truth[i].X_MB * (scan.X_BL * end_L));
    }
  }
  return sketch;
}

TEST(OtherPlacesTest, ThePlanTurnedByHalfIsFoundAndNothingElse) {
  const OccupancyGrid map = SameTurnedByHalf();
  const SimulatedDrive drive = DriveIn(map, 1);
  const std::vector<Pose2> places = FindOtherPlaces(map, SketchOf(drive), 0.2, 4, "looking");
  ASSERT_EQ(places.size(), 1u);
  for (const TimedPose& truth : drive.truth)
    EXPECT_LT(Off(places[0] * truth.X_MB, TurnedByHalf(truth.X_MB)), 0.25);
}

TEST(OtherPlacesTest, AFarMapIsSearchedWhereItLies) {
  OccupancyGrid map = SameTurnedByHalf();
  const Vector2d far(-310.0, 77.5);
  DriveSketch sketch = SketchOf(DriveIn(map, 1));
  map.origin = far;
  for (Vector2d& p : sketch.echoes_M) p += far;
  for (Vector2d& p : sketch.way_M) p += far;
  const std::vector<Pose2> places = FindOtherPlaces(map, sketch, 0.2, 4, "looking");
  ASSERT_EQ(places.size(), 1u);
  const Vector2d end = places[0] * sketch.way_M.front();
  EXPECT_LT((end - far - Vector2d(10.0, 6.0)).norm(), 0.25);
}

TEST(OtherPlacesTest, APlanLikeNoTurnOfItselfHasNone) {
  const OccupancyGrid map = test_support::RoomsWithShelf();
  const SimulatedDrive drive =
      test_support::DriveThrough(map, test_support::CourseThroughTwoRooms(), {}, base::Rng(2));
  EXPECT_TRUE(FindOtherPlaces(map, SketchOf(drive), 0.2, 4, "looking").empty());
}

TEST(OtherPlacesTest, ASketchOfNothingHasNone) {
  EXPECT_TRUE(FindOtherPlaces(SameTurnedByHalf(), {}, 0.2, 4, "looking").empty());
}

TEST(LocaliseAnywhereTest, APlanThatIsTheSameTurnedByHalfHasARival) {
  const OccupancyGrid map = SameTurnedByHalf();
  for (int seed = 1; seed <= test_support::Rounds(4); ++seed) {
    SCOPED_TRACE(seed);
    const SimulatedDrive drive = DriveIn(map, seed);
    const LocalisedLog localised = Localise(drive, map, seed);
    ASSERT_TRUE(localised.rival.has_value());
    EXPECT_LT(Off(localised.rival->X_MB, TurnedByHalf(localised.path.back().X_MB)), 0.3);
    EXPECT_GE(localised.rival->explained_here, localised.rival->explained);
    EXPECT_GT(localised.rival->explained, 0.9);
  }
}

/// Turned by half about its middle a drive there is hardly elsewhere, but heads the other way.
TEST(LocaliseAnywhereTest, InTheMiddleOfARoomTheOtherHeadingIsARival) {
  OccupancyGrid room = SameTurnedByHalf();
  for (int row = 2; row < 158; ++row)
    for (int column = 2; column < 238; ++column)
      room.cells[static_cast<std::size_t>(row) * room.width + column] = world::Cell::kFree;
  const std::vector<Vector2d> course{{6.0, 4.0}, {6.3, 4.0}, {6.0, 4.3}, {5.8, 3.9}, {6.2, 3.8},
                                     {6.1, 4.2}, {5.9, 4.1}, {6.0, 3.8}, {6.2, 4.1}, {6.0, 4.0}};
  MonteCarloParams few;  // particles, so that the filter alone decides
  few.min_particles = 100;
  few.max_particles = 500;
  few.global_particles = 3000;
  int num_good = 0;
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    SCOPED_TRACE(seed);
    const SimulatedDrive drive = test_support::DriveThrough(room, course, {}, base::Rng(seed));
    const LocalisedLog localised = Localise(drive, room, seed, few);
    if (localised.last.status != LocalisationStatus::kGood) continue;
    ++num_good;
    ASSERT_TRUE(localised.rival.has_value());
    const double turned = localised.rival->X_MB.yaw - localised.path.back().X_MB.yaw;
    EXPECT_GT(std::abs(geometry::WrapToPi(turned)), 2.5);
  }
  EXPECT_GT(num_good, 0) << "nothing was tested";
}

TEST(LocaliseAnywhereTest, OneCupboardTellsTheHalvesApart) {
  const OccupancyGrid map = NearlySameTurnedByHalf();
  MonteCarloParams few;  // particles: the filter alone takes the half that it came upon first
  few.min_particles = 100;
  few.max_particles = 500;
  few.global_particles = 3000;
  int num_wrong_alone = 0;
  for (int seed = 1; seed <= test_support::Rounds(32); ++seed) {
    SCOPED_TRACE(seed);
    const SimulatedDrive drive = DriveIn(map, seed);
    const Pose2& truth = drive.truth.back().X_MB;
    num_wrong_alone += Off(LocaliseByFilterAlone(drive, map, seed, few).last.X_MB, truth) > 1.0;
    const LocalisedLog localised = Localise(drive, map, seed, few);
    EXPECT_FALSE(localised.rival.has_value());
    EXPECT_EQ(localised.last.status, LocalisationStatus::kGood);
    ASSERT_FALSE(localised.path.empty());
    EXPECT_LT(Off(localised.path.back().X_MB, truth), 0.3);
  }
  EXPECT_GT(num_wrong_alone, 0) << "nothing was tested";
}

/// Lets the robot stand where it came to, for so many scans more.
void Stand(const OccupancyGrid& grid, int num_scans, SimulatedDrive* drive) {
  base::Rng rng(99);
  RobotLog::Odometry odometry = drive->log.odometry.back();
  RobotLog::Scan scan = drive->log.scans.back();
  TimedPose truth = drive->truth.back();
  for (int i = 1; i <= num_scans; ++i) {
    odometry.time = scan.time = truth.time = drive->log.odometry.back().time + 0.2;
    scan.reading = test_support::ScanInGrid(grid, truth.X_MB * scan.X_BL, {}, &rng);
    drive->log.odometry.push_back(odometry);
    drive->log.scans.push_back(scan);
    drive->truth.push_back(truth);
  }
}

/// A post is near where the robot stands at last, and hardly seen from anywhere else.
TEST(LocaliseAnywhereTest, OneViewDoesNotTellTheHalvesApartHoweverLongTheRobotStandsThere) {
  OccupancyGrid map = SameTurnedByHalf();
  Fill(60, 144, 61, 145, &map);
  for (int seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    SimulatedDrive drive = DriveIn(map, seed);
    Stand(map, 1000, &drive);
    EXPECT_TRUE(Localise(drive, map, seed).rival.has_value());
  }
}

int CountOf(const std::map<LocalisationStatus, int>& statuses) {
  int count = 0;
  for (const auto& [status, times] : statuses) count += times;
  return count;
}

int CountOf(const std::map<ScanOutcome, int>& outcomes) {
  int count = 0;
  for (const auto& [outcome, times] : outcomes) count += times;
  return count;
}

TEST(LocaliseAnywhereTest, AllScansAreCountedWhicheverPlaceIsTheAnswer) {
  const OccupancyGrid map = NearlySameTurnedByHalf();
  MonteCarloParams few;
  few.min_particles = 100;
  few.max_particles = 500;
  few.global_particles = 3000;
  int num_others = 0;
  for (int seed = 1; seed <= test_support::Rounds(32); ++seed) {
    SCOPED_TRACE(seed);
    SimulatedDrive drive = DriveIn(map, seed);
    drive.log.scans.front().time -= 1.0;  // no odometry is near
    const Pose2 alone = LocaliseByFilterAlone(drive, map, seed, few).last.X_MB;
    const LocalisedLog localised = Localise(drive, map, seed, few);
    num_others += Off(localised.last.X_MB, alone) > 1.0;
    const int num_scans = static_cast<int>(drive.log.scans.size());
    EXPECT_EQ(localised.num_without_odometry, 1);
    EXPECT_EQ(CountOf(localised.statuses), num_scans - 1);
    EXPECT_EQ(CountOf(localised.outcomes), num_scans - 1);
  }
  EXPECT_GT(num_others, 0) << "nothing was tested";
}

/// The robot is carried away for a while, and back to where it was.
TEST(LocaliseAnywhereTest, PosesThatAreContradictedCountUntilOthersReplaceThem) {
  const OccupancyGrid map = test_support::RoomsWithShelf();
  SimulatedDrive drive =
      test_support::DriveThrough(map, test_support::CourseThroughTwoRooms(), {}, base::Rng(2));
  base::Rng rng(7);
  for (std::size_t i = 0; i < drive.log.scans.size(); ++i) {
    RobotLog::Scan& scan = drive.log.scans[i];
    if (scan.time < 34.0 || scan.time > 60.0) continue;
    const Pose2 there = TurnedByHalf(drive.truth[i].X_MB);
    scan.reading = test_support::ScanInGrid(map, there * scan.X_BL, {}, &rng);
  }
  // People stand all round meanwhile, so that the robot looks everywhere.
  for (RobotLog::Scan& scan : drive.log.scans) {
    const bool is_carried = std::abs(scan.time - 36.0) < 2.0 || std::abs(scan.time - 62.0) < 2.0;
    if (!is_carried) continue;
    for (float& range : scan.reading.ranges) range = std::min(range, 0.5f);
  }
  const LocalisedLog alone = LocaliseByFilterAlone(drive, map, 5), all = Localise(drive, map, 5);
  ASSERT_FALSE(alone.contradicted.empty());
  ASSERT_GT(all.path.size(), alone.path.size()) << "nothing was tested";
  ASSERT_LT(alone.path.front().time, 30.0) << "nothing was tested";
  EXPECT_EQ(all.contradicted, alone.contradicted);
}

TEST(LocaliseAnywhereTest, WhereNothingElseFitsTheFiltersWordStaysAndTheWayThereIsAdded) {
  const OccupancyGrid map = test_support::RoomsWithShelf();
  const SimulatedDrive drive =
      test_support::DriveThrough(map, test_support::CourseThroughTwoRooms(), {}, base::Rng(2));
  const TimedPath alone = LocaliseByFilterAlone(drive, map, 5).path;
  const LocalisedLog all = Localise(drive, map, 5);
  ASSERT_FALSE(alone.empty());
  EXPECT_FALSE(all.rival.has_value());
  ASSERT_EQ(all.path.size(), drive.truth.size());
  const std::size_t more = all.path.size() - alone.size();
  EXPECT_GT(more, 0u) << "nothing was tested";
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(all.path[more + i].X_MB.x, alone[i].X_MB.x);
    EXPECT_EQ(all.path[more + i].X_MB.yaw, alone[i].X_MB.yaw);
  }
  for (std::size_t i = 0; i < all.path.size(); ++i) {
    EXPECT_EQ(all.path[i].time, drive.truth[i].time);
    EXPECT_LT(Off(all.path[i].X_MB, drive.truth[i].X_MB), 0.3);
  }
  EXPECT_GT(all.way_known, 0.99);
}

}  // namespace
}  // namespace hires::localisation::other_places_test
