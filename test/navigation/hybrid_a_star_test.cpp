#include "hires/navigation/hybrid_a_star.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "navigation/scenes.h"
#include "support/rounds.h"

namespace hires::navigation::hybrid_a_star_test {
namespace {

using geometry::kPi;
using geometry::Pose2;
using test_support::AddRectangle;
using test_support::FreeGrid;
using test_support::Rectangle;

constexpr double kRadius = 0.75;
const geometry::Polygon kCar = Rectangle(-0.12, -0.2, 0.52, 0.2);  // base over the axle behind

Costmap MapOf(const world::OccupancyGrid& grid) {
  return Costmap(grid, geometry::InscribedRadius(kCar), {});
}

/// 6 m x 5 m.
world::OccupancyGrid Room() { return FreeGrid(120, 100); }

int Reversals(const std::vector<CarPose>& path) {
  int count = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    count += path[i].is_backward != path[i - 1].is_backward ? 1 : 0;
  }
  return count;
}

/// A path that begins and ends where it shall, on arcs that the car can drive, and touches nothing.
void ExpectDrivable(const CarPathResult& result, const Costmap& costmap, const Pose2& from,
                    const Pose2& to) {
  ASSERT_EQ(result.status, PathStatus::kFound);
  const auto& path = result.path;
  EXPECT_EQ((path.front().X_MB.position() - from.position()).norm(), 0.0);
  EXPECT_EQ(path.front().X_MB.yaw, from.yaw);
  EXPECT_EQ((path.back().X_MB.position() - to.position()).norm(), 0.0);
  EXPECT_EQ(path.back().X_MB.yaw, to.yaw);
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_LT(costmap.FootprintCost(kCar, path[i].X_MB), kLethalCost) << i;
    if (i == 0) continue;
    // Each pose lies at the end of an arc from the one before, no sharper than the smallest circle.
    const Pose2 X_AB = path[i - 1].X_MB.Inverse() * path[i].X_MB;
    const double turn = geometry::WrapToPi(X_AB.yaw);
    const double chord = std::hypot(X_AB.x, X_AB.y);
    ASSERT_LE(chord, 0.05 + 1e-6);
    ASSERT_LE(std::abs(turn), chord / kRadius + 1e-6) << i;
    ASSERT_LE(std::abs(path[i].curvature), 1.0 / kRadius);
    ASSERT_NEAR(X_AB.y, X_AB.x * std::tan(turn / 2.0), 1e-5) << i;  // never sideways
    if (chord > 1e-6) {
      ASSERT_EQ(X_AB.x < 0.0, path[i].is_backward) << i;
    }
  }
}

CarPathResult Drive(const Costmap& costmap, const Pose2& from, const Pose2& to) {
  CarPathResult result = PlanCarPath(costmap, kCar, from, to, kRadius);
  ExpectDrivable(result, costmap, from, to);
  return result;
}

TEST(HybridAStarTest, WhereNothingStandsItTakesTheShortestWay) {
  const Costmap costmap = MapOf(Room());
  const Pose2 from{1.0, 2.0, 0.0};
  const CarPathResult straight = Drive(costmap, from, {4.5, 2.0, 0.0});
  EXPECT_NEAR(straight.cost, 3.5, 1e-6);
  EXPECT_EQ(Reversals(straight.path), 0);
  // A quarter of the circle that it plans with, which is somewhat wider than the smallest.
  const double planned = CarPathParams{}.steering_reserve * kRadius;
  const CarPathResult quarter = Drive(costmap, from, {1.0 + planned, 2.0 + planned, kPi / 2});
  EXPECT_NEAR(quarter.cost, planned * kPi / 2, 0.03);
  EXPECT_EQ(Reversals(quarter.path), 0);
}

TEST(HybridAStarTest, BackwardIsTakenWhereItIsMuchShorter) {
  const Costmap costmap = MapOf(Room());
  const CarPathResult back = Drive(costmap, {3.0, 2.5, 0.0}, {1.5, 2.5, 0.0});
  EXPECT_EQ(Reversals(back.path), 0);
  EXPECT_TRUE(back.path.back().is_backward);
  EXPECT_NEAR(back.cost, CarPathParams{}.backward_factor * 1.5, 1e-6);
  Drive(costmap, {3.0, 2.5, 0.0}, {3.0, 2.5, kPi});  // about
}

TEST(HybridAStarTest, ParksBetweenTwoCrates) {
  world::OccupancyGrid grid = Room();
  AddRectangle(&grid, 0.0, 0.0, 2.0, 0.7);
  AddRectangle(&grid, 3.5, 0.0, 6.0, 0.7);
  const Costmap costmap = MapOf(grid);
  const CarPathResult parked = Drive(costmap, {1.0, 1.3, 0.0}, {2.35, 0.35, 0.0});
  EXPECT_GE(Reversals(parked.path), 1);
}

TEST(HybridAStarTest, DrivesRoundWhatStandsInItsWay) {
  world::OccupancyGrid grid = Room();
  AddRectangle(&grid, 2.5, 0.0, 2.7, 3.5);
  const Costmap costmap = MapOf(grid);
  const CarPathResult round = Drive(costmap, {1.0, 1.0, 0.0}, {4.5, 1.0, -kPi / 2});
  EXPECT_GT(round.cost, 2.0 * std::hypot(2.5, 1.5));
}

TEST(HybridAStarTest, SaysWhyThereIsNoWay) {
  world::OccupancyGrid grid = Room();
  AddRectangle(&grid, 4.0, 1.8, 4.2, 2.2);
  const Pose2 free{1.0, 2.0, 0.0}, blocked{3.7, 2.0, 0.0};
  const Costmap costmap = MapOf(grid);
  EXPECT_EQ(PlanCarPath(costmap, kCar, free, blocked, kRadius).status, PathStatus::kGoalBlocked);
  EXPECT_EQ(PlanCarPath(costmap, kCar, blocked, free, kRadius).status, PathStatus::kStartBlocked);
  EXPECT_EQ(PlanCarPath(costmap, kCar, free, {9.0, 2.0, 0.0}, kRadius).status,
            PathStatus::kGoalBlocked);
  AddRectangle(&grid, 2.5, 0.0, 2.7, 5.0);
  const CarPathResult divided = PlanCarPath(MapOf(grid), kCar, free, {3.2, 2.0, 0.0}, kRadius);
  EXPECT_EQ(divided.status, PathStatus::kNoPath);
  EXPECT_EQ(divided.num_expansions, 0);
}

TEST(HybridAStarTest, ASearchThatLeadsNowhereEnds) {
  // A shaft that is wide enough for the car lengthwise alone: no way to turn about in it.
  world::OccupancyGrid grid = Room();
  AddRectangle(&grid, 0.0, 0.0, 6.0, 2.2);
  AddRectangle(&grid, 0.0, 2.8, 6.0, 5.0);
  const Pose2 from{1.0, 2.5, 0.0};
  const CarPathResult none = PlanCarPath(MapOf(grid), kCar, from, {4.0, 2.5, kPi}, kRadius);
  EXPECT_EQ(none.status, PathStatus::kNoPath);
  EXPECT_GT(none.num_expansions, 10);
  CarPathParams bounded;
  constexpr int kFew = 5;
  bounded.max_expansions = bounded.max_last_expansions = kFew;
  const CarPathResult cut = PlanCarPath(MapOf(grid), kCar, from, {4.0, 2.5, kPi}, kRadius, bounded);
  EXPECT_EQ(cut.status, PathStatus::kNoPath);
  EXPECT_LE(cut.num_expansions, 8 * kFew);  // with clearance and without
}

TEST(HybridAStarTest, RandomRoomsGivePathsThatCanBeDrivenAndTheSameTwice) {
  int num_found = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    base::Rng rng(seed);
    world::OccupancyGrid grid = Room();
    for (int i = 0; i < 6; ++i) {
      const double x = rng.Uniform(2.1, 3.1), y = rng.Uniform(0.0, 4.7);
      AddRectangle(&grid, x, y, x + 0.3, y + 0.3);
    }
    const Costmap costmap = MapOf(grid);
    const Pose2 from{rng.Uniform(0.7, 1.5), rng.Uniform(0.7, 4.3), rng.Uniform(-kPi, kPi)};
    const Pose2 to{rng.Uniform(4.0, 5.3), rng.Uniform(0.7, 4.3), rng.Uniform(-kPi, kPi)};
    const CarPathResult first = PlanCarPath(costmap, kCar, from, to, kRadius);
    const CarPathResult second = PlanCarPath(costmap, kCar, from, to, kRadius);
    EXPECT_EQ(first.cost, second.cost);
    EXPECT_EQ(first.num_expansions, second.num_expansions);
    ASSERT_EQ(first.path.size(), second.path.size());
    for (std::size_t i = 0; i < first.path.size(); ++i) {
      EXPECT_EQ(first.path[i].X_MB.x, second.path[i].X_MB.x);
      EXPECT_EQ(first.path[i].X_MB.y, second.path[i].X_MB.y);
      EXPECT_EQ(first.path[i].X_MB.yaw, second.path[i].X_MB.yaw);
    }
    if (first.status != PathStatus::kFound) continue;
    ++num_found;
    ExpectDrivable(first, costmap, from, to);
  }
  EXPECT_GE(num_found, 15);
}

/// Two rooms above each other with a corridor of 1.5 m between, and doors of 0.9 m.
Costmap Flat() {
  world::OccupancyGrid grid = FreeGrid(120, 160);  // 6 m x 8 m
  for (const double y : {3.15, 4.75}) {
    AddRectangle(&grid, 0.0, y, 2.55, y + 0.1);
    AddRectangle(&grid, 3.45, y, 6.0, y + 0.1);
  }
  return MapOf(grid);
}

TEST(HybridAStarTest, FindsAWayFromRoomToRoomHoweverBothEndsAreHeaded) {
  const Costmap costmap = Flat();
  const int count = hires::test_support::Rounds(80);
  int num_found = 0;
  for (int i = 0; i < count; ++i) {
    base::Rng rng = base::Rng(31).Fork(i);
    const Pose2 below{rng.Uniform(0.8, 5.2), rng.Uniform(0.8, 2.3), rng.Uniform(-kPi, kPi)};
    const Pose2 above{rng.Uniform(0.8, 5.2), rng.Uniform(5.7, 7.2), rng.Uniform(-kPi, kPi)};
    const auto result = PlanCarPath(costmap, kCar, below, above, kRadius);
    if (result.status != PathStatus::kFound) continue;
    ++num_found;
    ExpectDrivable(result, costmap, below, above);
  }
  EXPECT_GE(num_found, count - count / 20);
}

TEST(HybridAStarTest, AHastyWayCostsWhatAnyWayDoes) {
  const Costmap costmap = Flat();
  const Pose2 below{3.0, 1.2, 0.5 * kPi}, above{3.0, 6.6, 0.5 * kPi};
  CarPathParams hasty;
  hasty.max_expansions = 0;  // the last search alone finds it
  const auto late = PlanCarPath(costmap, kCar, below, above, kRadius, hasty);
  const auto first = PlanCarPath(costmap, kCar, below, above, kRadius);
  ExpectDrivable(late, costmap, below, above);
  EXPECT_NEAR(late.cost, first.cost, 0.3 * first.cost);
}

}  // namespace
}  // namespace hires::navigation::hybrid_a_star_test
