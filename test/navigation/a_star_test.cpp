#include "hires/navigation/a_star.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hires/geometry/angles.h"
#include "navigation/scenes.h"

namespace hires::navigation::a_star_test {
namespace {

using namespace test_support;

CostmapParams Inflated(double radius) {
  CostmapParams params;
  params.inflation_radius = radius;
  return params;
}

/// Cells of 1 m, so that poses read like cells; nothing inflated.
Costmap PlainMap(const world::OccupancyGrid& grid) { return Costmap(grid, 0.0, Inflated(0.0)); }

geometry::Pose2 At(const Costmap& costmap, int column, int row) {
  const Eigen::Vector2d centre = costmap.CentreOf(column, row);
  return {centre.x(), centre.y(), 0.0};
}

TEST(PlanPathTest, FreeGroundCostsFiftyPerCell) {
  const Costmap costmap = PlainMap(FreeGrid(5, 3, 1.0));
  const PathResult result = PlanPath(costmap, At(costmap, 0, 0), At(costmap, 4, 2));
  ASSERT_EQ(result.status, PathStatus::kFound);
  EXPECT_NEAR(result.cost, 50.0 * (2.0 + 2.0 * std::sqrt(2.0)), 1e-9);
  EXPECT_EQ(result.path.size(), 5u);
}

TEST(PlanPathTest, CostsOfTheMapAreWeighedIn) {
  world::OccupancyGrid grid = FreeGrid(3, 1, 1.0);
  Set(&grid, 2, 0);
  CostmapParams params = Inflated(2.0);
  params.cost_scaling_factor = 1.0;
  const Costmap costmap(grid, 0.5, params);  // 252 exp(-1.5) = 56, 252 exp(-0.5) = 152
  const PathResult result = PlanPath(costmap, At(costmap, 0, 0), At(costmap, 1, 0));
  ASSERT_EQ(result.status, PathStatus::kFound);
  EXPECT_NEAR(result.cost, 50.0 + 0.8 * 152.0, 1e-9);
}

TEST(PlanPathTest, ThePathLeadsFromStartToGoalWithItsHeadings) {
  const Costmap costmap = PlainMap(FreeGrid(4, 4, 1.0));
  const PathResult result = PlanPath(costmap, {0.3, 0.4, 2.0}, {2.6, 2.7, -1.0});
  ASSERT_EQ(result.path.size(), 3u);
  EXPECT_DOUBLE_EQ(result.path.front().x, 0.3);
  EXPECT_DOUBLE_EQ(result.path.front().yaw, std::atan2(1.1, 1.2));
  EXPECT_DOUBLE_EQ(result.path[1].x, 1.5);
  EXPECT_DOUBLE_EQ(result.path.back().x, 2.6);
  EXPECT_DOUBLE_EQ(result.path.back().y, 2.7);
  EXPECT_DOUBLE_EQ(result.path.back().yaw, -1.0);
}

TEST(PlanPathTest, AGoalInTheStartsCellIsTheWholePath) {
  const Costmap costmap = PlainMap(FreeGrid(2, 2, 1.0));
  const PathResult result = PlanPath(costmap, {0.2, 0.2, 0.0}, {0.8, 0.7, 1.0});
  ASSERT_EQ(result.status, PathStatus::kFound);
  ASSERT_EQ(result.path.size(), 1u);
  EXPECT_DOUBLE_EQ(result.path[0].x, 0.8);
  EXPECT_EQ(result.cost, 0.0);
}

TEST(PlanPathTest, StartsAndGoalsWithinTheInscribedRadiusAreBlocked) {
  world::OccupancyGrid grid = FreeGrid(9, 1, 1.0);
  Set(&grid, 0, 0);
  const Costmap costmap(grid, 1.5, Inflated(4.0));
  const auto at = [&](int column) { return At(costmap, column, 0); };
  EXPECT_EQ(PlanPath(costmap, at(1), at(8)).status, PathStatus::kStartBlocked);
  EXPECT_EQ(PlanPath(costmap, at(8), at(1)).status, PathStatus::kGoalBlocked);
  EXPECT_EQ(PlanPath(costmap, at(2), at(8)).status, PathStatus::kFound);  // inflated only
  EXPECT_EQ(PlanPath(costmap, {-5.0, 0.0, 0.0}, at(8)).status, PathStatus::kStartBlocked);
  EXPECT_EQ(PlanPath(costmap, at(8), {50.0, 0.0, 0.0}).status, PathStatus::kGoalBlocked);
}

TEST(PlanPathTest, AWallWithoutADoorHasNoPath) {
  world::OccupancyGrid grid = FreeGrid(5, 5, 1.0);
  for (int row = 0; row < 5; ++row) Set(&grid, 2, row);
  const Costmap costmap = PlainMap(grid);
  const PathResult result = PlanPath(costmap, At(costmap, 0, 0), At(costmap, 4, 4));
  EXPECT_EQ(result.status, PathStatus::kNoPath);
  EXPECT_TRUE(result.path.empty());
}

TEST(PlanPathTest, NoSlippingDiagonallyBetweenBlockedCells) {
  world::OccupancyGrid grid = FreeGrid(2, 2, 1.0);
  Set(&grid, 1, 0);
  const Costmap costmap = PlainMap(grid);
  const PathResult result = PlanPath(costmap, At(costmap, 0, 0), At(costmap, 1, 1));
  ASSERT_EQ(result.status, PathStatus::kFound);
  EXPECT_NEAR(result.cost, 100.0, 1e-9);  // round the corner
}

/// The obvious road: relax all edges until nothing changes (Bellman-Ford).
double CheapestCost(const Costmap& costmap, int start, int goal) {
  const int width = costmap.width(), size = width * costmap.height();
  std::vector<double> cost(size, std::numeric_limits<double>::infinity());
  cost[start] = 0.0;
  const auto is_free = [&](int x, int y) {
    return costmap.Inside(x, y) && costmap.cost(x, y) < kInscribedCost;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int from = 0; from < size; ++from) {
      const int x = from % width, y = from / width;
      for (int k = 0; k < 9; ++k) {
        const int dx = k % 3 - 1, dy = k / 3 - 1;
        if (!is_free(x + dx, y + dy) || !is_free(x + dx, y) || !is_free(x, y + dy)) continue;
        const double weight = 50.0 + 0.8 * costmap.cost(x + dx, y + dy);
        const double through = cost[from] + std::hypot(dx, dy) * weight;
        double& known = cost[from + dy * width + dx];
        if (through >= known - 1e-9) continue;
        known = through;
        changed = true;
      }
    }
  }
  return cost[goal];
}

TEST(PlanPathTest, NoPathIsCheaperThanTheOneFound) {
  const base::Rng root(21);
  int found = 0;
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const Costmap costmap(RandomGrid(24, 18, 0.12, &rng), 0.03, Inflated(0.2));
    const int start = rng.Index(24 * 18), goal = rng.Index(24 * 18);
    const PathResult result =
        PlanPath(costmap, At(costmap, start % 24, start / 24), At(costmap, goal % 24, goal / 24));
    if (result.status == PathStatus::kStartBlocked || result.status == PathStatus::kGoalBlocked) {
      continue;
    }
    const double cheapest = CheapestCost(costmap, start, goal);
    if (result.status == PathStatus::kNoPath) {
      EXPECT_TRUE(std::isinf(cheapest)) << "seed " << seed;
      continue;
    }
    ++found;
    EXPECT_NEAR(result.cost, cheapest, 1e-6) << "seed " << seed;
  }
  EXPECT_GT(found, 50);
}

/// (column, row) becomes (height - 1 - row, column).
world::OccupancyGrid TurnedLeft(const world::OccupancyGrid& grid) {
  world::OccupancyGrid turned = FreeGrid(grid.height, grid.width, grid.resolution);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      Set(&turned, grid.height - 1 - row, column, grid.at(column, row));
    }
  }
  return turned;
}

TEST(PlanPathTest, TurningTheMapByNinetyDegreesLeavesTheCostAlone) {
  const base::Rng root(22);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    world::OccupancyGrid grid = RandomGrid(30, 20, 0.1, &rng);
    Set(&grid, 1, 1, world::Cell::kFree);
    Set(&grid, 28, 18, world::Cell::kFree);
    const Costmap upright(grid, 0.0, Inflated(0.2)), turned(TurnedLeft(grid), 0.0, Inflated(0.2));
    const PathResult a = PlanPath(upright, At(upright, 1, 1), At(upright, 28, 18));
    const PathResult b = PlanPath(turned, At(turned, 18, 1), At(turned, 1, 28));
    EXPECT_EQ(a.status, b.status) << "seed " << seed;
    EXPECT_NEAR(a.cost, b.cost, 1e-6) << "seed " << seed;
  }
}

TEST(PlanPathTest, ThePathStaysOnPassableNeighbouringCellsAndIsAlwaysTheSame) {
  const base::Rng root(23);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const Costmap costmap(RandomGrid(40, 40, 0.05, &rng), 0.03, Inflated(0.3));
    const PathResult result = PlanPath(costmap, At(costmap, 2, 3), At(costmap, 37, 35));
    const PathResult again = PlanPath(costmap, At(costmap, 2, 3), At(costmap, 37, 35));
    ASSERT_EQ(result.path.size(), again.path.size());
    for (std::size_t i = 0; i < result.path.size(); ++i) {
      int column, row;
      costmap.CellOf(result.path[i].position(), &column, &row);
      EXPECT_LT(costmap.cost(column, row), kInscribedCost);
      EXPECT_EQ(result.path[i].x, again.path[i].x);
      EXPECT_EQ(result.path[i].y, again.path[i].y);
      if (i == 0) continue;
      const double step = (result.path[i].position() - result.path[i - 1].position()).norm();
      EXPECT_LT(step, 1.5 * costmap.resolution());
    }
  }
}

TEST(PlanPathTest, WithoutAPositiveNeutralCostThereIsNoSearch) {
  const Costmap costmap = PlainMap(FreeGrid(2, 2));
  AStarParams params;
  params.neutral_cost = 0.0;
  EXPECT_THROW(PlanPath(costmap, {}, {}, params), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::a_star_test
