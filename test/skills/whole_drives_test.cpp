// Whole drives in the simulator: over bases, motion sets, legs and what imagination draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "skills/played_legs.h"
#include "support/rounds.h"

namespace hires::skills::whole_drives_test {
namespace {

using geometry::Pose2;
using robot::Drive;
using test_support::Leg;
using test_support::PlayedLeg;

struct Base {
  std::string name;
  robot::Robot robot;
};

/// @param lag  [s] and the loop [rad/s] between commands and wheels; 0: none.
Base BaseOf(const std::string& name, Drive drive, double lag, double loop) {
  Base base{name, test_support::BoxOnWheels(drive)};
  robot::BaseControllerParams& controller = base.robot.profile.base_controller;
  controller.command_lag = lag;
  controller.loop_frequency = loop;
  controller.loop_damping = 0.8;
  return base;
}

std::vector<Base> Bases() {
  return {BaseOf("differential", Drive::kDifferential, 0.0, 0.0),
          BaseOf("skid_steer", Drive::kDifferential, 0.05, 10.0),
          BaseOf("car", Drive::kCarLike, 0.0, 0.0),
          BaseOf("mecanum", Drive::kOmnidirectional, 0.03, 15.0),
          BaseOf("omnidirectional", Drive::kOmnidirectional, 0.0, 0.0)};
}

/// Of gentle and brisk bases, 0.5 to 5 m/s^2; one in ten follows at once.
robot::MotionSet DrawnMotionSet(base::Rng* rng) {
  const double acceleration =
      rng->Bernoulli(0.1) ? 50.0 : 0.5 * std::pow(10.0, rng->Uniform(0.0, 1.0));
  const double speed = rng->Uniform(0.25, std::min(0.8, 0.25 + 0.5 * acceleration));
  return {speed, rng->Uniform(0.6, 1.5), acceleration, 2.0 * acceleration};
}

Pose2 DrawnPlace(const DrivingContext& context, double width, double height, base::Rng* rng) {
  const double room = geometry::CircumscribedRadius(context.footprint) + 0.15;
  geometry::Polygon circle;
  for (int i = 0; i < 16; ++i)
    circle.emplace_back(room * std::cos(i * geometry::kPi / 8),
                        room * std::sin(i * geometry::kPi / 8));
  for (;;) {
    const Pose2 X_MB{rng->Uniform(0.0, width), rng->Uniform(0.0, height),
                     rng->Uniform(-geometry::kPi, geometry::kPi)};
    if (context.costmap->FootprintCost(circle, X_MB) < navigation::kLethalCost) return X_MB;
  }
}

/// Goals of every heading; one in four faces back along its way.
Leg DrawnLeg(const DrivingContext& context, double width, double height, base::Rng* rng) {
  Leg leg{DrawnPlace(context, width, height, rng), DrawnPlace(context, width, height, rng)};
  if (!rng->Bernoulli(0.25)) return leg;
  const Eigen::Vector2d back = leg.X_MStart.position() - leg.X_MGoal.position();
  leg.X_MGoal.yaw = std::atan2(back.y(), back.x()) + rng->Uniform(-0.3, 0.3);
  return leg;
}

/// In the long suite 200; else fewer where a leg takes long, which in a house cars' plans do.
int LegsOf(bool has_things, bool is_car) {
  const int legs = hires::test_support::Rounds(200);
  if (legs == 200 || !has_things) return legs;
  return legs / (is_car ? 6 : 2);
}

/// No drive touches something, swings or runs out of time, and each is as quick as it has to be.
/// @param num_late  so many of a base's drives last longer than they may.
void ExpectArrivals(const world::World& world, bool has_things, const Eigen::Vector2d& size,
                    int num_late = 0) {
  int kind = 0;
  for (const Base& base : Bases()) {
    MoveBaseParams params;
    if (has_things) params.place_margin = test_support::PlaceMarginOf(base.robot);
    const auto scene = simulation::MakeScene(world, base.robot);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, base.robot, params));
    const base::Rng root = base::Rng(23).Fork(kind++);
    const bool is_car = base.robot.profile.base_controller.drive == Drive::kCarLike;
    const int legs = LegsOf(has_things, is_car);
    int num_without_way = 0, late = 0;
    for (int i = 0; i < legs; ++i) {
      base::Rng rng = root.Fork(i);
      const robot::MotionSet set = DrawnMotionSet(&rng);
      const Leg leg = DrawnLeg(*context, size.x(), size.y(), &rng);
      const double longest = test_support::LongestFor(*context, leg, set);
      if (longest == 0.0) {
        ++num_without_way;
        continue;
      }
      const PlayedLeg played = test_support::PlayLeg(scene, context, leg, set, rng.Fork(7));
      EXPECT_EQ(ToString(played.status.failure), "") << base.name << " " << i;
      EXPECT_LE((played.X_MB.position() - leg.X_MGoal.position()).norm(), 0.2 + 0.13);
      if (played.duration <= longest) continue;
      ++late;
      EXPECT_LE(late, num_late) << base.name << " " << i << ": " << played.duration << " s, not "
                                << longest;
    }
    // A car's search may meet its bounds where there is a way.
    EXPECT_LE(num_without_way, is_car ? 1 + legs / 50 : 0) << base.name;
  }
}

TEST(WholeDrivesTest, OnAnEmptyFloorEachArrives) {
  ExpectArrivals(test_support::EmptyFloor({8.0, 8.0}), false, {8.0, 8.0});
}

/// [m] of what it takes for its place from its way, at most.
double FarthestOffWay(const std::shared_ptr<const simulation::Scene>& scene,
                      const std::shared_ptr<const DrivingContext>& context, const Leg& leg,
                      const robot::MotionSet& set, const base::Rng& rng) {
  std::vector<Pose2> way;
  double farthest = 0.0;
  const auto look = [&](const simulation::RobotSimulator&, const robot::Observation& seen,
                        const robot::Command&) {
    if (way.empty()) way = test_support::PlannedWay(*context, {seen.X_MB, leg.X_MGoal});
    double nearest = std::numeric_limits<double>::infinity();
    for (const Pose2& X_MW : way)
      nearest = std::min(nearest, (X_MW.position() - seen.X_MB.position()).norm());
    farthest = std::max(farthest, nearest);
  };
  const PlayedLeg played = test_support::PlayLeg(scene, context, leg, set, rng, look);
  EXPECT_EQ(ToString(played.status.failure), "");
  return farthest;
}

/// Whose motion set asks for more than its controller follows steers later than it was told to.
TEST(WholeDrivesTest, CarsKeepToTheirWayWhateverTheirMotionSetAsksFor) {
  const world::World world = test_support::EmptyFloor({8.0, 8.0});
  for (int i = 0; i < hires::test_support::Rounds(40); ++i) {
    base::Rng rng = base::Rng(43).Fork(i);
    Base base = BaseOf("car", Drive::kCarLike, rng.Uniform(0.0, 0.05), 0.0);
    base.robot.profile.base_controller.limits = {rng.Uniform(0.5, 1.0), rng.Uniform(0.8, 2.0),
                                                 rng.Uniform(1.0, 2.0), rng.Uniform(2.0, 4.0)};
    const auto scene = simulation::MakeScene(world, base.robot);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, base.robot, {}));
    const robot::MotionSet set{rng.Uniform(0.3, 1.0), rng.Uniform(0.4, 2.0), 50.0, 100.0};
    const Leg leg = DrawnLeg(*context, 8.0, 8.0, &rng);
    EXPECT_LE(FarthestOffWay(scene, context, leg, set, rng.Fork(7)), 0.15) << i;
  }
}

/// Motion sets for the last centimetres, of docking or of a load that must not shake.
TEST(WholeDrivesTest, SlowMotionSetsArriveToo) {
  int kind = 0;
  const world::World world = test_support::EmptyFloor({4.0, 4.0});
  for (const Base& base : Bases()) {
    if (base.robot.profile.base_controller.drive == Drive::kCarLike) continue;
    const auto scene = simulation::MakeScene(world, base.robot);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, base.robot, {}));
    const base::Rng root = base::Rng(29).Fork(kind++);
    for (int i = 0; i < hires::test_support::Rounds(40); ++i) {
      base::Rng rng = root.Fork(i);
      const robot::MotionSet set{rng.Uniform(0.02, 0.1), rng.Uniform(0.04, 0.2),
                                 rng.Uniform(0.05, 0.5), rng.Uniform(0.1, 0.5)};
      Leg leg{{2.0, 2.0, rng.Uniform(-geometry::kPi, geometry::kPi)}, {}};
      leg.X_MGoal = {rng.Uniform(1.4, 2.6), rng.Uniform(1.4, 2.6),
                     rng.Uniform(-geometry::kPi, geometry::kPi)};
      const PlayedLeg played = test_support::PlayLeg(scene, context, leg, set, rng.Fork(7));
      EXPECT_EQ(ToString(played.status.failure), "") << base.name << " " << i;
    }
  }
}

/// Two drives in 200 of a skid-steered base come to a door at a slant and turn about before it, the
/// long way: 26.7 s in place of 25.8 s, 48.8 s in place of 33.1 s.
TEST(WholeDrivesTest, InAHouseEachArrives) {
  ExpectArrivals(test_support::House(), true, {12.0, 8.0}, 2);
}

/// Bases on two driven wheels that are nearly as wide as the doors of 0.9 m. What they touch, with
/// a place that errs by up to 0.1 m, is a jamb.
TEST(WholeDrivesTest, WideBasesComeThroughDoors) {
  const world::World world = test_support::House();
  int kind = 0, num_touched = 0;
  const int legs = hires::test_support::Rounds(48);
  for (const Eigen::Vector2d& size : {Eigen::Vector2d(0.75, 0.55), Eigen::Vector2d(0.6, 0.65)}) {
    Base base = BaseOf("skid_steer", Drive::kDifferential, 0.05, 10.0);
    const robot::BaseControllerParams controller = base.robot.profile.base_controller;
    base.robot = test_support::BoxOnWheels(Drive::kDifferential, size);
    base.robot.profile.base_controller = controller;
    MoveBaseParams params;
    params.place_margin = test_support::PlaceMarginOf(base.robot);
    const auto scene = simulation::MakeScene(world, base.robot);
    const auto context =
        std::make_shared<const DrivingContext>(MakeDrivingContext(world, base.robot, params));
    const base::Rng root = base::Rng(37).Fork(kind++);
    for (int i = 0; i < legs; ++i) {
      base::Rng rng = root.Fork(i);
      const robot::MotionSet set = DrawnMotionSet(&rng);
      const Leg leg = DrawnLeg(*context, 12.0, 8.0, &rng);
      const PlayedLeg played = test_support::PlayLeg(scene, context, leg, set, rng.Fork(7));
      if (played.contact) {
        ++num_touched;
      } else {
        EXPECT_EQ(ToString(played.status.failure), "") << size.transpose() << " " << i;
      }
    }
  }
  EXPECT_LE(num_touched, 2 * legs / 10);
}

}  // namespace
}  // namespace hires::skills::whole_drives_test
