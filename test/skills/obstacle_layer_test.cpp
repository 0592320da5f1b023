// Driving by what the base's laser sees: MoveBase with an obstacle layer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/polygon.h"
#include "hires/skills/local_costmap.h"
#include "hires/skills/move_base.h"
#include "skills/laser_robot.h"
#include "skills/point_robot.h"
#include "support/scenes.h"

namespace hires::skills::obstacle_layer_test {
namespace {

using geometry::Pose2;
using test_support::PointRobot;
using test_support::RunSkill;
using test_support::SkillRun;

const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};
const Pose2 kWest{1.0, 2.0, 0.0}, kEast{4.5, 2.0, 0.0};
const Pose2 X_BL{0.27, 0.0, 0.0};

robot::Robot RobotWithLaser() { return test_support::RobotWithLaser(X_BL); }

/// A room with a wall across it that leaves a door 0.8 m wide; the padded robot is 0.6 m wide.
world::World RoomWithDoor() {
  world::World room = hires::test_support::Room();
  room.statics.push_back(
      hires::test_support::Block("left_of_door", {0.1, 1.6, 1.0}, {2.75, 3.2, 0.5}));
  room.statics.push_back(
      hires::test_support::Block("right_of_door", {0.1, 1.6, 1.0}, {2.75, 0.8, 0.5}));
  return room;
}

std::shared_ptr<const robot::PlacedScan> ScanIn(const world::World& world, const Pose2& X_WB,
                                                const Pose2& X_OB) {
  return test_support::ScanIn(world, X_WB, X_OB, X_BL);
}

std::shared_ptr<const DrivingContext> ContextOf(const world::World& world, bool has_layer) {
  MoveBaseParams params;
  if (has_layer) params.obstacle_layer.emplace();
  return std::make_shared<const DrivingContext>(
      MakeDrivingContext(world, RobotWithLaser(), params));
}

struct Drive {
  SkillRun run;
  bool has_touched{false};
};

/// @param X_WM  the map in the world: where the robot believes to be is off by its inverse.
Drive DriveOff(const world::World& world, const Pose2& X_WM, bool has_layer) {
  Drive drive;
  MoveBase skill(ContextOf(world, has_layer), kEast, kSlow);
  const auto outlines = world::OutlinesInBand(world, nullptr, 0.08, 1.0);
  const geometry::Polygon footprint = RobotWithLaser().profile.footprint;
  drive.run = RunSkill(&skill, {X_WM.Inverse() * kWest, {}, false}, [&](auto* seen, auto* robot) {
    const Pose2 X_WB = X_WM * robot->X_MB;
    seen->X_OB = robot->X_MB;
    seen->scan = ScanIn(world, X_WB, seen->X_OB);
    const geometry::Polygon body = geometry::Transformed(X_WB, footprint);
    for (const geometry::Polygon& outline : outlines) {
      if (geometry::Distance(body, outline) <= 0.0) drive.has_touched = true;
    }
  });
  return drive;
}

TEST(ObstacleLayerDriveTest, ALocalisationThatErrsMovesNoDoor) {
  const world::World room = RoomWithDoor();
  for (const double off : {0.2, -0.2}) {
    const Drive by_map = DriveOff(room, {0.0, off, 0.0}, false);
    const Drive by_laser = DriveOff(room, {0.0, off, 0.0}, true);
    EXPECT_TRUE(by_map.has_touched) << "else this shows nothing";
    EXPECT_FALSE(by_laser.has_touched) << off;
    EXPECT_EQ(by_laser.run.status.progress, Progress::kSucceeded)
        << ToString(by_laser.run.status.failure);
  }
}

TEST(ObstacleLayerDriveTest, AMapThatIsRightIsDrivenAsByTheLaser) {
  const Drive by_laser = DriveOff(RoomWithDoor(), {}, true);
  EXPECT_FALSE(by_laser.has_touched);
  EXPECT_EQ(by_laser.run.status.progress, Progress::kSucceeded);
}

/// What a drive goes by after one look.
navigation::Costmap LookedAt(const world::World& known, const world::World& true_world,
                             bool has_scan = true) {
  MoveBase skill(ContextOf(known, true), kEast, kSlow);
  robot::Observation seen;
  seen.X_MB = seen.X_OB = kWest;
  if (has_scan) seen.scan = ScanIn(true_world, kWest, kWest);
  robot::Command command;
  skill.Update(seen, &command);
  return *skill.drive_view()->costmap;
}

bool HasObstacleAt(const navigation::Costmap& map, const Eigen::Vector2d& point) {
  int column = 0, row = 0;
  map.CellOf(point, &column, &row);
  return map.HasObstacle(column, row);
}

int CostAt(const navigation::Costmap& map, const Eigen::Vector2d& point) {
  int column = 0, row = 0;
  map.CellOf(point, &column, &row);
  return map.cost(column, row);
}

TEST(ObstacleLayerDriveTest, WhatIsGoneIsFreeAndWhatCameIsThere) {
  world::World before = hires::test_support::Room(), after = hires::test_support::Room();
  before.statics.push_back(hires::test_support::Block("crate", {0.4, 0.4, 0.5}, {2.4, 2.5, 0.25}));
  after.statics.push_back(hires::test_support::Block("crate", {0.4, 0.4, 0.5}, {2.4, 1.2, 0.25}));
  const navigation::Costmap costmap = LookedAt(before, after);
  EXPECT_LT(CostAt(costmap, {2.21, 2.5}), navigation::kInscribedCost) << "its old face";
  EXPECT_EQ(CostAt(costmap, {2.21, 1.2}), navigation::kLethalCost) << "its new one";
}

/// A crate comes onto the path when that is planned, and the robot stays where it is.
TEST(ObstacleLayerDriveTest, WhoComesNoNearerLooksForAWayRoundWhatIsSeenByNow) {
  const world::World room = hires::test_support::Room();
  world::World blocked = room;
  blocked.statics.push_back(
      hires::test_support::Block("crate", {0.4, 0.4, 0.5}, {2.75, 2.0, 0.25}));
  MoveBase skill(ContextOf(room, true), kEast, kSlow);
  std::optional<double> avoided;  // [s]
  for (int i = 0; i < 80 && !avoided; ++i) {
    robot::Observation seen;
    seen.time = 0.1 * i;
    seen.X_MB = seen.X_OB = kWest;
    seen.scan = ScanIn(i == 0 ? room : blocked, kWest, kWest);
    robot::Command command;
    ASSERT_EQ(skill.Update(seen, &command).progress, Progress::kRunning);
    const auto& path = *skill.drive_view()->path;
    const bool is_on_it = std::any_of(path.begin(), path.end(), [](const Pose2& pose) {
      return (pose.position() - Eigen::Vector2d(2.75, 2.0)).norm() < 0.2;
    });
    if (!is_on_it) avoided = seen.time;
  }
  ASSERT_TRUE(avoided) << "it would still drive through the crate";
  EXPECT_NEAR(*avoided, MoveBaseParams{}.progress_timeout, 0.11);
}

TEST(ObstacleLayerDriveTest, WhatIsAboveTheLasersPlaneIsAsTheMapHasIt) {
  world::World room = hires::test_support::Room();
  room.statics.push_back(
      hires::test_support::Block("table_top", {0.8, 0.8, 0.05}, {2.6, 2.8, 0.7}));
  EXPECT_TRUE(HasObstacleAt(LookedAt(room, room), {2.6, 2.8})) << "beams pass below it";
}

TEST(ObstacleLayerDriveTest, WhereNothingIsSeenTheMapIsTrusted) {
  world::World room = hires::test_support::Room();
  room.statics.push_back(hires::test_support::Block("crate", {0.4, 0.4, 0.5}, {2.4, 2.5, 0.25}));
  EXPECT_EQ(CostAt(LookedAt(room, room, false), {2.21, 2.5}), navigation::kLethalCost);
}

TEST(ObstacleLayerDriveTest, WhatWasSeenIsForgottenWhereTheOdometryOrItsClockIsReset) {
  world::World room = hires::test_support::Room();
  room.statics.push_back(hires::test_support::Block("crate", {0.4, 0.4, 0.5}, {2.4, 1.2, 0.25}));
  const auto look = [&](double time, const Pose2& X_OB, LocalCostmap* local) {
    robot::Observation seen;
    seen.time = time;
    seen.X_MB = kWest;
    seen.X_OB = X_OB;
    seen.scan = ScanIn(room, kWest, X_OB);
    local->Look(seen);
    return local->Marks(seen).size();
  };
  const auto context = ContextOf(room, true);
  const LocalCostmap fresh(&*context->by_plane, *context->params.obstacle_layer, context->footprint,
                           0.5);
  for (const auto& [time, X_OB] : {std::pair{100.1, Pose2{7.0, 2.0, 0.0}},
                                   std::pair{100.1, Pose2{1.0, 2.0, 1.0}}, std::pair{3.0, kWest}}) {
    LocalCostmap local = fresh;
    const std::size_t before = look(100.0, kWest, &local);
    ASSERT_GT(before, 0u);
    robot::Observation driven;
    driven.time = 100.05;
    driven.X_MB = driven.X_OB = {1.02, 2.0, 0.0};
    local.Look(driven);
    EXPECT_EQ(local.Marks(driven).size(), before) << "it drove";
    EXPECT_EQ(look(time, X_OB, &local), 0u) << "at " << time << ", x " << X_OB.x;
    EXPECT_GT(look(time + 0.1, X_OB, &local), 0u) << "it sees again";
  }
}

TEST(ObstacleLayerDriveTest, ARobotWithoutALaserIsRefused) {
  MoveBaseParams params;
  params.obstacle_layer.emplace();
  EXPECT_THAT(
      [&] {
        MakeDrivingContext(hires::test_support::Room(), hires::test_support::TrayRobot(), params);
      },
      testing::ThrowsMessage<base::ConfigError>(testing::AllOf(
          testing::HasSubstr("obstacle_layer: none"), testing::HasSubstr("laser_link"))));
}

}  // namespace
}  // namespace hires::skills::obstacle_layer_test
