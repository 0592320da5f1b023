// Bases that are not equally wide at all heights, among things that stand at some heights only.
#include "skills/driving/by_height.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hires/robot/link_bounds.h"
#include "skills/played_legs.h"
#include "support/rounds.h"

namespace hires::skills::by_height_test {
namespace {

using base::FailureCode;
using geometry::Pose2;
using hires::test_support::Block;
using hires::test_support::Rounds;
using robot::Drive;
using test_support::Leg;
using test_support::PlayedLeg;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kCell = 0.05;    // [m]
constexpr double kLowest = 0.08;  // [m] what is lower is driven over, by who does not touch it
constexpr double kFloor = 0.005;  // [m] what is no higher is floor
const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};

struct Part {
  Eigen::Vector3d size, middle;
};

/// Boxes on one link, the first one the base; the footprint is their outline.
robot::Robot RobotOf(const std::vector<Part>& parts, Drive drive = Drive::kDifferential) {
  robot::Robot robot = test_support::BoxOnWheels(drive);
  robot.model.links[0].collisions.clear();
  for (const Part& part : parts) {
    robot.model.links[0].collisions.push_back(
        hires::test_support::Shape("part", geometry::Box{part.size}, part.middle));
  }
  robot.profile.footprint = robot::OutlineOf(robot.model, "base", {});
  return robot;
}

/// A flat base with a mast somewhere on it; half of them with something wide on top.
std::vector<Part> DrawnParts(base::Rng* rng) {
  const double length = rng->Uniform(0.4, 0.8), width = rng->Uniform(0.35, 0.7);
  const double top = rng->Uniform(0.15, 0.4), mast = rng->Uniform(0.06, 0.15);
  const double height = rng->Uniform(0.9, 1.6);
  const double x = rng->Uniform(-0.3, 0.1) * length;
  const double bottom = rng->Uniform(0.0, 0.1);
  std::vector<Part> parts{{{length, width, top - bottom}, {0.0, 0.0, 0.5 * (top + bottom)}},
                          {{mast, mast, height - top}, {x, 0.0, 0.5 * (height + top)}}};
  if (rng->Bernoulli(0.5)) {
    parts.push_back({{rng->Uniform(0.3, 0.6), rng->Uniform(0.3, 0.8), 0.1},
                     {x, 0.0, height - rng->Uniform(0.05, 0.4)}});
  }
  return parts;
}

Part DrawnThing(base::Rng* rng) {
  const double lower = rng->Bernoulli(0.3) ? 0.0 : rng->Uniform(0.0, 1.5);
  const double upper = lower + rng->Uniform(0.02, 0.8);
  return {{rng->Uniform(0.05, 0.8), rng->Uniform(0.05, 0.8), upper - lower},
          {rng->Uniform(1.0, 4.0), rng->Uniform(1.0, 4.0), 0.5 * (lower + upper)}};
}

world::World WorldOf(const std::vector<Part>& things) {
  world::World world = test_support::EmptyFloor({5.0, 5.0});
  for (const Part& thing : things) {
    world.statics.push_back(
        Block("thing" + std::to_string(world.statics.size()), thing.size, thing.middle));
  }
  world.hash = world.ComputeHash();
  return world;
}

geometry::Polygon OutlineOf(const Part& part) {
  return geometry::CornersOf({{part.middle.x(), part.middle.y(), 0.0}, part.size.head<2>()});
}

/// [m] between the heights of two parts; negative where they overlap.
double HeightBetween(const Part& a, const Part& b) {
  return std::abs(a.middle.z() - b.middle.z()) - 0.5 * (a.size.z() + b.size.z());
}

bool Touches(const std::vector<Part>& parts, const Pose2& X_MB, const std::vector<Part>& things) {
  for (const Part& thing : things) {
    if (thing.middle.z() + 0.5 * thing.size.z() <= kFloor) continue;
    for (const Part& part : parts) {
      if (HeightBetween(part, thing) <= 0.0 &&
          geometry::Distance(geometry::Transformed(X_MB, OutlineOf(part)), OutlineOf(thing)) == 0.0)
        return true;
    }
  }
  return false;
}

Pose2 DrawnPose(base::Rng* rng) {
  return {rng->Uniform(0.0, 5.0), rng->Uniform(0.0, 5.0), rng->Uniform(-3.14, 3.14)};
}

TEST(ByHeightTest, WhereAFootprintIsFreeNoPartTouchesAnything) {
  int layered = 0, opened = 0;
  for (int i = 0; i < Rounds(300); ++i) {
    base::Rng rng = base::Rng(41).Fork(i);
    const std::vector<Part> parts = DrawnParts(&rng);
    std::vector<Part> things;
    for (int k = 1 + static_cast<int>(rng.Uniform(0.0, 6.0)); k > 0; --k)
      things.push_back(DrawnThing(&rng));
    const DrivingContext context = MakeDrivingContext(WorldOf(things), RobotOf(parts), {});
    layered += context.costmap->has_layers() ? 1 : 0;
    for (int k = 0; k < 60; ++k) {
      const Pose2 X_MB = DrawnPose(&rng);
      if (context.costmap->FootprintCost(context.body, X_MB) >= navigation::kLethalCost) continue;
      EXPECT_FALSE(Touches(parts, X_MB, things)) << i;
      if (context.costmap->FootprintCost(context.footprint, X_MB) >= navigation::kLethalCost)
        ++opened;
    }
  }
  EXPECT_GT(3 * layered, Rounds(300));
  EXPECT_GT(opened, Rounds(300)) << "places that one footprint for all heights would not have";
}

/// Mast and base only: what is over the base and beside the mast is in no way.
TEST(ByHeightTest, WhatIsOverTheBaseAndBesideTheMastIsFree) {
  int under = 0;
  for (int i = 0; i < Rounds(300); ++i) {
    base::Rng rng = base::Rng(42).Fork(i);
    std::vector<Part> parts = DrawnParts(&rng);
    parts.resize(2);
    Part top = DrawnThing(&rng);
    const double over = parts[0].middle.z() + 0.5 * parts[0].size.z();
    top.middle.z() = over + 2.0 * kHeightStep + kHeightSlack + 0.5 * top.size.z();
    const DrivingContext context = MakeDrivingContext(WorldOf({top}), RobotOf(parts), {});
    const geometry::Polygon mast = OutlineOf(parts[1]);  // and padding, rounding and two cells
    for (int k = 0; k < 60; ++k) {
      const Pose2 X_MB = DrawnPose(&rng);
      if (geometry::Distance(geometry::Transformed(X_MB, mast), OutlineOf(top)) < 3.0 * kCell)
        continue;
      EXPECT_LT(context.costmap->FootprintCost(context.body, X_MB), navigation::kLethalCost) << i;
      under +=
          Touches({{parts[0].size + Eigen::Vector3d(0.0, 0.0, 9.0), parts[0].middle}}, X_MB, {top})
              ? 1
              : 0;
    }
  }
  EXPECT_GT(2 * under, Rounds(300)) << "or it shows little";
}

/// @param whole  covers all of `part`, with cells in the same places.
void ExpectSameCosts(const navigation::Costmap& part, const navigation::Costmap& whole) {
  for (int row = 0; row < part.height(); ++row) {
    for (int column = 0; column < part.width(); ++column) {
      int x = 0, y = 0;
      whole.CellOf(part.CentreOf(column, row), &x, &y);
      ASSERT_TRUE(whole.Inside(x, y));
      ASSERT_EQ(part.cost(column, row), whole.cost(x, y));
    }
  }
}

/// Robots with a footprint of their own, or of one width, and worlds in which all stands on the
/// floor.
TEST(ByHeightTest, WhereNothingDiffersTheMapIsOneSlice) {
  for (int i = 0; i < Rounds(90); ++i) {
    base::Rng rng = base::Rng(43).Fork(i);
    std::vector<Part> parts = DrawnParts(&rng);
    const int kind = i % 3;
    if (kind == 2) parts.resize(2);
    if (kind == 0) parts = {{{0.6, 0.5, 1.0}, {0.0, 0.0, 0.54}}};
    robot::Robot robot = RobotOf(parts);
    if (kind == 1) robot.profile.footprint = geometry::Padded(robot.profile.footprint, 0.1);
    std::vector<Part> things;
    for (int k = 1 + static_cast<int>(rng.Uniform(0.0, 6.0)); k > 0; --k) {
      things.push_back(DrawnThing(&rng));
      if (kind == 2) things.back().middle.z() = 0.5 * things.back().size.z();
    }
    const world::World world = WorldOf(things);
    const DrivingContext context = MakeDrivingContext(world, robot, {});
    ASSERT_FALSE(context.costmap->has_layers()) << i;
    geometry::Aabb all;
    for (const geometry::Aabb& link : robot::LinkBounds(robot)) all.Include(link);
    const auto padded = geometry::Padded(robot.profile.footprint, robot.profile.footprint_padding);
    const double lowest = std::min(kLowest, std::max(kFloor, all.lower.z()));
    const navigation::Costmap one(world::SliceWorld(world, lowest, all.upper.z(), kCell, 8.0),
                                  geometry::InscribedRadius(padded), {});
    ExpectSameCosts(*context.costmap, one);
    EXPECT_TRUE(context.body.by_layer.empty());
  }
}

TEST(ByHeightTest, WhatStandsOnATrayCounts) {
  robot::Robot robot =
      RobotOf({{{0.6, 0.5, 0.2}, {0.0, 0.0, 0.14}}, {{0.1, 0.1, 1.0}, {-0.2, 0.0, 0.7}}});
  EXPECT_EQ(SplitByHeight(robot, kLowest, 1.2).narrow.size(), 1u);
  robot.profile.tray_link = "base";
  EXPECT_TRUE(SplitByHeight(robot, kLowest, 1.2).narrow.empty());
}

/// A mast that no shape shows must not be taken for none.
TEST(ByHeightTest, HeightsWithoutAShapeBelowOthersCountAsTheWholeFootprint) {
  const robot::Robot robot =
      RobotOf({{{0.6, 0.5, 0.2}, {0.0, 0.0, 0.14}}, {{0.1, 0.1, 0.2}, {0.0, 0.0, 1.1}}});
  const HeightSplit split = SplitByHeight(robot, kLowest, 1.2);
  ASSERT_EQ(split.narrow.size(), 1u);
  EXPECT_GT(split.narrow[0].bands.front().first, 0.8);
}

/// Between two walls a counter from wall to wall: over the base, beside no mast.
world::World WithCounter(double lower, double thickness, double depth) {
  world::World world = test_support::EmptyFloor({6.0, 3.0});
  for (const double y : {-0.05, 3.05})
    world.statics.push_back(Block("wall", {6.4, 0.1, 2.0}, {3.0, y, 1.0}));
  for (const double x : {-0.15, 6.15})
    world.statics.push_back(Block("end", {0.1, 3.2, 2.0}, {x, 1.5, 1.0}));
  world.statics.push_back(
      Block("counter", {depth, 3.0, thickness}, {6.1 - 0.5 * depth, 1.5, lower + 0.5 * thickness}));
  world.hash = world.ComputeHash();
  return world;
}

/// Flat bases under a counter, masts and all that is wide up there before it; goals that one
/// footprint could not reach.
TEST(ByHeightTest, FlatBasesDriveUnderCountersAndTouchNothing) {
  const Drive drives[] = {Drive::kDifferential, Drive::kOmnidirectional, Drive::kCarLike};
  int refused_before = 0;
  for (int i = 0; i < Rounds(24); ++i) {
    base::Rng rng = base::Rng(44).Fork(i);
    const double top = rng.Uniform(0.15, 0.35);
    std::vector<Part> parts{{{0.6, 0.5, top - 0.04}, {0.0, 0.0, 0.5 * (top + 0.04)}},
                            {{0.1, 0.1, 1.0}, {rng.Uniform(-0.2, -0.05), 0.0, top + 0.5}}};
    const double depth = rng.Uniform(0.6, 1.0), lower = top + rng.Uniform(0.15, 0.4);
    const world::World world = WithCounter(lower, rng.Uniform(0.03, 0.2), depth);
    const robot::Robot robot = RobotOf(parts, drives[i % 3]);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, {}));
    ASSERT_TRUE(context->costmap->has_layers());
    // Its nose 0.1 to 0.2 m under the edge.
    const double nose = rng.Uniform(0.1, 0.2);
    const Leg leg{{1.0, rng.Uniform(1.0, 2.0), rng.Uniform(-0.5, 0.5)},
                  {6.1 - depth + nose - 0.3, rng.Uniform(0.8, 2.2), 0.0}};
    refused_before +=
        context->costmap->FootprintCost(context->footprint, leg.X_MGoal) >= navigation::kLethalCost
            ? 1
            : 0;
    const PlayedLeg played = test_support::PlayLeg(simulation::MakeScene(world, robot), context,
                                                   leg, kSlow, rng.Fork(7));
    EXPECT_EQ(ToString(played.status.failure), "")
        << i << " " << played.X_MB.x - leg.X_MGoal.x << " " << played.X_MB.y - leg.X_MGoal.y << " "
        << played.X_MB.yaw << " mast " << parts[1].middle.x() << " nose " << nose << " t "
        << played.duration;
    EXPECT_FALSE(played.contact) << i;
  }
  EXPECT_EQ(refused_before, Rounds(24));
}

/// A narrow base below, a wide top at the counter's height: it stops before it.
TEST(ByHeightTest, WideTopsDoNotRunIntoCounters) {
  for (int i = 0; i < Rounds(12); ++i) {
    base::Rng rng = base::Rng(45).Fork(i);
    const double lower = rng.Uniform(0.6, 0.9);
    const std::vector<Part> parts{{{0.4, 0.4, 0.26}, {0.0, 0.0, 0.17}},
                                  {{0.1, 0.1, 0.5}, {0.0, 0.0, 0.5}},
                                  {{0.7, 0.6, 0.3}, {0.0, 0.0, lower}}};
    const world::World world = WithCounter(lower, 0.05, 0.8);
    const robot::Robot robot = RobotOf(parts);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, {}));
    const double edge = 6.1 - 0.8;
    const Leg under{{1.0, 1.5, 0.0}, {edge - rng.Uniform(0.0, 0.25), 1.5, 0.0}};
    const auto scene = simulation::MakeScene(world, robot);
    const PlayedLeg refused = test_support::PlayLeg(scene, context, under, kSlow, rng.Fork(7));
    EXPECT_EQ(refused.status.failure.code, FailureCode::kGoalBlocked) << i;
    const Leg before{{1.0, 1.5, 0.0}, {edge - 0.35 - 0.3, 1.5, 0.0}};
    const PlayedLeg played = test_support::PlayLeg(scene, context, before, kSlow, rng.Fork(8));
    EXPECT_EQ(ToString(played.status.failure), "") << i;
    EXPECT_FALSE(played.contact);
  }
}

Status FirstWord(const std::shared_ptr<const DrivingContext>& context, const Leg& leg) {
  MoveBase skill(context, leg.X_MGoal, kSlow);
  robot::Observation seen;
  seen.X_MB = leg.X_MStart;
  robot::Command command;
  return skill.Update(seen, &command);
}

/// A footprint that the profile gives counts at all heights: where that alone is why, it is said.
TEST(ByHeightTest, AOneFootprintThatIsBlockedByACounterSaysTheHeights) {
  for (int i = 0; i < Rounds(30); ++i) {
    base::Rng rng = base::Rng(46).Fork(i);
    const double lower = rng.Uniform(0.5, 0.8), depth = rng.Uniform(0.6, 0.9);
    robot::Robot robot =
        RobotOf({{{0.6, 0.5, 0.26}, {0.0, 0.0, 0.17}}, {{0.1, 0.1, 1.0}, {0.0, 0.0, 0.8}}});
    const world::World world = WithCounter(lower, 0.05, depth);
    const Leg leg{{1.0, 1.5, 0.0}, {6.1 - depth - rng.Uniform(0.1, 0.15), 1.5, 0.0}};
    robot.profile.footprint = geometry::Padded(robot.profile.footprint, 0.08);
    const Status status = FirstWord(
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, {})), leg);
    ASSERT_EQ(status.failure.code, FailureCode::kGoalBlocked);
    EXPECT_THAT(status.failure.detail,
                AllOf(HasSubstr(fmt::format("'counter' is {:.2f} m to {:.2f} m up, where the robot "
                                            "is 0.10 m wide, but its footprint counts at all "
                                            "heights",
                                            lower, lower + 0.05))));
    const Leg into_the_wall{leg.X_MStart, {3.0, 0.1, 0.0}};
    const Status wall =
        FirstWord(std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, {})),
                  into_the_wall);
    EXPECT_THAT(wall.failure.detail, AllOf(HasSubstr("'wall'"), Not(HasSubstr("heights"))));
  }
}

}  // namespace
}  // namespace hires::skills::by_height_test
