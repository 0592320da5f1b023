// Going by the place where the base's laser sees the robot, and stopping before what it sees.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "hires/geometry/angles.h"
#include "hires/skills/move_base.h"
#include "hires/skills/skill_factory.h"
#include "hires/world/occupancy_grid.h"
#include "skills/driving/at_seen_place.h"
#include "skills/laser_robot.h"
#include "skills/point_robot.h"
#include "support/scenes.h"

namespace hires::skills::seen_place_test {
namespace {

using geometry::Pose2;
using hires::test_support::Block;
using test_support::PointRobot;
using test_support::RunSkill;
using test_support::SkillRun;

const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};
const Pose2 kStart{1.0, 2.0, 0.0}, kAtTable{2.2, 2.0, 0.0};
const Pose2 X_BL{0.27, 0.0, 0.0};
constexpr double kTolerance = 0.03;  // [m] of a blind drive

robot::Robot RobotWithLaser() { return test_support::RobotWithLaser(X_BL); }

/// A table ahead of the goal, of four legs and a top that no beam of the laser meets.
world::World RoomWithTable() {
  world::World room = hires::test_support::Room();
  for (const double x : {2.8, 3.5}) {
    for (const double y : {1.6, 2.4})
      room.statics.push_back(Block("leg", {0.06, 0.06, 0.7}, {x, y, 0.35}));
  }
  room.statics.push_back(Block("top", {0.9, 1.0, 0.04}, {3.15, 2.0, 0.72}));
  return room;
}

std::shared_ptr<const robot::PlacedScan> ScanIn(const world::World& world, const Pose2& X_WB,
                                                const Pose2& X_OB) {
  return test_support::ScanIn(world, X_WB, X_OB, X_BL);
}

SkillSet SkillsIn(const world::World& world, bool by_seen_place = true) {
  MoveBaseParams params;
  params.obstacle_layer.emplace();
  if (by_seen_place) params.seen_place.emplace();
  SkillSet skills;
  skills.driving =
      std::make_shared<const DrivingContext>(MakeDrivingContext(world, RobotWithLaser(), params));
  skills.areas = {{"table", kAtTable}};
  skills.motion_sets = {{"slow", kSlow}};
  skills.default_motion_set = "slow";
  return skills;
}

std::unique_ptr<Skill> BlindDrive(const world::World& world, bool by_seen_place = true) {
  return MakeSkill(SkillsIn(world, by_seen_place), {"move_base_blind", {"table"}});
}

struct Drive {
  SkillRun run;
  Pose2 X_WB;  // where it ended in truth
  bool has_touched{false};
};

/// @param X_WM   the map in the world: where the robot is told to be is off by its inverse.
/// @param known  the world as skills know it.
Drive DriveIn(const world::World& known, const world::World& world, const Pose2& X_WM,
              bool by_seen_place = true) {
  Drive drive;
  const auto skill = BlindDrive(known, by_seen_place);
  const auto outlines = world::OutlinesInBand(world, nullptr, 0.08, 0.3);
  const geometry::Polygon footprint = RobotWithLaser().profile.footprint;
  int cycle = 0;
  std::shared_ptr<const robot::PlacedScan> scan;
  const PointRobot start{X_WM.Inverse() * kStart, {}, false};
  drive.run = RunSkill(skill.get(), start, [&](auto* seen, auto* robot) {
    drive.X_WB = X_WM * robot->X_MB;
    seen->X_OB = robot->X_MB;
    if (cycle++ % 8 == 0) scan = ScanIn(world, drive.X_WB, seen->X_OB);
    seen->scan = scan;
    const geometry::Polygon body = geometry::Transformed(drive.X_WB, footprint);
    for (const geometry::Polygon& outline : outlines) {
      if (geometry::Distance(body, outline) <= 0.0) drive.has_touched = true;
    }
  });
  return drive;
}

double OffGoal(const Drive& drive) { return (drive.X_WB.position() - kAtTable.position()).norm(); }

TEST(SeenPlaceTest, WhoIsToldAWrongPlaceDocksWhereTheTableIs) {
  const world::World room = RoomWithTable();
  for (const Pose2& X_WM : {Pose2{0.04, -0.04, 0.0}, Pose2{-0.05, 0.02, 0.01}}) {
    const Drive told = DriveIn(room, room, X_WM, false), seen = DriveIn(room, room, X_WM);
    EXPECT_EQ(seen.run.status.progress, Progress::kSucceeded) << ToString(seen.run.status.failure);
    EXPECT_LT(OffGoal(seen), kTolerance + 0.01);
    EXPECT_GT(OffGoal(told), kTolerance + 0.01) << "else this shows nothing";
  }
}

TEST(SeenPlaceTest, ABlindDriveStopsBeforeWhatItsLaserSees) {
  const world::World known = RoomWithTable();
  world::World room = known;
  room.statics.push_back(Block("crate", {0.3, 0.3, 0.4}, {2.0, 2.05, 0.2}));
  const Drive drive = DriveIn(known, room, {});
  EXPECT_EQ(drive.run.status.progress, Progress::kFailed);
  EXPECT_EQ(drive.run.status.failure.code, base::FailureCode::kStuck);
  EXPECT_FALSE(drive.has_touched);
  const double ahead = 1.85 - drive.X_WB.x - 0.3;  // footprint of TrayRobot: 0.6 m
  EXPECT_LT(ahead, 0.06) << "it came near";
}

/// Says what it was shown.
class Probe : public Skill {
 public:
  explicit Probe(robot::Observation* shown) : shown_(shown) {}
  Status Update(const robot::Observation& observation, robot::Command* /*command*/) override {
    *shown_ = observation;
    return {};
  }
  double period() const override { return 0.05; }

 private:
  robot::Observation* shown_;
};

class BeliefTest : public testing::Test {
 protected:
  /// Shown what a robot sees that stands at `X_WB` and is told `X_MB`.
  void Look(const Pose2& X_WB, const Pose2& X_MB, double position_sd = 0.0) {
    robot::Observation seen;
    seen.time = time_ += 0.05;
    seen.X_OB = X_WO_.Inverse() * X_WB;
    seen.X_MB = X_MB;
    seen.position_sd = position_sd;
    if (has_scans_) seen.scan = ScanIn(room_, X_WB, seen.X_OB);
    seen.objects.push_back({"mug1", "mug", geometry::Lift(X_MB * Pose2{0.8, 0.1, 0.0}, 0.7)});
    seen.obstacles_M.push_back(geometry::Transformed(X_MB, {{1, 0}, {1.1, 0}, {1.1, 0.1}}));
    robot::Command command;
    skill_.Update(seen, &command);
  }
  double OffFrom(const Pose2& X_WB) const {
    return (skill_.belief().X_MB.position() - X_WB.position()).norm();
  }

  const world::World room_ = RoomWithTable();
  robot::Observation shown_;
  AtSeenPlace skill_{std::make_unique<Probe>(&shown_), SkillsIn(room_).driving->seen_place,
                     RobotWithLaser().profile.footprint};
  double time_{0.0};
  bool has_scans_{true};
  Pose2 X_WO_{0.3, -0.2, 0.4};
  const Pose2 off_{0.03, -0.02, 0.01};
};

TEST_F(BeliefTest, WithoutAScanItIsTheToldPlace) {
  has_scans_ = false;
  Look(kAtTable, kAtTable * off_);
  EXPECT_EQ(shown_.X_MB.x, (kAtTable * off_).x);
  EXPECT_EQ(shown_.X_MB.y, (kAtTable * off_).y);
}

TEST_F(BeliefTest, WhatWasSeenStaysWhereItIsAgainstTheRobot) {
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
  const Eigen::Vector3d mug_B =
      geometry::Lift(shown_.X_MB).Inverse() * shown_.objects.at(0).X_MO.translation;
  EXPECT_LT((mug_B - Eigen::Vector3d(0.8, 0.1, 0.7)).norm(), 1e-9);
  const Eigen::Vector2d corner_B = shown_.X_MB.Inverse() * shown_.obstacles_M.at(0).at(1);
  EXPECT_LT((corner_B - Eigen::Vector2d(1.1, 0.0)).norm(), 1e-9);
}

TEST_F(BeliefTest, WhatTheToldPlaceJittersIsNotSeen) {
  Look(kAtTable, kAtTable * off_);
  for (int i = 0; i < 40; ++i) {
    const double jitter = i % 2 == 0 ? 0.01 : -0.01;
    Look(kAtTable, kAtTable * off_ * Pose2{jitter, jitter, 0.0});
    ASSERT_LT(OffFrom(kAtTable), 0.005) << i;
  }
}

TEST_F(BeliefTest, FarFromAllOutlinesItGoesOnByOdometryAndThenByWhatItIsTold) {
  Look(kAtTable, kAtTable * off_);
  has_scans_ = false;
  Pose2 X_WB = kAtTable;
  for (int i = 0; i < 10; ++i) {
    X_WB = X_WB * Pose2{-0.02, 0.0, 0.0};
    Look(X_WB, X_WB * off_);
  }
  EXPECT_LT(OffFrom(X_WB), 0.005) << "0.2 m farther the odometry still knows better";
  for (int i = 0; i < 150; ++i) {
    X_WB = X_WB * Pose2{-0.02, 0.0, 0.0};
    Look(X_WB, X_WB * off_);
  }
  EXPECT_NEAR(OffFrom(X_WB), std::hypot(off_.x, off_.y), 0.005) << "and 3 m farther no more";
}

TEST_F(BeliefTest, WhoIsFoundElsewhereIsThere) {
  Look(kAtTable, kAtTable * off_);
  has_scans_ = false;
  Look(kAtTable, kStart);
  EXPECT_LT(OffFrom(kStart), 1e-9);
}

TEST_F(BeliefTest, AResetOfTheOdometryMovesNothing) {
  Look(kAtTable, kAtTable * off_);
  X_WO_ = {5.0, 1.0, -1.0};
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable * off_), 1e-9) << "as told, until the next scan";
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
}

TEST_F(BeliefTest, WhoIsToldToBeSurerThanTheOdometryGoesByThat) {
  has_scans_ = false;
  Look(kAtTable, kAtTable * off_);
  Look(kAtTable, kAtTable, 0.001);
  EXPECT_LT(OffFrom(kAtTable), 1e-9);
}

TEST(SeenPlaceTest, DrivesRoundObstaclesGoByTheToldPlaceAndTheRestBesideFurnitureNot) {
  const SkillSet skills = SkillsIn(RoomWithTable());
  const auto is_by_seen = [&](const base::ActionCall& call) {
    return dynamic_cast<AtSeenPlace*>(MakeSkill(skills, call).get()) != nullptr;
  };
  EXPECT_TRUE(is_by_seen({"move_base_blind", {"table"}}));
  EXPECT_FALSE(is_by_seen({"move_base", {"table"}}));
  const SkillSet told = SkillsIn(RoomWithTable(), false);
  EXPECT_EQ(dynamic_cast<AtSeenPlace*>(MakeSkill(told, {"move_base_blind", {"table"}}).get()),
            nullptr);
}

}  // namespace
}  // namespace hires::skills::seen_place_test
