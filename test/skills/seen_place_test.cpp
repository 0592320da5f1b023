// Going by the place where the base's laser sees the robot, and stopping before what it sees.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/geometry/angles.h"
#include "hires/robot/scan_memory.h"
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

struct Trial {
  Pose2 X_WM;  // map in the world: the told place is off by its inverse
  bool by_seen_place{true};
  double range_min{0.05};              // [m] of the laser
  Pose2 from{kStart};                  // where it begins in truth
  robot::ScanMemory* memory{nullptr};  // of an earlier drive; null: it has seen nothing yet
  double begun{0.0};                   // [s] on that memory's clock
};

/// @param known  the world as skills know it.
Drive DriveIn(const world::World& known, const world::World& world, const Trial& trial) {
  Drive drive;
  const geometry::Polygon base = robot::BaseOutlineOf(RobotWithLaser());
  robot::ScanMemory own(base);
  robot::ScanMemory& memory = trial.memory != nullptr ? *trial.memory : own;
  hires::test_support::Beams beams;
  beams.range_min = trial.range_min;
  const auto skill = BlindDrive(known, trial.by_seen_place);
  const auto outlines = world::OutlinesInBand(world, nullptr, 0.08, 0.3);
  const auto in_plane =
      world::OutlinesInBand(world, nullptr, test_support::kLaserPlane, test_support::kLaserPlane);
  int cycle = 0;
  std::shared_ptr<const robot::PlacedScan> scan;
  const PointRobot start{trial.X_WM.Inverse() * trial.from, {}, false};
  drive.run = RunSkill(skill.get(), start, [&](auto* seen, auto* robot) {
    drive.X_WB = trial.X_WM * robot->X_MB;
    seen->X_OB = robot->X_MB;
    if (cycle++ % 8 == 0) {
      auto now = hires::test_support::ScanOf(in_plane, drive.X_WB, seen->X_OB, X_BL, beams);
      memory.Complete(trial.begun + seen->time, &now);
      scan = std::make_shared<const robot::PlacedScan>(std::move(now));
    }
    seen->scan = scan;
    const geometry::Polygon body = geometry::Transformed(drive.X_WB, base);
    for (const geometry::Polygon& outline : outlines) {
      if (geometry::Distance(body, outline) <= 0.0) drive.has_touched = true;
    }
  });
  return drive;
}

/// [m] along x, of the base.
double FrontOf(const Drive& drive) {
  double front = 0.0;
  for (const Eigen::Vector2d& corner :
       geometry::Transformed(drive.X_WB, robot::BaseOutlineOf(RobotWithLaser())))
    front = std::max(front, corner.x());
  return front;
}

double OffGoal(const Drive& drive) { return (drive.X_WB.position() - kAtTable.position()).norm(); }

TEST(SeenPlaceTest, WhoIsToldAWrongPlaceDocksWhereTheTableIs) {
  const world::World room = RoomWithTable();
  for (const Pose2& X_WM : {Pose2{0.04, -0.04, 0.0}, Pose2{-0.05, 0.02, 0.01}}) {
    const Drive told = DriveIn(room, room, {X_WM, false}), seen = DriveIn(room, room, {X_WM});
    EXPECT_EQ(seen.run.status.progress, Progress::kSucceeded) << ToString(seen.run.status.failure);
    EXPECT_LT(OffGoal(seen), kTolerance + 0.01);
    EXPECT_GT(OffGoal(told), kTolerance + 0.01) << "else this shows nothing";
  }
}

TEST(SeenPlaceTest, ABlindDriveStopsBeforeWhatItsLaserSees) {
  const world::World known = RoomWithTable();
  world::World room = known;
  room.statics.push_back(Block("crate", {0.3, 0.3, 0.4}, {2.0, 2.05, 0.2}));
  const Drive drive = DriveIn(known, room, Trial());
  EXPECT_EQ(drive.run.status.progress, Progress::kFailed);
  EXPECT_EQ(drive.run.status.failure.code, base::FailureCode::kStuck);
  EXPECT_FALSE(drive.has_touched);
  EXPECT_NEAR(1.85 - FrontOf(drive), 0.01, 0.005);
}

/// The laser sits near the base's edge, and measures nothing nearer than 0.3 m.
TEST(SeenPlaceTest, ItStopsBeforeAThinLegThatItSeesNoMoreAlsoWhenItTriesAgain) {
  const world::World known = hires::test_support::Room();
  world::World room = known;
  room.statics.push_back(Block("leg", {0.03, 0.03, 0.7}, {2.0, 2.05, 0.35}));
  robot::ScanMemory memory(robot::BaseOutlineOf(RobotWithLaser()));
  Trial trial{{}, true, 0.3, kStart, &memory, 0.0};
  for (int i = 0; i < 3; ++i) {
    const Drive drive = DriveIn(known, room, trial);
    EXPECT_EQ(drive.run.status.failure.code, base::FailureCode::kStuck) << i;
    EXPECT_FALSE(drive.has_touched) << i;
    EXPECT_NEAR(1.985 - FrontOf(drive), 0.01, 0.005) << i;
    trial.from = drive.X_WB;
    trial.begun += drive.run.duration + 30.0;
  }
}

void ExpectItStands(double scan_age, std::shared_ptr<const robot::PlacedScan> scan,
                    const std::string& why) {
  const auto skill = BlindDrive(RoomWithTable());
  const SkillRun run = RunSkill(skill.get(), {kStart, {}, false}, [&](auto* seen, auto* robot) {
    seen->X_OB = robot->X_MB;
    seen->scan = scan;
    seen->scan_age = scan_age + seen->time;
  });
  EXPECT_EQ(run.status.failure.code, base::FailureCode::kStaleScan) << why;
  EXPECT_NE(run.status.failure.detail.find(why), std::string::npos) << run.status.failure.detail;
  EXPECT_LT(run.fastest, 1e-9) << why;
}

TEST(SeenPlaceTest, WithoutScansABlindDriveStands) {
  ExpectItStands(0.0, nullptr, "no scan");
  ExpectItStands(60.0, ScanIn(RoomWithTable(), kStart, kStart), "silent for");
}

TEST(SeenPlaceTest, WhereScansEndABlindDriveStopsWithinASecond) {
  const auto skill = BlindDrive(RoomWithTable());
  const auto scan = ScanIn(RoomWithTable(), kStart, kStart);
  double way_later = 0.0;
  const SkillRun run = RunSkill(skill.get(), {kStart, {}, false}, [&](auto* seen, auto* robot) {
    seen->X_OB = robot->X_MB;
    seen->scan = scan;
    seen->scan_age = seen->time;
    if (seen->time > 1.1) way_later += std::hypot(robot->V_B.vx, robot->V_B.vy);
  });
  EXPECT_EQ(run.status.failure.code, base::FailureCode::kStaleScan);
  EXPECT_GT(run.robot.X_MB.x, kStart.x + 0.1) << "until then it drove";
  EXPECT_EQ(way_later, 0.0);
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
    LookIn(room_, X_WB, X_MB, position_sd);
  }
  void LookIn(const world::World& world, const Pose2& X_WB, const Pose2& X_MB,
              double position_sd = 0.0) {
    robot::Observation seen;
    seen.time = time_ += 0.05;
    seen.X_OB = X_WO_.Inverse() * X_WB;
    seen.X_MB = X_MB;
    seen.position_sd = position_sd;
    if (has_scans_) seen.scan = ScanIn(world, X_WB, seen.X_OB);
    seen.objects.push_back(
        {"mug1", "mug", geometry::Lift(X_MB * Pose2{0.8, 0.1, 0.0}, 0.7), 0.0, {}});
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

TEST_F(BeliefTest, WhoIsFoundElsewhereIsThereAfterASecond) {
  Look(kAtTable, kAtTable * off_);
  has_scans_ = false;
  for (int i = 0; i < 20; ++i) Look(kAtTable, kStart);
  EXPECT_LT(OffFrom(kAtTable), 0.005) << "a filter may jump, and jump back";
  for (int i = 0; i < 2; ++i) Look(kAtTable, kStart);
  EXPECT_LT(OffFrom(kStart), 1e-9);
}

TEST_F(BeliefTest, OneJumpOfTheToldPlaceMovesNothing) {
  Look(kAtTable, kAtTable * off_);
  Look(kAtTable, kStart);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
}

/// Without its odometry: somebody pushed it, or its wheels slipped. What it is told has not noticed
/// it either.
TEST_F(BeliefTest, WhoIsPushedAsideSeesItWithinTwoSeconds) {
  for (const double push : {-0.03, -0.05, 0.03, 0.05}) {
    AtSeenPlace skill(std::make_unique<Probe>(&shown_), SkillsIn(room_).driving->seen_place,
                      RobotWithLaser().profile.footprint);
    skill_ = std::move(skill);
    for (int i = 0; i < 40; ++i) Look(kAtTable, kAtTable * off_);
    const Pose2 pushed = kAtTable * Pose2{0.0, push, 0.0};
    const Pose2 X_WO = X_WO_;
    X_WO_ = pushed * kAtTable.Inverse() * X_WO_;
    for (int i = 0; i < 40; ++i) Look(pushed, kAtTable * off_);
    EXPECT_LT(OffFrom(pushed), 0.006) << push;
    X_WO_ = X_WO;
  }
}

/// Legs may be mistaken by who does not know where it is by a hand's breadth.
TEST_F(BeliefTest, WhoIsToldToBeUnsureIsNotCorrected) {
  for (const double sd : {0.06, 0.15, 0.3}) {
    Look(kAtTable, kAtTable * off_, sd);
    EXPECT_NEAR(OffFrom(kAtTable), std::hypot(off_.x, off_.y), 1e-9) << sd;
  }
}

TEST_F(BeliefTest, WhatIsNoNumberMovesNothing) {
  for (int i = 0; i < 3; ++i) Look(kAtTable, kAtTable * off_);
  for (const double sd : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 40; ++i) Look(kAtTable, kAtTable * off_, sd);
    EXPECT_LT(OffFrom(kAtTable), 0.005) << sd;
  }
}

TEST_F(BeliefTest, WhoBeganWithNoNumberIsCorrectedOnceThereIsOne) {
  Look(kAtTable, kAtTable * off_, std::nan(""));
  EXPECT_NEAR(OffFrom(kAtTable), std::hypot(off_.x, off_.y), 1e-9);
  for (int i = 0; i < 3; ++i) Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
}

/// Beside one long wall only the distance from it is seen: along it the place is the told one, and
/// stays so, between scans as well.
TEST_F(BeliefTest, BesideOneWallItGoesByWhatItSeesAcrossAndByWhatItIsToldAlong) {
  world::World wall = hires::test_support::Room();
  wall.statics.clear();
  wall.statics.push_back(Block("wall", {20.0, 0.1, 1.0}, {0.0, 1.0, 0.5}));
  AtSeenPlace skill(std::make_unique<Probe>(&shown_), SkillsIn(wall).driving->seen_place,
                    RobotWithLaser().profile.footprint);
  skill_ = std::move(skill);
  const Pose2 place{2.0, 0.0, 0.3};
  for (int i = 0; i < 60; ++i) {
    has_scans_ = i % 8 == 0;
    LookIn(wall, place, {place.x + 0.03, place.y - 0.03, place.yaw});
    ASSERT_NEAR(skill_.belief().X_MB.y, place.y, 0.005) << i;
    ASSERT_NEAR(skill_.belief().X_MB.x, place.x + 0.03, 0.005) << i;
  }
}

/// The same scan again and again: what it says does not add up.
TEST_F(BeliefTest, WhoStandsDoesNotBecomeSureWithoutEnd) {
  for (int i = 0; i < 200; ++i) Look(kAtTable, kAtTable * off_);
  EXPECT_GT(std::sqrt(skill_.belief().covariance(0, 0)), 5e-4);
}

/// Somebody walks through the view, and later somebody else.
TEST_F(BeliefTest, OnlyScanAfterScanForASecondTheyContradictIt) {
  world::World elsewhere = room_, nothing = room_;
  for (world::StaticBody& body : elsewhere.statics) body.X_MB.translation.y() += 0.08;
  nothing.statics.clear();
  for (int i = 0; i < 3; ++i) Look(kAtTable, kAtTable * off_);
  LookIn(elsewhere, kAtTable, kAtTable * off_);
  for (int i = 0; i < 40; ++i) LookIn(nothing, kAtTable, kAtTable * off_);
  LookIn(elsewhere, kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.006) << "two scans in two seconds";
  for (int i = 0; i < 25; ++i) LookIn(elsewhere, kAtTable, kAtTable * off_);
  EXPECT_GT(OffFrom(kAtTable), 0.02) << "all scans for a second";
}

TEST_F(BeliefTest, AResetOfTheOdometryMovesNothing) {
  Look(kAtTable, kAtTable * off_);
  X_WO_ = {5.0, 1.0, -1.0};
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable * off_), 1e-9) << "as told, until the next scan";
  Look(kAtTable, kAtTable * off_);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
}

/// Filters are surer than they are right.
TEST_F(BeliefTest, WhoIsToldToBeVerySureIsNotBelievedMoreThanToldSd) {
  Look(kAtTable, kAtTable * off_, 0.001);
  EXPECT_LT(OffFrom(kAtTable), 0.005);
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
