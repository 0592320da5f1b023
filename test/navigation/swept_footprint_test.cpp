#include "navigation/swept_footprint.h"

#include <gtest/gtest.h>

#include "hires/geometry/angles.h"
#include "navigation/scenes.h"
#include "navigation/velocity_window.h"

namespace hires::navigation::swept_footprint_test {
namespace {

using namespace test_support;

Costmap MapWith(std::vector<std::pair<int, int>> cells) {
  world::OccupancyGrid grid = FreeGrid(120, 120);
  for (const auto& [column, row] : cells) Set(&grid, column, row);
  return Costmap(grid, 0.334, {});
}

TEST(SweptFootprintTest, AThinPostBetweenStartAndEndIsFound) {
  const Costmap costmap = MapWith({{60, 40}});  // x 3.00 .. 3.05, y 2.00 .. 2.05
  SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  const geometry::Pose2 X_MB{2.0, 2.0, 0.0};
  EXPECT_FALSE(sweep.IsFree(costmap, X_MB, {1.0, 0.0, 0.0}, 2.0));  // stops beyond it
  EXPECT_TRUE(sweep.IsFree(costmap, X_MB, {0.0, 1.0, 0.0}, 2.0));
  EXPECT_TRUE(sweep.IsFree(costmap, X_MB, {1.0, 0.0, 0.0}, 0.539));  // the nose is 0.46 m ahead
  EXPECT_FALSE(sweep.IsFree(costmap, X_MB, {1.0, 0.0, 0.0}, 0.541));
}

TEST(SweptFootprintTest, AnObstacleBetweenTheRobotsWheelsIsContact) {
  const Costmap costmap = MapWith({{40, 40}});
  SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  EXPECT_FALSE(sweep.IsFree(costmap, {2.0, 2.0, 0.3}, {}, 0.0));
}

TEST(SweptFootprintTest, TurningSweepsTheCorners) {
  const Costmap costmap = MapWith({{32, 40}});  // x 1.60 .. 1.65, y 2.00 .. 2.05
  SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  const geometry::Pose2 X_MB{2.0, 2.0, 0.0};  // 0.35 m beside it, corners reach 0.47 m
  EXPECT_TRUE(sweep.IsFree(costmap, X_MB, {}, 0.0));
  EXPECT_FALSE(sweep.IsFree(costmap, X_MB, {0.0, 0.0, 1.0}, geometry::kPi / 2));
  EXPECT_FALSE(sweep.IsFree(costmap, X_MB, {0.0, 0.0, -1.0}, geometry::kPi / 2));
}

TEST(SweptFootprintTest, ALargerFootprintTouchesEarlier) {
  const Costmap costmap = MapWith({{60, 40}});
  SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  const geometry::Pose2 X_MB{2.5, 2.0, 0.0};
  EXPECT_LT(sweep.HighestCost(costmap, X_MB, {}, 0.0), kLethalCost);
  EXPECT_GE(sweep.HighestCost(costmap, X_MB, {}, 0.0, 1.2), kLethalCost);  // 0.552 m ahead
}

TEST(SweptFootprintTest, NoCornerMovesMoreThanHalfACellBetweenTwoPoses) {
  const Costmap costmap = MapWith({});
  const SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  const base::Rng root(51);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const geometry::Twist2 V{rng.Uniform(0, 0.6), rng.Uniform(-0.1, 0.1), rng.Uniform(-1, 1)};
    const int steps = sweep.NumSteps(costmap, V, 1.7);
    const geometry::Pose2 X_MB = PoseAfter({}, V, 1.7 / steps);
    for (const Eigen::Vector2d& corner : Pr2Footprint()) {
      EXPECT_LE((X_MB * corner - corner).norm(), 0.5 * costmap.resolution() + 1e-12);
    }
  }
}

TEST(SweptFootprintTest, TheCostIsTheHighestOfAllPosesOnTheWay) {
  const Costmap costmap = MapWith({{60, 55}, {30, 70}, {80, 20}});
  SweptFootprint sweep(Pr2Footprint(), 0.025, 0.1);
  const base::Rng root(52);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const geometry::Pose2 X_MB{rng.Uniform(1.5, 4.5), rng.Uniform(1.5, 4.5), rng.Uniform(-3, 3)};
    const geometry::Twist2 V{rng.Uniform(0, 0.55), rng.Uniform(-0.1, 0.1), rng.Uniform(-1, 1)};
    const int steps = sweep.NumSteps(costmap, V, 1.7);
    std::uint8_t highest = 0;
    for (int i = 0; i <= steps; ++i) {
      const auto X_MStep = PoseAfter(X_MB, V, 1.7 * i / steps);
      highest = std::max(highest, costmap.FootprintCost(Pr2Footprint(), X_MStep));
    }
    EXPECT_EQ(sweep.HighestCost(costmap, X_MB, V, 1.7), highest) << "seed " << seed;
  }
}

}  // namespace
}  // namespace hires::navigation::swept_footprint_test
