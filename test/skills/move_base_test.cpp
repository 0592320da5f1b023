#include "hires/skills/move_base.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <memory>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/skills/manipulation_context.h"
#include "hires/world/occupancy_grid.h"
#include "skills/point_robot.h"
#include "skills/posture_skills.h"
#include "support/planar_scan.h"
#include "support/rounds.h"
#include "support/scenes.h"

namespace hires::skills::move_base_test {
namespace {

using geometry::Pose2;
using hires::test_support::Block;
using hires::test_support::Room;
using hires::test_support::TrayRobot;
using test_support::PointRobot;
using test_support::RunSkill;
using test_support::SkillRun;

const robot::MotionSet kFast{0.55, 1.0, 2.5, 3.2};
const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};
const Pose2 kWest{1.0, 2.0, 0.0};
const Pose2 kEast{4.5, 2.0, 0.0};

std::shared_ptr<const DrivingContext> ContextOf(const world::World& world,
                                                const MoveBaseParams& params = {}) {
  return std::make_shared<const DrivingContext>(MakeDrivingContext(world, TrayRobot(), params));
}

SkillRun DriveIn(const world::World& world, const Pose2& from, const Pose2& to,
                 const robot::MotionSet& motion_set = kFast) {
  MoveBase skill(ContextOf(world), to, motion_set);
  return RunSkill(&skill, {from, {}, false});
}

double DistanceBetween(const Pose2& a, const Pose2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

void ExpectArrivedAt(const Pose2& goal, const SkillRun& run) {
  const navigation::DwaParams defaults;
  EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
  EXPECT_EQ(ToString(run.status.failure), "");
  EXPECT_LE(DistanceBetween(run.robot.X_MB, goal), defaults.xy_goal_tolerance);
  EXPECT_LE(std::abs(geometry::WrapToPi(run.robot.X_MB.yaw - goal.yaw)),
            defaults.yaw_goal_tolerance);
}

void ExpectFailed(const std::string& reason, const SkillRun& run) {
  EXPECT_EQ(run.status.progress, Progress::kFailed);
  EXPECT_EQ(ToString(run.status.failure.code), reason);
}

TEST(MoveBaseTest, ArrivesAtItsGoal) {
  for (const double yaw : {0.0, 1.5, -3.0}) {
    const Pose2 goal{4.5, 2.4, yaw};
    ExpectArrivedAt(goal, DriveIn(Room(), kWest, goal));
  }
}

TEST(MoveBaseTest, TwoDrivenWheelsAreNeverDrivenSideways) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.drive = robot::Drive::kDifferential;
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.0, 0.8}, {2.75, 2.0, 0.4}));
  const auto context =
      std::make_shared<const DrivingContext>(MakeDrivingContext(room, robot, MoveBaseParams{}));
  for (const Pose2& goal : {kEast, Pose2{4.5, 2.4, -3.0}, Pose2{1.0, 3.0, 1.5}}) {
    MoveBase skill(context, goal, kFast);
    double sideways = 0.0;
    const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto*, auto* driven) {
      sideways = std::max(sideways, std::abs(driven->V_B.vy));
    });
    ExpectArrivedAt(goal, run);
    EXPECT_EQ(sideways, 0.0);
  }
}

TEST(MoveBaseTest, FlatRobotsAndOnesWithoutShapesDriveByTheirFootprint) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.0, 0.3}, {2.75, 2.0, 0.15}));
  for (const double height : {0.0, 0.0005, 0.001, 0.004, 0.006, 0.05, 0.09, 0.5}) {
    robot::Robot robot = TrayRobot();
    for (robot::Link& link : robot.model.links) link.collisions.clear();
    if (height > 0.0) {
      geometry::Collision plate;
      plate.shape = geometry::Box{{0.625, 0.5, height}};
      plate.X_BS.translation = {0.0125, 0.0, 0.5 * height};
      robot.model.links[0].collisions = {plate};
    }
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(room, robot, MoveBaseParams{}));
    const auto cost_at = [&](double x, double y) {
      int column = 0, row = 0;
      context->costmap->CellOf({x, y}, &column, &row);
      return context->costmap->cost(column, row);
    };
    EXPECT_EQ(cost_at(2.75, 2.0), navigation::kLethalCost) << height;
    EXPECT_LT(cost_at(1.0, 2.0), navigation::kLethalCost) << height;
    MoveBase skill(context, kEast, kFast);
    ExpectArrivedAt(kEast, RunSkill(&skill, {kWest, {}, false}));
  }
}

constexpr double kRadius = 0.6;

/// The test's robot on a car's wheels.
std::shared_ptr<const DrivingContext> CarIn(const world::World& world) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.drive = robot::Drive::kCarLike;
  robot.profile.base_controller.min_turning_radius = kRadius;
  return std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, {}));
}

SkillRun DriveCarIn(const world::World& world, const Pose2& from, const Pose2& to,
                    const robot::MotionSet& motion_set = kFast) {
  MoveBase skill(CarIn(world), to, motion_set);
  return RunSkill(&skill, {from, {}, false}, [&](auto*, auto* driven) {
    EXPECT_EQ(driven->V_B.vy, 0.0);
    EXPECT_LE(std::abs(driven->V_B.wz), std::abs(driven->V_B.vx) / kRadius + 1e-9);
    EXPECT_LE(std::abs(driven->V_B.wz), motion_set.max_angular_velocity + 1e-9);
  });
}

TEST(MoveBaseTest, ACarArrivesOnArcsThatItCanSteer) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.0, 0.8}, {2.75, 2.0, 0.4}));
  for (const Pose2& goal : {kEast, Pose2{4.5, 2.4, -3.0}, Pose2{1.0, 3.0, 1.5}, kWest}) {
    const SkillRun fast = DriveCarIn(room, kWest, goal);
    ExpectArrivedAt(goal, fast);
    EXPECT_LE(fast.fastest, kFast.max_linear_velocity + 1e-9);
    const SkillRun slow = DriveCarIn(room, kWest, goal, kSlow);
    ExpectArrivedAt(goal, slow);
    EXPECT_LE(slow.fastest, kSlow.max_linear_velocity + 1e-9);
  }
}

TEST(MoveBaseTest, ACarThatStandsWithinToleranceIsThere) {
  MoveBase skill(CarIn(Room()), kEast, kFast);
  robot::Observation seen;
  seen.X_MB = kEast * Pose2{0.0, 0.1, 0.05};
  robot::Command command;
  EXPECT_EQ(skill.Update(seen, &command).progress, Progress::kSucceeded);
  EXPECT_EQ(command.base_velocity->vx, 0.0);
}

TEST(MoveBaseTest, ACarSaysWhyThereIsNoWay) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {1.0, 1.0, 0.8}, {4.5, 2.0, 0.4}));
  ExpectFailed("goal_blocked", DriveCarIn(room, kWest, kEast));
  ExpectFailed("start_blocked", DriveCarIn(room, kEast, kWest));
  world::World divided = Room();
  divided.statics.push_back(Block("fence", {0.1, 4.0, 0.8}, {2.75, 2.0, 0.4}));
  ExpectFailed("no_path", DriveCarIn(divided, kWest, kEast));
}

TEST(MoveBaseTest, ACarSeesObstaclesThatAreNotInTheMap) {
  MoveBase skill(CarIn(Room()), kEast, kFast);
  const geometry::Polygon crate{{2.5, 1.5}, {3.0, 1.5}, {3.0, 2.5}, {2.5, 2.5}};
  double nearest = 1e9;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    if (robot->X_MB.x > 1.3) seen->obstacles_M = {crate};
    nearest = std::min(
        nearest, geometry::Distance(
                     geometry::Transformed(robot->X_MB, TrayRobot().profile.footprint), crate));
  });
  ExpectArrivedAt(kEast, run);
  EXPECT_GT(nearest, 0.0);
}

TEST(MoveBaseTest, AHeldCarOscillates) {
  MoveBase skill(CarIn(Room()), kEast, kFast);
  ExpectFailed("oscillating", RunSkill(&skill, {kWest, {}, true}));
}

TEST(MoveBaseTest, ACarThatMissesItsGoalEachTimeOscillates) {
  for (const double aside : {0.3, 0.6}) {  // [m] out of tolerance, and off its way
    MoveBase skill(CarIn(Room()), kEast, kFast);
    int num_missed = 0;
    const auto slip = [&](auto*, auto* robot) {
      if (DistanceBetween(robot->X_MB, kEast) > 0.1) return;
      robot->X_MB.y += aside;
      ++num_missed;
    };
    ExpectFailed("oscillating", RunSkill(&skill, {kWest, {}, false}, slip, 600.0));
    EXPECT_EQ(num_missed, 8);
  }
}

TEST(MoveBaseTest, KeepsToItsMotionSet) {
  const SkillRun fast = DriveIn(Room(), kWest, kEast, kFast);
  const SkillRun slow = DriveIn(Room(), kWest, kEast, kSlow);
  EXPECT_LE(fast.fastest, 0.55 + 1e-9);
  EXPECT_GT(fast.fastest, 0.50);
  EXPECT_LE(slow.fastest, 0.30 + 1e-9);
  EXPECT_GT(slow.fastest, 0.27);
  EXPECT_GT(slow.duration, fast.duration + 2.0);
}

TEST(MoveBaseTest, TellsItsMotionSetAndPeriod) {
  MoveBase skill(ContextOf(Room()), kEast, kSlow);
  robot::Observation seen;
  seen.X_MB = kWest;
  robot::Command command;
  skill.Update(seen, &command);
  ASSERT_TRUE(command.motion_set);
  EXPECT_EQ(command.motion_set->max_linear_velocity, 0.30);
  EXPECT_EQ(skill.period(), navigation::DwaParams{}.control_period);
}

TEST(MoveBaseTest, DrivesRoundWhatStandsInItsWay) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.0, 0.8}, {2.75, 2.0, 0.4}));
  const SkillRun free = DriveIn(Room(), kWest, kEast);
  const SkillRun round = DriveIn(room, kWest, kEast);
  ExpectArrivedAt(kEast, round);
  EXPECT_GT(round.duration, free.duration + 0.5);
}

TEST(MoveBaseTest, DrivesOverWhatIsLowAndUnderWhatIsHigh) {
  world::World room = Room();
  room.statics.push_back(Block("carpet", {1.0, 4.0, 0.04}, {2.75, 2.0, 0.02}));
  room.statics.push_back(Block("beam", {0.3, 4.0, 0.3}, {2.0, 2.0, 1.4}));  // robot's top: 1.2 m
  ExpectArrivedAt(kEast, DriveIn(room, kWest, kEast));
  room.statics.push_back(Block("barrier", {0.1, 4.0, 0.3}, {2.75, 2.0, 1.0}));
  ExpectFailed("no_path", DriveIn(room, kWest, kEast));
}

TEST(MoveBaseTest, SaysWhyThereIsNoWay) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {1.0, 1.0, 0.8}, {4.5, 2.0, 0.4}));
  ExpectFailed("goal_blocked", DriveIn(room, kWest, kEast));
  ExpectFailed("start_blocked", DriveIn(room, kEast, kWest));
  world::World divided = Room();
  divided.statics.push_back(Block("fence", {0.1, 4.0, 0.8}, {2.75, 2.0, 0.4}));
  ExpectFailed("no_path", DriveIn(divided, kWest, kEast));
}

TEST(MoveBaseTest, LeavesAnObstacleThatItsLocalisationLetsItTouch) {
  world::World room = Room();
  room.statics.push_back(Block("pillar", {0.3, 0.3, 0.8}, {1.0, 2.0 + 0.25 + 0.15 - 0.04, 0.4}));
  const auto context = ContextOf(room);
  ASSERT_GE(context->costmap->FootprintCost(context->footprint, kWest), navigation::kLethalCost);
  MoveBase skill(context, kEast, kFast);
  bool is_out = false;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto*, auto* robot) {
    const bool touches =
        context->costmap->FootprintCost(context->footprint, robot->X_MB) >= navigation::kLethalCost;
    EXPECT_FALSE(touches && is_out) << "it came back to x " << robot->X_MB.x;
    is_out = is_out || !touches;
  });
  ExpectArrivedAt(kEast, run);
}

TEST(MoveBaseTest, AGoalOutsideOfTheMapIsBlocked) {
  ExpectFailed("goal_blocked", DriveIn(Room(), kWest, {40.0, 2.0, 0.0}));
}

TEST(MoveBaseTest, SeesObstaclesThatAreNotInTheMap) {
  MoveBase skill(ContextOf(Room()), kEast, kFast);
  const geometry::Polygon crate{{2.5, 1.5}, {3.0, 1.5}, {3.0, 2.5}, {2.5, 2.5}};
  double nearest = 1e9;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    seen->obstacles_M = {crate};
    nearest = std::min(
        nearest, geometry::Distance(
                     geometry::Transformed(robot->X_MB, TrayRobot().profile.footprint), crate));
  });
  ExpectArrivedAt(kEast, run);
  EXPECT_GT(nearest, 0.0);
}

TEST(MoveBaseTest, ShowsThePathAndTheCostmapThatItDrivesBy) {
  MoveBase skill(ContextOf(Room()), kEast, kFast);
  EXPECT_FALSE(skill.drive_view()) << "it has not looked yet";
  const geometry::Polygon crate{{2.5, 1.5}, {3.0, 1.5}, {3.0, 2.5}, {2.5, 2.5}};
  int num_seen = 0;
  std::shared_ptr<const std::vector<Pose2>> path;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto*) {
    if (num_seen++ > 0) path = skill.drive_view()->path;
    if (num_seen > 10) seen->obstacles_M = {crate};
  });
  ExpectArrivedAt(kEast, run);
  ASSERT_TRUE(path);
  EXPECT_LE(DistanceBetween(path->front(), kWest), 1e-12);
  EXPECT_LE(DistanceBetween(path->back(), kEast), 1e-12);
  EXPECT_EQ(skill.drive_view()->path, path) << "nothing made it plan again";
  const navigation::Costmap& costmap = *skill.drive_view()->costmap;
  EXPECT_EQ(costmap.CostBelow(crate), navigation::kLethalCost);
  EXPECT_LT(DistanceBetween(skill.drive_view()->X_MB, run.robot.X_MB), 0.1);
}

TEST(MoveBaseTest, ShowsANewPathWhenItPlansAgain) {
  MoveBase skill(ContextOf(Room()), kEast, kFast);
  const Pose2 aside{1.0, 3.2, 0.0};
  Pose2 planned_from;
  RunSkill(&skill, {kWest, {}, true}, [&](auto* seen, auto* robot) {
    if (seen->time > 2.0) robot->X_MB = aside;
    if (skill.drive_view()) planned_from = skill.drive_view()->path->front();
  });
  EXPECT_LE(DistanceBetween(planned_from, aside), 1e-12) << "held, it plans again from there";
}

TEST(MoveBaseTest, ShowsNoPathWhereThereIsNone) {
  MoveBase skill(ContextOf(Room()), {40.0, 2.0, 0.0}, kFast);
  ExpectFailed("goal_blocked", RunSkill(&skill, {kWest, {}, false}));
  EXPECT_FALSE(skill.drive_view());
}

/// Four bars round the robot, close enough that it can neither drive nor turn.
std::vector<geometry::Polygon> CageRound(const Pose2& X_MB) {
  const auto bar = [&](double x_min, double y_min, double x_max, double y_max) {
    return geometry::Transformed(X_MB,
                                 {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}});
  };
  return {bar(0.4, -0.5, 0.5, 0.5), bar(-0.5, -0.5, -0.4, 0.5), bar(-0.4, 0.35, 0.4, 0.45),
          bar(-0.4, -0.45, 0.4, -0.35)};
}

TEST(MoveBaseTest, GivesUpInACageAfterItsPatience) {
  MoveBase skill(ContextOf(Room()), kEast, kFast);
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    if (seen->time > 2.0) seen->obstacles_M = CageRound(robot->X_MB);
  });
  ExpectFailed("no_valid_trajectory", run);
  EXPECT_THAT(run.status.failure.detail, testing::HasSubstr("a thing that stands about"));
  EXPECT_NEAR(run.duration, 2.0 + MoveBaseParams{}.controller_patience, 1.0);
  EXPECT_EQ(run.last_command.vx, 0.0);
}

TEST(MoveBaseTest, DrivesOnWhenTheCageOpens) {
  MoveBase skill(ContextOf(Room()), kEast, kFast);
  ExpectArrivedAt(kEast, RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
                    if (seen->time > 2.0 && seen->time < 10.0) {
                      seen->obstacles_M = CageRound(robot->X_MB);
                    }
                  }));
}

TEST(MoveBaseTest, AHeldRobotOscillates) {
  MoveBaseParams params;
  params.oscillation_timeout = 4.0;
  MoveBase skill(ContextOf(Room(), params), kEast, kFast);
  const SkillRun run = RunSkill(&skill, {kWest, {}, true});
  ExpectFailed("oscillating", run);
  EXPECT_NEAR(run.duration, 8.0, 0.5);  // once it plans anew
}

TEST(MoveBaseTest, HalfTheDistanceCountsAsMotionInRadians) {
  MoveBaseParams params;
  params.oscillation_timeout = 4.0;
  params.oscillation_distance = 0.5;
  const auto turn_to_and_fro = [&](double by) {
    MoveBase skill(ContextOf(Room(), params), kEast, kFast);
    return RunSkill(
        &skill, {kWest, {}, true},
        [&](auto* seen, auto* robot) {
          robot->X_MB.yaw = std::fmod(seen->time, 4.0) < 2.0 ? 0.0 : by;
        },
        15.0);
  };
  ExpectFailed("oscillating", turn_to_and_fro(0.2));
  EXPECT_EQ(turn_to_and_fro(0.3).status.progress, Progress::kRunning);
}

TEST(MoveBaseTest, TheSameSeenGivesTheSameBits) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.0, 0.8}, {2.75, 2.0, 0.4}));
  const SkillRun first = DriveIn(room, kWest, kEast), second = DriveIn(room, kWest, kEast);
  EXPECT_EQ(first.robot.X_MB.x, second.robot.X_MB.x);
  EXPECT_EQ(first.robot.X_MB.y, second.robot.X_MB.y);
  EXPECT_EQ(first.robot.X_MB.yaw, second.robot.X_MB.yaw);
  EXPECT_EQ(first.duration, second.duration);
}

TEST(DrivingContextTest, PadsTheFootprint) {
  const auto context = ContextOf(Room());
  EXPECT_NEAR(context->footprint.front().x(), -0.3 - 0.015, 1e-12);
  EXPECT_NEAR(context->footprint.front().y(), -0.25 - 0.015, 1e-12);
}

TEST(DrivingContextTest, TheMapCoversAreasFarFromAnyBody) {
  world::World plain = Room();
  plain.statics = {Block("pillar", {0.5, 0.5, 1.0}, {20.0, 2.0, 0.5})};
  ExpectArrivedAt(kEast, DriveIn(plain, kWest, kEast));
  plain.statics.clear();
  ExpectArrivedAt(kEast, DriveIn(plain, kWest, kEast));
}

TEST(DrivingContextTest, ARecordedMapWillDo) {
  world::OccupancyGrid grid;
  grid.width = 120;
  grid.height = 80;
  grid.cells.assign(120 * 80, world::Cell::kFree);
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(grid, TrayRobot(), MoveBaseParams()));
  MoveBase skill(context, kEast, kFast);
  ExpectArrivedAt(kEast, RunSkill(&skill, {kWest, {}, false}));
}

// -------------------------------------------------------------------------------------- arms

/// The PR2's joints with both arms carrying something, or in the posture of that name.
robot::JointPositions ArmsOf(const robot::Robot& pr2, const std::string& posture, bool holds) {
  robot::JointPositions joints = pr2.profile.joints;
  for (const auto& [name, arm] : pr2.profile.upper_body->arms) {
    SetJoints(arm.joints, PosturePositions(arm, posture, holds), &joints);
  }
  return joints;
}

DrivingContext Pr2In(const world::World& world, const MoveBaseParams& params = {}) {
  static const robot::Robot pr2 =
      robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return MakeDrivingContext(world, pr2, params);
}

TEST(FootprintOfTest, ArmsAreInItWhereTheyStickOut) {
  const DrivingContext context = Pr2In(Room());
  const robot::Robot& pr2 = *context.robot;
  EXPECT_EQ(FootprintOf(context, {}), context.footprint) << "nobody knows where they are";
  EXPECT_EQ(FootprintOf(context, pr2.profile.joints), context.footprint);
  EXPECT_EQ(FootprintOf(context, ArmsOf(pr2, "armtuckedposture", false)), context.footprint);
  const auto carrying = ArmsOf(pr2, "armcarryposture", true);
  const geometry::Polygon wide = FootprintOf(context, carrying);
  for (const Eigen::Vector2d& corner : context.footprint)
    EXPECT_TRUE(geometry::Contains(wide, corner));
  for (const Eigen::Vector2d& corner :
       robot::OutlineOf(pr2.model, pr2.profile.base_link, carrying)) {
    EXPECT_TRUE(geometry::Contains(wide, corner)) << corner.transpose();
  }
  EXPECT_TRUE(geometry::Contains(wide, {0.2, 0.45}) && geometry::Contains(wide, {0.2, -0.45}))
      << "elbows";
}

TEST(FootprintOfTest, WhatCarriesNothingHasOnlyOne) {
  const auto context = ContextOf(Room());
  EXPECT_EQ(FootprintOf(*context, {{"wheel", 1.0}}), context->footprint);
}

/// The nearest that a drive comes to what stands about [m]; 0: it touches.
double ClearanceOfDrive(const world::World& world, const std::vector<geometry::Polygon>& posts,
                        const std::string& posture, bool holds, const MoveBaseParams& params = {}) {
  const auto context = std::make_shared<const DrivingContext>(Pr2In(world, params));
  const auto joints = ArmsOf(*context->robot, posture, holds);
  const geometry::Polygon outline =
      robot::OutlineOf(context->robot->model, context->robot->profile.base_link, joints);
  MoveBase skill(context, kEast, kFast);
  double clearance = 1e9;
  const SkillRun run =
      RunSkill(&skill, {kWest, {}, false}, [&](robot::Observation* seen, PointRobot* robot) {
        seen->joints = joints;
        for (const geometry::Polygon& post : posts) {
          clearance = std::min(
              clearance, geometry::Distance(geometry::Transformed(robot->X_MB, outline), post));
        }
      });
  ExpectArrivedAt(kEast, run);
  return clearance;
}

TEST(MoveBaseTest, ArmsThatStickOutTouchNothing) {
  // Two posts: the base has 0.1 m of room on each side of it, arms that carry would touch both.
  world::World room = Room();
  room.statics.clear();
  std::vector<geometry::Polygon> posts;
  for (const double y : {1.5, 2.5}) {
    room.statics.push_back(Block("post", {0.1, 0.1, 1.0}, {2.75, y, 0.5}));
    posts.push_back(geometry::Transformed(
        {2.75, y, 0.0}, {{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}}));
  }
  EXPECT_GT(ClearanceOfDrive(room, posts, "armtuckedposture", false), 0.0);
  EXPECT_GT(ClearanceOfDrive(room, posts, "armcarryposture", true), 0.0);
}

/// What arms keep from things where the place errs and nothing shows how far.
TEST(MoveBaseTest, ArmsThatStickOutKeepTheMarginOfThePlace) {
  MoveBaseParams erring;
  erring.place_margin = 0.1;
  base::Rng rng(31);
  for (int i = 0; i < hires::test_support::Rounds(24); ++i) {
    world::World room = Room();
    const double x = rng.Uniform(2.2, 3.3), y = rng.Uniform(1.4, 2.6);
    room.statics = {Block("post", {0.1, 0.1, 1.0}, {x, y, 0.5})};
    const std::vector<geometry::Polygon> posts{geometry::Transformed(
        {x, y, 0.0}, {{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}})};
    EXPECT_GE(ClearanceOfDrive(room, posts, "armcarryposture", true, erring), 0.1) << x << " " << y;
  }
}

/// A drive with a leg below an arm that the map lacks: as an obstacle, or in the laser's scans.
void ExpectALegIsNotDrivenInto(bool by_laser) {
  MoveBaseParams params;
  if (by_laser) params.obstacle_layer.emplace();
  const auto context = std::make_shared<const DrivingContext>(Pr2In(Room(), params));
  const auto joints = ArmsOf(*context->robot, "armcarryposture", true);
  const geometry::Polygon leg{{1.18, 2.40}, {1.22, 2.40}, {1.22, 2.44}, {1.18, 2.44}};
  ASSERT_TRUE(geometry::Contains(FootprintOf(*context, joints), {0.2, 0.42}));
  std::vector<geometry::Polygon> outlines = world::OutlinesInBand(Room(), nullptr, 0.27, 0.27);
  outlines.push_back(leg);
  MoveBase skill(context, {1.2, 3.3, 1.57}, kFast);
  double clearance = 1e9;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    seen->joints = joints;
    if (by_laser) {
      seen->X_OB = robot->X_MB;
      seen->scan = std::make_shared<const robot::PlacedScan>(
          hires::test_support::ScanOf(outlines, robot->X_MB, robot->X_MB, {0.275, 0.0, 0.0}));
    } else {
      seen->obstacles_M = {leg};
    }
    clearance = std::min(
        clearance, geometry::Distance(
                       geometry::Transformed(robot->X_MB, context->robot->profile.footprint), leg));
  });
  EXPECT_GT(clearance, 0.0);
  ExpectFailed("no_valid_trajectory", run);
}

TEST(MoveBaseTest, WhatIsSeenBelowTheArmsIsNotDrivenInto) { ExpectALegIsNotDrivenInto(false); }

TEST(MoveBaseTest, WhatTheLaserSeesBelowTheArmsIsNotDrivenInto) { ExpectALegIsNotDrivenInto(true); }

// ------------------------------------------------------------------------------------- blind

const robot::BaseControllerParams kSideways;

robot::BaseControllerParams TwoDrivenWheels() {
  robot::BaseControllerParams base;
  base.drive = robot::Drive::kDifferential;
  return base;
}

TEST(MoveBaseBlindTest, ArrivesWithinItsTolerances) {
  const MoveBaseBlindParams params;
  for (const Pose2& goal : {Pose2{1.8, 2.0, 0.0}, Pose2{0.6, 2.3, 1.2}, Pose2{1.0, 2.0, 3.1}}) {
    MoveBaseBlind skill(params, goal, kFast, kSideways);
    const SkillRun run = RunSkill(&skill, {kWest, {}, false});
    EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
    EXPECT_LE(DistanceBetween(run.robot.X_MB, goal), params.xy_tolerance);
    EXPECT_LE(std::abs(geometry::WrapToPi(run.robot.X_MB.yaw - goal.yaw)), params.yaw_tolerance);
    EXPECT_LE(run.fastest, params.max_velocity + 1e-9);
    EXPECT_LE(run.fastest_turn, params.max_angular_velocity + 1e-9);
  }
}

TEST(MoveBaseBlindTest, TwoDrivenWheelsArriveWithoutDrivingSideways) {
  const MoveBaseBlindParams params;
  for (const Pose2& goal : {Pose2{1.8, 2.0, 0.0}, Pose2{0.6, 2.3, 1.2}, Pose2{1.0, 2.0, 3.1},
                            Pose2{1.0, 2.4, 0.0}, Pose2{1.02, 1.9, -3.0}, Pose2{0.2, 2.01, 0.0}}) {
    MoveBaseBlind skill(params, goal, kFast, TwoDrivenWheels());
    double sideways = 0.0;
    const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto*, auto* robot) {
      sideways = std::max(sideways, std::abs(robot->V_B.vy));
    });
    EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
    EXPECT_EQ(sideways, 0.0);
    EXPECT_LE(DistanceBetween(run.robot.X_MB, goal), params.xy_tolerance);
    EXPECT_LE(std::abs(geometry::WrapToPi(run.robot.X_MB.yaw - goal.yaw)), params.yaw_tolerance);
    EXPECT_LE(run.fastest, params.max_velocity + 1e-9);
    EXPECT_LE(run.fastest_turn, params.max_angular_velocity + 1e-9);
  }
}

TEST(MoveBaseBlindTest, ACarArrivesOnArcsThatItCanSteer) {
  const MoveBaseBlindParams params;
  robot::BaseControllerParams car;
  car.drive = robot::Drive::kCarLike;
  car.min_turning_radius = kRadius;
  for (const Pose2& goal :
       {Pose2{1.8, 2.0, 0.0}, Pose2{0.6, 2.3, 1.2}, Pose2{1.0, 2.0, 3.1}, Pose2{1.0, 2.05, 0.0}}) {
    MoveBaseBlind skill(params, goal, kFast, car);
    const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto*, auto* driven) {
      EXPECT_EQ(driven->V_B.vy, 0.0);
      EXPECT_LE(std::abs(driven->V_B.wz), std::abs(driven->V_B.vx) / kRadius + 1e-9);
    });
    EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
    EXPECT_LE(DistanceBetween(run.robot.X_MB, goal), params.xy_tolerance);
    EXPECT_LE(std::abs(geometry::WrapToPi(run.robot.X_MB.yaw - goal.yaw)), params.yaw_tolerance);
    EXPECT_LE(run.fastest, params.max_velocity + 1e-9);
    EXPECT_LE(run.fastest_turn, params.max_angular_velocity + 1e-9);
  }
  MoveBaseBlind held(params, {1.8, 2.0, 0.0}, kFast, car);
  ExpectFailed("stuck", RunSkill(&held, {kWest, {}, true}));
}

TEST(MoveBaseBlindTest, TwoDrivenWheelsBackOffInsteadOfTurningTwice) {
  MoveBaseBlind skill({}, {0.4, 2.0, 0.0}, kFast, TwoDrivenWheels());
  const SkillRun run = RunSkill(&skill, {{1.0, 2.0, 0.0}, {}, false});
  EXPECT_EQ(run.status.progress, Progress::kSucceeded);
  EXPECT_EQ(run.fastest_turn, 0.0);
}

TEST(MoveBaseBlindTest, ARobotThatReactsLateDoesNotOvershoot) {
  const MoveBaseBlindParams params;
  const Pose2 goal{1.8, 2.0, 0.0};
  MoveBaseBlind skill(params, goal, kFast, kSideways);
  std::deque<double> on_the_way(3, 0.0);  // [m/s], one per cycle: 0.15 s
  robot::Observation seen;
  seen.X_MB = kWest;
  double farthest = kWest.x;
  for (Status status; status.progress == Progress::kRunning; seen.time += params.period) {
    ASSERT_LT(seen.time, 30.0);
    robot::Command command;
    status = skill.Update(seen, &command);
    on_the_way.push_back(command.base_velocity->vx);
    seen.V_B.vx = on_the_way.front();
    on_the_way.pop_front();
    seen.X_MB.x += params.period * seen.V_B.vx;
    farthest = std::max(farthest, seen.X_MB.x);
  }
  EXPECT_LE(farthest, goal.x + 0.005);
  EXPECT_NEAR(seen.X_MB.x, goal.x, params.xy_tolerance);
}

TEST(MoveBaseBlindTest, TakesTheShorterTurn) {
  MoveBaseBlind skill({}, {1.0, 2.0, -3.0}, kFast, kSideways);
  const SkillRun run = RunSkill(&skill, {{1.0, 2.0, 3.0}, {}, false});
  EXPECT_EQ(run.status.progress, Progress::kSucceeded);
  EXPECT_LT(run.duration, 2.0);
}

TEST(MoveBaseBlindTest, ASlowerMotionSetWins) {
  MoveBaseBlind skill({}, {1.8, 2.0, 1.0}, {0.1, 0.2, 1.4, 2.0}, kSideways);
  const SkillRun run = RunSkill(&skill, {kWest, {}, false});
  EXPECT_EQ(run.status.progress, Progress::kSucceeded);
  EXPECT_LE(run.fastest, 0.1 + 1e-9);
  EXPECT_LE(run.fastest_turn, 0.2 + 1e-9);
}

TEST(MoveBaseBlindTest, SucceedsOnlyWhenItStands) {
  MoveBaseBlind skill({}, kWest, kFast, kSideways);
  robot::Observation seen;
  seen.X_MB = kWest;
  seen.V_B = {0.2, 0.0, 0.0};
  robot::Command command;
  EXPECT_EQ(skill.Update(seen, &command).progress, Progress::kRunning);
  ASSERT_TRUE(command.base_velocity);
  EXPECT_EQ(command.base_velocity->vx, 0.0);
  seen.V_B = {};
  EXPECT_EQ(skill.Update(seen, &command).progress, Progress::kSucceeded);
}

TEST(MoveBaseBlindTest, IsStuckWhenItComesNoNearer) {
  const MoveBaseBlindParams params;
  MoveBaseBlind held(params, {1.8, 2.0, 0.0}, kFast, kSideways);
  const SkillRun run = RunSkill(&held, {kWest, {}, true});
  ExpectFailed("stuck", run);
  EXPECT_NEAR(run.duration, params.stuck_timeout, 2.0 * params.period);

  MoveBaseBlind later(params, {4.5, 2.0, 0.0}, kFast, kSideways);
  const SkillRun stopped = RunSkill(&later, {kWest, {}, false}, [](auto* seen, auto* robot) {
    robot->is_held = seen->time > 4.0;
  });
  ExpectFailed("stuck", stopped);
  EXPECT_NEAR(stopped.duration, 4.0 + params.stuck_timeout, 0.2);
}

}  // namespace
}  // namespace hires::skills::move_base_test
