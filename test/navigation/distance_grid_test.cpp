#include "navigation/distance_grid.h"

#include <gtest/gtest.h>

#include "navigation/scenes.h"

namespace hires::navigation::distance_grid_test {
namespace {

using namespace test_support;

CostmapParams NoInflation() {
  CostmapParams params;
  params.inflation_radius = 0.0;
  return params;
}

/// A map of 9 x 9 cells of 1 m with a wall in column 4 that leaves the rows 7 and 8 open.
Costmap WalledMap() {
  world::OccupancyGrid grid = FreeGrid(9, 9, 1.0);
  for (int row = 0; row < 7; ++row) Set(&grid, 4, row);
  return Costmap(grid, 0.0, NoInflation());
}

TEST(LocalWindowTest, CoversTheCellsAroundTheRobot) {
  LocalWindow window;
  window.Centre(WalledMap(), {4.5, 8.5}, 2.0);
  EXPECT_GE(window.CellBelow({2.5, 8.5}), 0);
  EXPECT_GE(window.CellBelow({6.99, 6.01}), 0);
  EXPECT_EQ(window.CellBelow({1.9, 8.5}), -1);
  EXPECT_EQ(window.CellBelow({7.1, 8.5}), -1);
  EXPECT_FALSE(window.passable()[window.CellBelow({4.5, 6.5})]);  // the wall
  EXPECT_FALSE(window.passable()[window.CellBelow({4.5, 9.5})]);  // beyond the map
  EXPECT_TRUE(window.passable()[window.CellBelow({4.5, 7.5})]);
}

TEST(DistanceGridTest, DistancesLeadRoundTheWall) {
  LocalWindow window;
  window.Centre(WalledMap(), {4.5, 4.5}, 4.0);
  DistanceGrid grid;
  grid.Compute(window, {window.CellBelow({3.5, 6.5})});
  const auto at = [&](double x, double y) { return grid.At(window.CellBelow({x, y})); };
  EXPECT_EQ(at(3.5, 6.5), 0);
  EXPECT_EQ(at(0.5, 5.5), 4);
  EXPECT_EQ(at(4.5, 7.5), 2);
  EXPECT_EQ(at(5.5, 6.5), 4);
  EXPECT_EQ(at(4.5, 6.5), DistanceGrid::kUnreachable);
}

TEST(DistanceGridTest, TheNearestSeedCountsAndSeedsOutsideDoNot) {
  LocalWindow window;
  window.Centre(Costmap(FreeGrid(9, 9, 1.0), 0.0, NoInflation()), {4.5, 4.5}, 4.0);
  DistanceGrid grid;
  grid.Compute(window, {-1, window.CellBelow({0.5, 0.5}), window.CellBelow({8.5, 0.5})});
  EXPECT_EQ(grid.At(window.CellBelow({6.5, 1.5})), 3);
  EXPECT_EQ(grid.At(window.CellBelow({2.5, 1.5})), 3);
  grid.Compute(window, {});
  EXPECT_EQ(grid.At(window.CellBelow({6.5, 1.5})), DistanceGrid::kUnreachable);
}

TEST(DistanceGridTest, BetweenCentresDistancesAreInterpolated) {
  LocalWindow window;
  window.Centre(WalledMap(), {4.5, 4.5}, 4.0);
  DistanceGrid grid;
  grid.Compute(window, {window.CellBelow({1.5, 1.5})});
  const auto at = [&](double x, double y) { return grid.At(*window.Around({x, y})); };
  EXPECT_DOUBLE_EQ(at(2.5, 3.5), 3.0);
  EXPECT_DOUBLE_EQ(at(2.75, 3.5), 3.25);
  EXPECT_DOUBLE_EQ(at(2.75, 4.0), 3.75);
  EXPECT_DOUBLE_EQ(at(3.75, 3.5), 4.0);  // the wall beside it has no distance
  EXPECT_FALSE(window.Around({-0.1, 4.0}).has_value());
}

TEST(DistanceGridTest, AGridThatIsUsedAgainIsAsANewOne) {
  const base::Rng root(43);
  LocalWindow window;
  DistanceGrid used;
  Costmap costmap(FreeGrid(50, 50), 0.0, NoInflation());
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    if (rng.Bernoulli(0.3)) costmap = Costmap(RandomGrid(50, 50, 0.3, &rng), 0.0, NoInflation());
    if (rng.Bernoulli(0.5)) window.Centre(costmap, {rng.Uniform(0.0, 2.5), 1.2}, 1.0);
    if (seed == 0) window.Centre(costmap, {1.2, 1.2}, 1.0);
    const std::vector<int> seeds{window.width() + 1 + static_cast<int>(rng.Uniform(0.0, 2.0))};
    DistanceGrid fresh;
    fresh.Compute(window, seeds);
    used.Compute(window, seeds);
    for (std::size_t i = 0; i < window.passable().size(); ++i) {
      ASSERT_EQ(used.At(i), fresh.At(i)) << "seed " << seed << " cell " << i;
    }
  }
}

TEST(DistanceGridTest, NeighboursDifferByOneAtMost) {
  const base::Rng root(41);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const Costmap costmap(RandomGrid(50, 50, 0.3, &rng), 0.0, NoInflation());
    LocalWindow window;
    window.Centre(costmap, {rng.Uniform(0.0, 2.5), rng.Uniform(0.0, 2.5)}, 1.0);
    const int seed_cell = window.width() * (window.width() / 2) + window.width() / 2;
    DistanceGrid grid;
    grid.Compute(window, {seed_cell});
    const auto& passable = window.passable();
    for (std::size_t i = 1; i < passable.size(); ++i) {
      if (!passable[i] || !passable[i - 1]) continue;
      EXPECT_LE(std::abs(grid.At(i) - grid.At(i - 1)), 1) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace hires::navigation::distance_grid_test
