#include "hires/navigation/costmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "navigation/scenes.h"

namespace hires::navigation::costmap_test {
namespace {

using namespace test_support;

constexpr double kInscribed = 0.1;

CostmapParams Params(double inflation_radius) {
  CostmapParams params;
  params.inflation_radius = inflation_radius;
  return params;
}

TEST(CostmapTest, CostsDecayFromAnObstacleAsWorkedOutByHand) {
  world::OccupancyGrid grid = FreeGrid(21, 21);
  Set(&grid, 10, 10);
  const Costmap costmap(grid, kInscribed, Params(0.31));
  EXPECT_EQ(costmap.cost(10, 10), kLethalCost);
  EXPECT_EQ(costmap.cost(11, 10), kInscribedCost);
  EXPECT_EQ(costmap.cost(10, 12), kInscribedCost);  // 0.10 m, just within
  EXPECT_EQ(costmap.cost(13, 10), 152);             // 252 exp(-0.5) = 152.8
  EXPECT_EQ(costmap.cost(7, 6), 56);                // 0.25 m: 252 exp(-1.5) = 56.2
  EXPECT_EQ(costmap.cost(10, 16), 34);              // 0.30 m: 252 exp(-2) = 34.1
  EXPECT_EQ(costmap.cost(10, 17), kFreeCost);       // 0.35 m
}

TEST(CostmapTest, AnEmptyGridIsFree) {
  const Costmap costmap(FreeGrid(1, 3), kInscribed, {});
  for (int row = 0; row < 3; ++row) EXPECT_EQ(costmap.cost(0, row), kFreeCost);
}

TEST(CostmapTest, UnknownCellsBlockOnlyIfTheyAreToldTo) {
  world::OccupancyGrid grid = FreeGrid(9, 1);
  Set(&grid, 4, 0, world::Cell::kUnknown);
  CostmapParams params = Params(0.31);
  const Costmap strict(grid, kInscribed, params);
  EXPECT_EQ(strict.cost(4, 0), kUnknownCost);
  EXPECT_EQ(strict.cost(5, 0), kInscribedCost);
  params.unknown_is_lethal = false;
  const Costmap trusting(grid, kInscribed, params);
  for (int column = 0; column < 9; ++column) EXPECT_EQ(trusting.cost(column, 0), kFreeCost);
}

TEST(CostmapTest, CellsAndCentresAgreeWithTheOrigin) {
  world::OccupancyGrid grid = FreeGrid(10, 10, 0.5);
  grid.origin = {-2.0, 1.0};
  const Costmap costmap(grid, kInscribed, {});
  int column, row;
  costmap.CellOf({-2.0, 1.0}, &column, &row);
  EXPECT_EQ(column, 0);
  EXPECT_EQ(row, 0);
  costmap.CellOf({-2.01, 3.7}, &column, &row);
  EXPECT_EQ(column, -1);
  EXPECT_EQ(row, 5);
  EXPECT_EQ(costmap.CentreOf(1, 0), Eigen::Vector2d(-1.25, 1.25));
  EXPECT_FALSE(costmap.Inside(-1, 5));
}

TEST(CostmapTest, RoomIsMadeBelowTheOutlineAndNowhereElse) {
  world::OccupancyGrid grid = FreeGrid(10, 10, 0.1);
  for (int row = 0; row < 10; ++row) Set(&grid, 4, row);
  const Costmap before(grid, kInscribed, Params(0.31));
  // Columns 3 to 5, rows 2 to 6.
  const Costmap after =
      before.WithRoomFor(geometry::Polygon{{0.31, 0.21}, {0.59, 0.21}, {0.59, 0.69}, {0.31, 0.69}});
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const bool is_below = column >= 3 && column <= 5 && row >= 2 && row <= 6;
      const int was = before.cost(column, row);
      EXPECT_EQ(after.cost(column, row), is_below ? std::min(was, kInscribedCost - 1) : was)
          << column << ", " << row;
    }
  }
  EXPECT_LT(after.CostBelow(geometry::Polygon{{0.31, 0.21}, {0.59, 0.21}, {0.59, 0.69}}),
            kInscribedCost);
  EXPECT_NO_THROW(before.WithRoomFor(geometry::Polygon{{-5.0, -5.0}, {0.2, 0.1}, {-5.0, 20.0}}));
}

TEST(CostmapTest, AnotherRadiusIsAsIfMadeWithIt) {
  world::OccupancyGrid grid = FreeGrid(30, 20, 0.1);
  Set(&grid, 4, 7);
  Set(&grid, 21, 12);
  grid.cells[5] = world::Cell::kUnknown;
  for (const double radius : {0.1, 0.35, 1.0}) {
    const Costmap changed = Costmap(grid, 0.2, Params(0.4)).WithInscribedRadius(radius);
    const Costmap made(grid, radius, Params(0.4 + radius - 0.2));
    for (int row = 0; row < 20; ++row) {
      for (int column = 0; column < 30; ++column) {
        EXPECT_EQ(changed.cost(column, row), made.cost(column, row)) << column << ", " << row;
      }
    }
  }
}

TEST(CostmapTest, BrokenGridsAreRefused) {
  world::OccupancyGrid grid = FreeGrid(3, 3);
  grid.cells.pop_back();
  EXPECT_THROW(Costmap(grid, kInscribed, {}), std::logic_error);
  EXPECT_THROW(Costmap(FreeGrid(0, 3), kInscribed, {}), std::logic_error);
  EXPECT_THROW(Costmap(FreeGrid(3, 3), -0.1, {}), std::logic_error);
}

/// The obvious road: look at every obstacle for every cell.
double DistanceToNearest(const world::OccupancyGrid& grid, int column, int row) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (grid.at(x, y) != world::Cell::kOccupied) continue;
      nearest = std::min(nearest, grid.resolution * std::hypot(x - column, y - row));
    }
  }
  return nearest;
}

int ExpectedCost(double distance, double inflation_radius) {
  if (distance == 0.0) return 254;
  if (distance <= kInscribed) return 253;
  if (distance > inflation_radius) return 0;
  return static_cast<int>(252.0 * std::exp(-10.0 * (distance - kInscribed)));
}

TEST(CostmapTest, EveryCostComesFromTheNearestObstacle) {
  const base::Rng root(11);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const world::OccupancyGrid grid = RandomGrid(23, 17, 0.03, &rng);
    const Costmap costmap(grid, kInscribed, Params(0.42));
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        ASSERT_EQ(costmap.cost(column, row),
                  ExpectedCost(DistanceToNearest(grid, column, row), 0.42))
            << "seed " << seed << ", cell " << column << " " << row;
      }
    }
  }
}

geometry::Polygon RandomOutline(base::Rng* rng) {
  const geometry::Pose2 X_MB{rng->Uniform(-0.2, 1.6), rng->Uniform(-0.2, 1.6),
                             rng->Uniform(-geometry::kPi, geometry::kPi)};
  const double x = rng->Uniform(0.01, 0.3), y = rng->Uniform(0.01, 0.3);
  return geometry::Transformed(X_MB, Rectangle(-x, -y, x, y));
}

bool SharesArea(const geometry::Polygon& outline, int column, int row, double resolution) {
  const double slack = 1e-9;
  const auto cell = Rectangle(column * resolution + slack, row * resolution + slack,
                              (column + 1) * resolution - slack, (row + 1) * resolution - slack);
  return geometry::Distance(outline, cell) == 0.0;
}

TEST(CostmapTest, ObstaclesAddedLaterCountAsIfTheyHadBeenInTheGrid) {
  const base::Rng root(12);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    world::OccupancyGrid grid = RandomGrid(31, 29, 0.005, &rng);
    const std::vector<geometry::Polygon> outlines{RandomOutline(&rng), RandomOutline(&rng)};
    const Costmap extended = Costmap(grid, kInscribed, {}).WithObstacles(outlines);
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        for (const auto& outline : outlines) {
          if (SharesArea(outline, column, row, grid.resolution)) Set(&grid, column, row);
        }
      }
    }
    const Costmap rebuilt(grid, kInscribed, {});
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        ASSERT_EQ(extended.cost(column, row), rebuilt.cost(column, row))
            << "seed " << seed << ", cell " << column << " " << row;
      }
    }
  }
}

/// A footprint with its parts against one map for each: what stands in a layer is in the way of the
/// part at its heights alone, whatever is done to the map.
TEST(CostmapTest, WhatStandsInALayerIsInTheWayOfThatPartAlone) {
  const base::Rng root(14);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const world::OccupancyGrid own = RandomGrid(60, 60, 0.002, &rng);
    const world::OccupancyGrid other = RandomGrid(60, 60, 0.004, &rng);
    const double radius = rng.Uniform(0.0, 0.2);
    const std::vector<geometry::Polygon> more{RandomOutline(&rng)};
    const Costmap alone = Costmap(own, 0.15, {}).WithObstacles(more);
    const Costmap layer(other, std::min(radius, 0.15), {});
    const Costmap layered = Costmap(own, 0.15, {}).WithLayer(other, radius).WithObstacles(more);
    const double x = rng.Uniform(0.02, 0.2), y = rng.Uniform(0.02, 0.2);
    Footprint footprint(Rectangle(-0.3, -0.2, 0.3, 0.2));
    footprint.by_layer = {Rectangle(-x, -y, x, y)};
    for (int i = 0; i < 20; ++i) {
      const geometry::Pose2 X_MB{rng.Uniform(0.4, 2.6), rng.Uniform(0.4, 2.6),
                                 rng.Uniform(-geometry::kPi, geometry::kPi)};
      const bool is_free = alone.FootprintCost(footprint.outline, X_MB) < kLethalCost &&
                           layer.FootprintCost(footprint.by_layer[0], X_MB) < kLethalCost;
      ASSERT_EQ(layered.FootprintCost(footprint, X_MB) < kLethalCost, is_free) << seed;
      const Costmap wider = layered.WithInscribedRadius(0.25);
      ASSERT_EQ(wider.FootprintCost(footprint, X_MB) < kLethalCost, is_free) << seed;
      const Footprint footprint_M = Transformed(X_MB, footprint);
      EXPECT_LT(layered.WithRoomFor(footprint_M).CostBelow(footprint_M), kLethalCost);
      const Costmap eased = layered.WithAccessUnder(footprint_M.outline);
      ASSERT_EQ(eased.FootprintCost(footprint, X_MB) < kLethalCost, is_free) << seed;
    }
    for (int row = 0; row < own.height; ++row) {
      for (int column = 0; column < own.width; ++column) {
        ASSERT_EQ(layered.HasObstacle(column, row),
                  alone.cost(column, row) == kLethalCost || layer.cost(column, row) == kLethalCost);
        ASSERT_GE(layered.cost(column, row), alone.cost(column, row));
        if (layer.cost(column, row) >= kInscribedCost) {
          ASSERT_GE(layered.cost(column, row), kInscribedCost);
        }
      }
    }
  }
}

TEST(CostmapTest, FootprintCostIsTheHighestOfAllCellsThatShareAreaWithIt) {
  const base::Rng root(13);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const world::OccupancyGrid grid = RandomGrid(60, 60, 0.003, &rng);
    const Costmap costmap(grid, kInscribed, {});
    const geometry::Pose2 X_MB{rng.Uniform(0.5, 2.5), rng.Uniform(0.5, 2.5),
                               rng.Uniform(-geometry::kPi, geometry::kPi)};
    const auto outline = geometry::Transformed(X_MB, Pr2Footprint());
    int highest = 0;
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        if (!SharesArea(outline, column, row, grid.resolution)) continue;
        highest = std::max<int>(highest, costmap.cost(column, row));
      }
    }
    EXPECT_EQ(costmap.FootprintCost(Pr2Footprint(), X_MB), highest) << "seed " << seed;
  }
}

class FootprintEdgeTest : public ::testing::Test {
 protected:
  FootprintEdgeTest() {
    // A resolution without rounding, and one lethal cell, x and y from 1.0 to 1.125.
    world::OccupancyGrid grid = FreeGrid(24, 24, 0.125);
    Set(&grid, 8, 8);
    costmap_ = std::make_unique<Costmap>(grid, 0.0, Params(0.0));
  }
  std::uint8_t CostAt(double x, double y) const {
    return costmap_->FootprintCost(Rectangle(-0.25, -0.25, 0.25, 0.25), {x, y, 0.0});
  }
  std::unique_ptr<Costmap> costmap_;
};

TEST_F(FootprintEdgeTest, TouchingTheEdgeOfALethalCellIsNotYetContact) {
  EXPECT_EQ(CostAt(0.75, 1.0), kFreeCost);
  EXPECT_EQ(CostAt(1.375, 1.0), kFreeCost);
  EXPECT_EQ(CostAt(1.0, 0.75), kFreeCost);
  EXPECT_EQ(CostAt(1.0, 1.375), kFreeCost);
}

TEST_F(FootprintEdgeTest, AHairFartherIsContact) {
  EXPECT_EQ(CostAt(0.75 + 1e-6, 1.0), kLethalCost);
  EXPECT_EQ(CostAt(1.375 - 1e-6, 1.0), kLethalCost);
  EXPECT_EQ(CostAt(1.0, 0.75 + 1e-6), kLethalCost);
  EXPECT_EQ(CostAt(1.0, 1.375 - 1e-6), kLethalCost);
}

TEST_F(FootprintEdgeTest, AnObstacleInTheMiddleOfTheFootprintCounts) {
  EXPECT_EQ(CostAt(1.0625, 1.0625), kLethalCost);
}

TEST_F(FootprintEdgeTest, BeyondTheMapEverythingIsLethal) {
  EXPECT_EQ(CostAt(0.25, 2.0), kFreeCost);
  EXPECT_EQ(CostAt(0.249, 2.0), kLethalCost);
  EXPECT_EQ(CostAt(2.751, 2.0), kLethalCost);
  EXPECT_EQ(CostAt(2.0, -1e12), kLethalCost);
}

}  // namespace
}  // namespace hires::navigation::costmap_test
