#include "skills/driving/way_blocked.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/world/occupancy_grid.h"
#include "skills/laser_robot.h"
#include "skills/point_robot.h"
#include "support/rounds.h"
#include "support/scenes.h"

namespace hires::skills::way_blocked_test {
namespace {

using base::FailureCode;
using geometry::Pose2;
using hires::test_support::Block;
using hires::test_support::Room;
using hires::test_support::Rounds;
using hires::test_support::TrayRobot;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr double kCell = 0.05;  // [m]
const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};

/// What a drive says at once.
Status FirstWord(std::shared_ptr<const DrivingContext> context, const Pose2& from,
                 const Pose2& to) {
  MoveBase skill(std::move(context), to, kSlow);
  robot::Observation seen;
  seen.X_MB = from;
  robot::Command command;
  return skill.Update(seen, &command);
}

/// With an arm held out to the left: one link more, and so much more of footprint.
robot::Robot WithArm(double length) {
  robot::Robot robot = TrayRobot();
  robot::Link arm;
  arm.name = "arm";
  arm.joint = robot::Joint();
  arm.joint->name = "shoulder";
  arm.joint->parent = 0;
  arm.collisions = {hires::test_support::Shape("arm", geometry::Box{{0.06, length, 0.06}},
                                               {0.0, 0.25 + 0.5 * length, 0.5})};
  robot.model.links.push_back(arm);
  std::vector<Eigen::Vector2d> corners = robot.profile.footprint;
  corners.emplace_back(-0.03, 0.25 + length);
  corners.emplace_back(0.03, 0.25 + length);
  robot.profile.footprint = geometry::ConvexHull(corners);
  return robot;
}

/// Two halves of a wall with a door, across the way from (0, 0) to (6, 0), all turned.
world::World WithDoor(double width, double thickness, double yaw) {
  world::World world;
  const double half = 8.0;
  const double y = 0.5 * (width + half);
  for (const double side : {1.0, -1.0}) {
    world::StaticBody wall = Block(side > 0.0 ? "left_wall" : "right_wall", {thickness, half, 2.0},
                                   {3.0, side * y, 1.0});
    wall.X_MB = geometry::Lift({0.0, 0.0, yaw}) * wall.X_MB;
    world.statics.push_back(wall);
  }
  // So long a way round that it is none: the walls reach the map's ends.
  for (const double side : {1.0, -1.0}) {
    world::StaticBody end = Block("end", {14.0, 0.2, 2.0}, {3.0, side * (0.5 * width + half), 1.0});
    end.X_MB = geometry::Lift({0.0, 0.0, yaw}) * end.X_MB;
    world.statics.push_back(end);
  }
  for (const double x : {-4.0, 10.0}) {
    world::StaticBody end = Block("end", {0.2, width + 2.0 * half, 2.0}, {x, 0.0, 1.0});
    end.X_MB = geometry::Lift({0.0, 0.0, yaw}) * end.X_MB;
    world.statics.push_back(end);
  }
  return world;
}

/// [m] Across headings within 0.52 rad of its way's.
double LeastWidth(const geometry::Polygon& footprint) {
  double least = 1e9;
  for (double yaw = -0.49; yaw < 0.5; yaw += 0.035) {
    double lowest = 1e9, highest = -1e9;
    for (const Eigen::Vector2d& p : geometry::Transformed({0.0, 0.0, yaw}, footprint)) {
      lowest = std::min(lowest, p.y());
      highest = std::max(highest, p.y());
    }
    least = std::min(least, highest - lowest);
  }
  return least;
}

TEST(WayBlockedTest, AFootprintWiderThanTheOnlyDoorIsNoPathAtOnce) {
  base::Rng rng(11);
  for (int i = 0; i < Rounds(48); ++i) {
    const double arm = rng.Uniform(0.4, 1.0), yaw = rng.Uniform(-3.0, 3.0);
    const double wide = 0.5 + arm + 2.0 * 0.015;
    const double door = rng.Uniform(0.75, wide - 3.0 * kCell);
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(WithDoor(door, rng.Uniform(0.1, 0.4), yaw), WithArm(arm), {}));
    const Pose2 X_MT{0.0, 0.0, yaw};
    const Status status = FirstWord(context, X_MT, X_MT * Pose2{6.0, 0.0, 0.0});
    ASSERT_EQ(status.failure.code, FailureCode::kNoPath)
        << "door " << door << " robot " << wide << " yaw " << yaw;
    EXPECT_THAT(
        status.failure.detail,
        AllOf(HasSubstr("the way ends at"),
              HasSubstr(fmt::format("the base is {:.2f} m wide", LeastWidth(context->footprint))),
              HasSubstr("'arm' reaches farthest"), HasSubstr("_wall'")));
  }
}

TEST(WayBlockedTest, ADoorThatIsWideEnoughIsPlannedThrough) {
  base::Rng rng(12);
  for (int i = 0; i < Rounds(48); ++i) {
    const double arm = rng.Uniform(0.1, 0.8), yaw = rng.Uniform(-3.0, 3.0);
    const double door = 0.5 + arm + 0.03 + rng.Uniform(0.2, 1.0);
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(WithDoor(door, rng.Uniform(0.1, 0.4), yaw), WithArm(arm), {}));
    const Pose2 X_MT{0.0, 0.0, yaw};
    const Status status = FirstWord(context, X_MT, X_MT * Pose2{6.0, 0.0, 0.0});
    EXPECT_EQ(ToString(status.failure), "") << "door " << door << " arm " << arm << " yaw " << yaw;
  }
}

TEST(WayBlockedTest, WhatStandsAtAGoalIsNamedWithItsLine) {
  base::Rng rng(13);
  for (int i = 0; i < Rounds(40); ++i) {
    world::World room = Room();
    const Eigen::Vector3d p_M(rng.Uniform(2.0, 5.0), rng.Uniform(1.0, 3.0), 0.4);
    room.statics.push_back(Block("crate", {rng.Uniform(0.3, 0.8), 0.5, 0.8}, p_M));
    room.sources["crate"] = "room.world:7";
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(room, TrayRobot(), MoveBaseParams{}));
    const Pose2 at{p_M.x(), p_M.y(), 0.0};
    for (const double beside : {0.0, 0.5}) {
      const Pose2 goal{at.x, at.y + beside - (beside > 0.0 ? 0.1 : 0.0), 0.0};
      const Status status = FirstWord(context, {1.0, 2.0, 0.0}, goal);
      ASSERT_EQ(status.failure.code, FailureCode::kGoalBlocked);
      EXPECT_THAT(status.failure.detail,
                  AllOf(HasSubstr("the goal at x"), HasSubstr("'crate' (room.world:7)")));
    }
    const Status start = FirstWord(context, at, {1.0, 2.0, 0.0});
    EXPECT_EQ(start.failure.code, FailureCode::kStartBlocked);
    EXPECT_THAT(start.failure.detail, AllOf(HasSubstr("the start at x"), HasSubstr("'crate'")));
  }
}

/// A box whose root is not in its middle.
robot::Robot WithRootAskew(double length, double width, double askew) {
  robot::Robot robot = TrayRobot();
  const double right = -0.5 * width + askew, left = 0.5 * width + askew;
  robot.profile.footprint = {
      {-0.5 * length, right}, {0.5 * length, right}, {0.5 * length, left}, {-0.5 * length, left}};
  return robot;
}

/// A car with a bed far to one side: what a round robot would stand clear of, the bed reaches into.
robot::Robot CarWithBed(double length, double yaw) {
  robot::Robot robot = TrayRobot();
  std::vector<Eigen::Vector2d> corners = robot.profile.footprint;
  for (const double side : {0.2, -0.2}) {
    corners.push_back(Eigen::Rotation2Dd(yaw) * Eigen::Vector2d(length, side));
  }
  robot.profile.footprint = geometry::ConvexHull(corners);
  robot.profile.base_controller.drive = robot::Drive::kCarLike;
  robot.profile.base_controller.min_turning_radius = 0.5;
  return robot;
}

/// Of a base as long as a bus.
robot::Robot LongRobot(double length, double width) {
  robot::Robot robot = WithRootAskew(length, width, 0.0);
  robot.profile.base_controller.drive = robot::Drive::kDifferential;
  return robot;
}

robot::Robot LongRobotWithLaser(double length, double width) {
  robot::Robot robot = LongRobot(length, width);
  const robot::Robot with_laser = test_support::RobotWithLaser({0.3, 0.0, 0.0});
  robot.model = with_laser.model;
  robot.profile.laser_link = with_laser.profile.laser_link;
  return robot;
}

MoveBaseParams WithObstacleLayer() {
  MoveBaseParams params;
  params.obstacle_layer.emplace();
  return params;
}

TEST(WayBlockedTest, AMapOfAWorldHasRoomForTheLongestBaseAtItsAreas) {
  base::Rng rng(31);
  for (int i = 0; i < Rounds(24); ++i) {
    const double length = rng.Uniform(0.5, 12.0), yaw = rng.Uniform(-3.0, 3.0);
    world::World world;
    if (i % 2 == 0) world.statics.push_back(Block("post", {0.2, 0.2, 2.0}, {0.0, 9.0, 1.0}));
    if (i % 4 == 0)  // so wide that its map covers what lies round the areas
      world.statics.push_back(Block("far", {0.2, 0.2, 2.0}, {400.0, 9.0, 1.0}));
    const Pose2 from{rng.Uniform(-3.0, 3.0), 0.0, yaw}, to = from * Pose2{2.0, 0.0, 0.0};
    hires::test_support::AddArea(&world, "from", geometry::Lift(from));
    hires::test_support::AddArea(&world, "to", geometry::Lift(to));
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(world, LongRobot(length, 0.6), MoveBaseParams{}));
    MoveBase skill(context, to, kSlow);
    const test_support::SkillRun run = test_support::RunSkill(&skill, {from, {}});
    EXPECT_EQ(run.status.progress, Progress::kSucceeded)
        << "length " << length << " m: " << ToString(run.status.failure);
  }
}

TEST(WayBlockedTest, ABaseThatReachesBeyondTheMapIsToldAtOnce) {
  world::OccupancyGrid map;
  map.resolution = kCell;
  map.width = map.height = 300;
  map.cells.assign(300 * 300, world::Cell::kFree);
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(map, LongRobot(8.0, 0.6), MoveBaseParams{}));
  const auto said = [&](const Pose2& from, const Pose2& to, FailureCode code) {
    const Status status = FirstWord(context, from, to);
    EXPECT_EQ(status.failure.code, code) << status.failure.detail;
    return status.failure.detail;
  };
  EXPECT_THAT(said({3.007, 7.0, 0.0}, {7.0, 7.0, 0.0}, FailureCode::kStartBlocked),
              AllOf(HasSubstr("the start at x 3.01 m, y 7.00 m lies at the map's end"),
                    HasSubstr("the base, 8.03 m long and 0.63 m wide with its padding, reaches "
                              "1.01 m beyond it")));
  EXPECT_THAT(said({6.0, 7.0, 0.0}, {13.007, 7.0, 0.0}, FailureCode::kGoalBlocked),
              AllOf(HasSubstr("the goal at x 13.01 m"), HasSubstr("2.02 m beyond it")));
  EXPECT_EQ(said({5.0, 7.0, 0.0}, {11.1, 7.0, 0.0}, {}), "") << "within the goal's tolerance";
  EXPECT_EQ(said({5.0, 1.0, 0.0}, {9.0, 1.0, 0.0}, {}), "") << "beside the map's end";
}

TEST(WayBlockedTest, ABaseThatCannotTurnSaysWhatItTouches) {
  world::World hall;
  hall.statics = {Block("north", {60.0, 0.2, 2.0}, {0.0, 3.0, 1.0}),
                  Block("south", {60.0, 0.2, 2.0}, {0.0, -3.0, 1.0})};
  hall.sources["north"] = "hall.world:2";
  const auto end_of = [&](double length, const Pose2& to) {
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(hall, LongRobot(length, 0.6), MoveBaseParams{}));
    MoveBase skill(context, to, kSlow);
    return test_support::RunSkill(&skill, {{-8.0, 0.5, 0.0}, {}}, {}, 400.0).status;
  };
  const Status turned = end_of(8.0, {8.0, 0.5, geometry::kPi});
  EXPECT_EQ(turned.failure.code, FailureCode::kNoValidTrajectory);
  EXPECT_THAT(turned.failure.detail,
              AllOf(HasSubstr("the base, 8.03 m long and 0.63 m wide with its padding, cannot "
                              "turn at x "),
                    HasSubstr("degrees to the left it touches 'north' (hall.world:2), "),
                    HasSubstr("degrees to the right it touches 'north' (hall.world:2)")));
  EXPECT_EQ(end_of(8.0, {8.0, 0.5, 0.0}).progress, Progress::kSucceeded);
  EXPECT_EQ(end_of(3.0, {8.0, 0.5, geometry::kPi}).progress, Progress::kSucceeded);
}

// Where the round that fits into a base is clear of a wall, but the base is not.
TEST(WayBlockedTest, AGoalWithRoomForTheBaseNowhereWithinItsToleranceIsToldAtOnce) {
  const double out = M_SQRT2 * kCell;  // [m] by which cells of a slanted wall reach out of it
  base::Rng rng(41);
  int num_blocked = 0, num_free = 0;
  for (int i = 0; i < Rounds(48); ++i) {
    const double length = rng.Uniform(1.6, 3.0), yaw = rng.Uniform(-3.0, 3.0);
    const double depth = rng.Uniform(-0.2, 0.45);  // of the base in the wall, if it stood right
    const double side = rng.Bernoulli(0.5) ? 1.0 : -1.0;
    const Pose2 X_MT{1.0, 2.0, yaw};
    world::World world;
    for (const double end : {-12.0, 12.0})  // so large is the map
      world.statics.push_back(Block("end", {0.2, 0.2, 2.0}, {end, end, 1.0}));
    world.statics.push_back(Block("wall", {0.4, 6.0, 2.0}, {}));
    const double to_wall = 0.5 * length + TrayRobot().profile.footprint_padding - depth;
    world.statics.back().X_MB = geometry::Lift(X_MT * Pose2{side * (to_wall + 0.2), 0.0, 0.0});
    world.statics.back().X_MB.translation.z() = 1.0;
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(world, LongRobot(length, 0.6), MoveBaseParams{}));
    const Status status = FirstWord(context, X_MT * Pose2{-4.0 * side, 0.0, 0.0}, X_MT);
    SCOPED_TRACE(fmt::format("round {}: length {} m, {} m deep", i, length, depth));
    if (depth > 0.3) {
      ++num_blocked;
      ASSERT_EQ(status.failure.code, FailureCode::kGoalBlocked);
      EXPECT_THAT(status.failure.detail,
                  AllOf(HasSubstr("the goal at x"), HasSubstr("'wall'"),
                        HasSubstr(side > 0.0 ? "to the front" : "to the back")));
    } else if (depth < 0.1) {
      ++num_free;
      EXPECT_EQ(ToString(status.failure), "");
    }
    const auto by_laser = std::make_shared<const DrivingContext>(
        MakeDrivingContext(world, LongRobotWithLaser(length, 0.6), WithObstacleLayer()));
    const Status seen = FirstWord(by_laser, X_MT * Pose2{-4.0 * side, 0.0, 0.0}, X_MT);
    // Twice the tolerance of 0.2 m, as the map may err by as much again; tried every half a cell.
    EXPECT_TRUE(depth > 0.4 - out - 0.5 * kCell || ToString(seen.failure).empty());
    if (depth > -out - 0.02 && depth < kCell) continue;  // local control keeps 0.02 m
    EXPECT_EQ(WhyGoalIsTight(*context, X_MT) != "", depth > 0.0) << "within its tolerance or not";
  }
  EXPECT_GT(num_blocked, 0);
  EXPECT_GT(num_free, 0);
}

// Its ends swing by more than the corridor has to spare for a tenth of the yaw's tolerance.
TEST(WayBlockedTest, OfALongBaseAllHeadingsWithinTheToleranceAreTried) {
  world::World hall;
  hall.statics = {Block("north", {60.0, 0.2, 2.0}, {0.0, 0.51, 1.0}),
                  Block("south", {60.0, 0.2, 2.0}, {0.0, -0.51, 1.0})};
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(hall, LongRobot(6.0, 0.6), MoveBaseParams{}));
  base::Rng rng(43);
  for (int i = 0; i < Rounds(24); ++i) {
    const Pose2 to{rng.Uniform(5.0, 7.0), 0.0, rng.Uniform(-0.16, 0.16)};
    EXPECT_EQ(ToString(FirstWord(context, {0.0, 0.0, 0.0}, to).failure), "") << "yaw " << to.yaw;
  }
}

TEST(WayBlockedTest, ABaseThatFindsNoMotionSaysWhatIsNextToIt) {
  world::World cage;
  const double gap = 0.06;  // [m] on all sides of the base
  for (const double side : {1.0, -1.0}) {
    cage.statics.push_back(Block("bars", {0.1, 3.0, 2.0}, {side * (0.25 + gap + 0.05), 0.0, 1.0}));
    cage.statics.push_back(Block("rails", {3.0, 0.1, 2.0}, {0.0, side * (0.25 + gap + 0.05), 1.0}));
    cage.statics.push_back(Block("end", {0.2, 0.2, 2.0}, {side * 8.0, side * 8.0, 1.0}));
  }
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(cage, TrayRobot(), MoveBaseParams{}));
  const Pose2 from{0.0, 0.0, 0.0};
  EXPECT_THAT(WhyNoMotion(*context, *context->costmap, context->footprint, from),
              AllOf(HasSubstr("finds no motion at x 0.00 m, y 0.00 m, yaw 0.00 rad that touches "
                              "nothing: '"),
                    HasSubstr("m from it")));
  EXPECT_EQ(WhyNoMotion(*context, *context->costmap, context->footprint, {4.0, 4.0, 0.0}), "")
      << "nothing is near";
}

TEST(WayBlockedTest, ABaseWhoseWayIsBlockedSaysWhereAndByWhat) {
  world::World hall;
  hall.statics = {Block("crate", {0.5, 0.5, 1.0}, {2.0, 0.0, 0.5}),
                  Block("end", {0.2, 0.2, 2.0}, {8.0, 8.0, 1.0}),
                  Block("end", {0.2, 0.2, 2.0}, {-8.0, -8.0, 1.0})};
  hall.sources["crate"] = "hall.world:2";
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(hall, TrayRobot(), MoveBaseParams{}));
  std::vector<Pose2> path;
  for (double x = 0.0; x < 4.0; x += 0.05) path.push_back({x, 0.0, 0.0});
  const auto said = [&](const Pose2& from) {
    return WhyNoWay(*context, *context->costmap, context->footprint, from, path);
  };
  EXPECT_THAT(said({1.0, 0.2, 0.0}),
              AllOf(HasSubstr("its way is blocked at x 1."), HasSubstr("'crate' (hall.world:2)")));
  EXPECT_EQ(said({3.5, 0.0, 0.0}), "") << "it is past that";
}

TEST(WayBlockedTest, AGoalAtWhichOnlyTheHeadingIsWrongSaysWhatReachesIntoWhat) {
  base::Rng rng(14);
  const std::vector<std::string> sides{"front", "left", "back", "right"};
  for (int i = 0; i < Rounds(40); ++i) {
    const double length = rng.Uniform(1.2, 1.6), yaw = rng.Uniform(-3.0, 3.0);
    const int side = i % 4;
    world::World world;
    for (const double end : {-12.0, 12.0}) {  // so large is the map
      world.statics.push_back(Block("end", {0.2, 0.2, 2.0}, {end, end, 1.0}));
    }
    const Pose2 X_MT{rng.Uniform(2.0, 5.0), rng.Uniform(-3.0, 3.0), yaw};
    const Eigen::Vector2d p_M =
        (X_MT * Pose2{0.0, 0.0, side * 0.5 * geometry::kPi} * Pose2{length - 0.2, 0.0, 0.0})
            .position();
    // So wide that nothing within the tolerance of the goal is clear of it.
    world.statics.push_back(Block("post", {0.5, 0.5, 1.0}, {p_M.x(), p_M.y(), 0.5}));
    world.sources["post"] = "hall.world:2";
    const auto context = std::make_shared<const DrivingContext>(MakeDrivingContext(
        world, CarWithBed(length, side * 0.5 * geometry::kPi), MoveBaseParams{}));
    const Status status = FirstWord(context, X_MT * Pose2{-4.0, 0.0, 0.0}, X_MT);
    ASSERT_EQ(status.failure.code, FailureCode::kGoalBlocked) << "length " << length;
    EXPECT_THAT(
        status.failure.detail,
        AllOf(HasSubstr(fmt::format("m to the {}, into 'post' (hall.world:2)", sides[side])),
              HasSubstr("turn it"), ::testing::Not(HasSubstr("wanted at least"))));
  }
}

// What is wider than a door by a few mm is said to be, with both widths; what has two cells to
// spare at each side finds its way.
TEST(WayBlockedTest, WhatIsSaidOfADoorAgreesWithWhetherTheFootprintFits) {
  base::Rng rng(15);
  int num_wider = 0;
  for (int i = 0; i < Rounds(64); ++i) {
    const double width = rng.Uniform(0.6, 1.0), askew = rng.Uniform(-0.2, 0.2);
    const double wide = width + 2.0 * TrayRobot().profile.footprint_padding;
    const bool is_wider = rng.Bernoulli(0.5);
    const double door = is_wider ? wide - rng.Uniform(0.003, 0.1) : wide + rng.Uniform(0.2, 0.4);
    const double yaw = rng.Bernoulli(0.5) ? 0.0 : rng.Uniform(-3.0, 3.0);
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(WithDoor(door, rng.Uniform(0.1, 0.4), yaw),
                           WithRootAskew(rng.Uniform(0.5, 0.8), width, askew), {}));
    const Pose2 X_MT{0.0, 0.0, yaw};
    const Status status = FirstWord(context, X_MT, X_MT * Pose2{6.0, 0.0, 0.0});
    SCOPED_TRACE(fmt::format("door {} wide {} askew {} yaw {}", door, wide, askew, yaw));
    if (!is_wider) {
      EXPECT_EQ(ToString(status.failure), "");
      continue;
    }
    ++num_wider;
    ASSERT_EQ(status.failure.code, FailureCode::kNoPath);
    EXPECT_THAT(status.failure.detail,
                AllOf(HasSubstr(fmt::format("the base is {:.2f} m wide", wide)),
                      AnyOf(HasSubstr(fmt::format("it is {:.2f} m wide there", door)),
                            HasSubstr(fmt::format("it is {:.2f} m wide there", door + 0.005)),
                            HasSubstr("there is too little room"))));
  }
  EXPECT_GT(num_wider, 3);
}

/// Two slabs along the way from (0, 0) to (6, 0), with a gap from x 3 on and a bridge over it, all
/// turned.
world::World WithGap(double gap, double bridge, double yaw) {
  world::World world;
  world.ground_depth = 1.0;
  world.statics = {Block("near_slab", {6.0, 8.0, 0.2}, {0.0, 0.0, -0.1}),
                   Block("far_slab", {6.0, 8.0, 0.2}, {6.0 + gap, 0.0, -0.1})};
  if (bridge > 0.0) {
    world.statics.push_back(Block("bridge", {gap, bridge, 0.2}, {3.0 + 0.5 * gap, 0.0, -0.1}));
  }
  for (world::StaticBody& body : world.statics)
    body.X_MB = geometry::Lift({0.0, 0.0, yaw}) * body.X_MB;
  return world;
}

TEST(WayBlockedTest, GroundThatNoFloorBearsIsNotDrivenOver) {
  base::Rng rng(14);
  for (int i = 0; i < Rounds(40); ++i) {
    const double yaw = rng.Uniform(-3.0, 3.0), gap = rng.Uniform(0.15, 2.0);
    const bool is_wide = i % 2 == 0;
    const double bridge = is_wide ? rng.Uniform(0.9, 2.0) : rng.Uniform(0.0, 0.4);
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(WithGap(gap, bridge, yaw), TrayRobot(), MoveBaseParams{}));
    const Pose2 X_MT{0.0, 0.0, yaw}, start = X_MT, goal = X_MT * Pose2{4.5 + gap, 0.0, 0.0};
    const Status over = FirstWord(context, start, goal);
    const Pose2 off = X_MT * Pose2{3.0 + 0.5 * gap, bridge + 1.0, 0.0};
    const Status onto = FirstWord(context, start, off);
    const Status from = FirstWord(context, off, start);
    ASSERT_EQ(onto.failure.code, FailureCode::kGoalBlocked) << "gap " << gap;
    EXPECT_THAT(onto.failure.detail, AllOf(HasSubstr("no floor bears the robot at x"),
                                           HasSubstr("the goal"), HasSubstr("_slab' ends")));
    ASSERT_EQ(from.failure.code, FailureCode::kStartBlocked);
    EXPECT_THAT(from.failure.detail, AllOf(HasSubstr("no floor bears"), HasSubstr("the start")));
    if (is_wide) {
      EXPECT_EQ(ToString(over.failure), "") << "gap " << gap << " bridge " << bridge;
      continue;
    }
    ASSERT_EQ(over.failure.code, FailureCode::kNoPath) << "gap " << gap << " bridge " << bridge;
    EXPECT_THAT(over.failure.detail,
                AllOf(HasSubstr("the way ends at"), HasSubstr("no floor bears the robot"),
                      HasSubstr("ends")));
  }
}

/// Free but for a border, x 0 .. 6, y 0 .. 4.
world::OccupancyGrid Plain() {
  world::OccupancyGrid map;
  map.width = 120;
  map.height = 80;
  map.cells.assign(120 * 80, world::Cell::kFree);
  return map;
}

void Fill(double x_from, double x_to, world::Cell cell, world::OccupancyGrid* map) {
  for (int row = 0; row < map->height; ++row) {
    for (int column = 0; column < map->width; ++column) {
      const double x = map->CentreOf(column, row).x();
      if (x > x_from && x < x_to) map->cells[row * map->width + column] = cell;
    }
  }
}

TEST(WayBlockedTest, UnmappedGroundAndWallsOfAMapAreToldApart) {
  base::Rng rng(14);
  for (int i = 0; i < Rounds(40); ++i) {
    const double from = rng.Uniform(2.5, 3.0);
    const Pose2 west{1.0, 2.0, 0.0}, east{5.0, rng.Uniform(1.0, 3.0), 0.0};
    world::OccupancyGrid parted = Plain(), unmapped = Plain();
    Fill(from, from + 0.1, world::Cell::kOccupied, &parted);
    Fill(from, 6.0, world::Cell::kUnknown, &unmapped);
    const auto context_of = [](const world::OccupancyGrid& map) {
      return std::make_shared<const DrivingContext>(
          MakeDrivingContext(map, TrayRobot(), MoveBaseParams{}));
    };
    const Status no_way = FirstWord(context_of(parted), west, east);
    EXPECT_EQ(no_way.failure.code, FailureCode::kNoPath);
    EXPECT_THAT(no_way.failure.detail,
                AllOf(HasSubstr("the way ends at x 2."), HasSubstr("a wall of the map")));
    const Status goal = FirstWord(context_of(unmapped), west, east);
    EXPECT_EQ(goal.failure.code, FailureCode::kGoalBlocked);
    EXPECT_THAT(goal.failure.detail, HasSubstr("is unmapped (unknown)"));
    const Status start = FirstWord(context_of(unmapped), east, west);
    EXPECT_EQ(start.failure.code, FailureCode::kStartBlocked);
    EXPECT_THAT(start.failure.detail, HasSubstr("is unmapped (unknown)"));
  }
}

// Of dots that nobody mapped, so close that a circle passes between them and the base does not, a
// drive says what is in the way, however it ends.
TEST(WayBlockedTest, UnmappedDotsAreSaidToBeInTheWay) {
  base::Rng rng(16);
  int num_stuck = 0;
  for (int i = 0; i < Rounds(24); ++i) {
    world::OccupancyGrid map = Plain();
    for (int row = 0; row < map.height; row += 11 + static_cast<int>(rng.Uniform(0.0, 3.0)))
      for (int k = 0; k < 2; ++k) map.cells[row * map.width + 60 + 4 * k] = world::Cell::kUnknown;
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(map, WithArm(0.3), MoveBaseParams{}));
    MoveBase skill(context, {5.0, 2.0, 0.0}, kSlow);
    test_support::PointRobot robot;
    robot.X_MB = {1.0, 2.0, 0.0};
    const auto run = test_support::RunSkill(&skill, robot, {}, 120.0);
    if (run.status.progress == Progress::kSucceeded) continue;
    ++num_stuck;
    EXPECT_THAT(run.status.failure.detail, HasSubstr("unmapped (unknown)")) << i;
  }
  EXPECT_GT(num_stuck, 0);
}

// However thin the walls beside it are, and it is deep.
TEST(WayBlockedTest, ASillInTheOnlyDoorIsNamedWithItsHeight) {
  base::Rng rng(5);
  for (int i = 0; i < Rounds(24); ++i) {
    const double width = rng.Uniform(1.2, 2.0), yaw = rng.Uniform(-3.1, 3.1);
    const double height = rng.Uniform(0.045, 0.078);  // [m]; shapes of this robot end at 0.04 m
    world::World world = WithDoor(width, rng.Uniform(0.06, 0.3), yaw);
    world::StaticBody sill =
        Block("sill", {rng.Uniform(0.06, 0.4), width, height}, {3.0, 0.0, 0.5 * height});
    sill.X_MB = geometry::Lift({0.0, 0.0, yaw}) * sill.X_MB;
    world.statics.push_back(sill);
    const auto context = std::make_shared<const DrivingContext>(
        MakeDrivingContext(world, TrayRobot(), MoveBaseParams{}));
    const Pose2 turned{0.0, 0.0, yaw};
    const Status status = FirstWord(context, turned, turned * Pose2{6.0, 0.0, 0.0});
    EXPECT_EQ(status.failure.code, FailureCode::kNoPath) << i;
    EXPECT_THAT(status.failure.detail,
                AllOf(HasSubstr("'sill"), HasSubstr(fmt::format("it is {:.3f} m high", height)),
                      HasSubstr("reach down to 0.040 m")))
        << i;
  }
}

TEST(WayBlockedTest, TheWayRoundATooNarrowDoorIsTaken) {
  world::World world = WithDoor(0.9, 0.2, 0.0);
  world.statics.erase(world.statics.begin() + 2, world.statics.begin() + 4);  // so there is a way
  const auto context = std::make_shared<const DrivingContext>(
      MakeDrivingContext(world, WithArm(0.8), MoveBaseParams{}));
  MoveBase skill(context, {6.0, 0.0, 0.0}, kSlow);
  robot::Observation seen;
  robot::Command command;
  EXPECT_EQ(ToString(skill.Update(seen, &command).failure), "");
  double farthest = 0.0;
  for (const Pose2& pose : *skill.drive_view()->path)
    farthest = std::max(farthest, std::abs(pose.y));
  EXPECT_GT(farthest, 8.0);
}

}  // namespace
}  // namespace hires::skills::way_blocked_test
