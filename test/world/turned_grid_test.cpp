#include "hires/world/turned_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "support/rounds.h"

namespace hires::world::turned_grid_test {
namespace {

using test_support::Rounds;
using testing::ElementsAre;

constexpr double kQuarter = EIGEN_PI / 2.0;

OccupancyGrid Drawn(base::Rng* rng, int most) {
  OccupancyGrid grid;
  grid.width = 1 + rng->Index(most);
  grid.height = 1 + rng->Index(most);
  grid.resolution = rng->Uniform(0.02, 0.5);
  grid.origin = {rng->Uniform(-20, 20), rng->Uniform(-20, 20)};
  for (int i = 0; i < grid.width * grid.height; ++i)
    grid.cells.push_back(static_cast<Cell>(rng->Index(3)));
  return grid;
}

/// Where RViz draws a point of the picture.
Eigen::Vector2d Turned(const Eigen::Vector2d& p, const OccupancyGrid& about, double yaw) {
  return about.origin + Eigen::Rotation2Dd(yaw) * (p - about.origin);
}

/// What the grid has there; beside it, unknown.
Cell At(const OccupancyGrid& grid, const Eigen::Vector2d& p) {
  const Eigen::Vector2d cell = (p - grid.origin) / grid.resolution;
  const int column = static_cast<int>(std::floor(cell.x())),
            row = static_cast<int>(std::floor(cell.y()));
  const bool is_inside = column >= 0 && row >= 0 && column < grid.width && row < grid.height;
  return is_inside ? grid.at(column, row) : Cell::kUnknown;
}

TEST(TurnedGridTest, AQuarterLaysTheBottomRowAlongTheRightEdge) {
  const OccupancyGrid grid{
      0.5,
      3,
      2,
      {4.0, 1.0},
      {Cell::kOccupied, Cell::kFree, Cell::kUnknown, Cell::kFree, Cell::kFree, Cell::kOccupied}};
  const OccupancyGrid turned = TurnedGrid(grid, 1.5708);  // as people write it
  EXPECT_EQ(turned.width, 2);
  EXPECT_EQ(turned.height, 3);
  EXPECT_EQ(turned.origin, Eigen::Vector2d(3.0, 1.0));
  EXPECT_THAT(turned.cells, ElementsAre(Cell::kFree, Cell::kOccupied, Cell::kFree, Cell::kFree,
                                        Cell::kOccupied, Cell::kUnknown));
}

TEST(TurnedGridTest, QuartersKeepEveryCellAndFourAreNone) {
  for (int seed = 0; seed < Rounds(200); ++seed) {
    base::Rng rng = base::Rng(4).Fork(seed);
    const OccupancyGrid grid = Drawn(&rng, 12);
    const int quarters = rng.Index(9) - 4;
    const OccupancyGrid turned = TurnedGrid(grid, quarters * kQuarter);
    EXPECT_EQ(turned.cells.size(), grid.cells.size());
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        const Eigen::Vector2d p = Turned(grid.CentreOf(column, row), grid, quarters * kQuarter);
        EXPECT_EQ(At(turned, p), grid.at(column, row)) << "seed " << seed;
      }
    }
    EXPECT_EQ(TurnedGrid(grid, 4 * kQuarter).cells, grid.cells);
    EXPECT_EQ(TurnedGrid(grid, 1e-9).origin, grid.origin);
  }
}

TEST(TurnedGridTest, NoPointOfAnOccupiedCellIsLostAndMiddlesHaveWhatLiesThere) {
  for (int seed = 0; seed < Rounds(400); ++seed) {
    base::Rng rng = base::Rng(9).Fork(seed);
    const OccupancyGrid grid = Drawn(&rng, 15);
    const double yaw = rng.Uniform(-7.0, 7.0);
    if (QuartersOf(yaw, grid.width, grid.height)) continue;  // a twentieth of a cell off
    const OccupancyGrid turned = TurnedGrid(grid, yaw);
    ASSERT_EQ(turned.cells.size(), static_cast<std::size_t>(turned.width) * turned.height);
    for (int i = 0; i < 300; ++i) {
      const int column = rng.Index(grid.width), row = rng.Index(grid.height);
      const Eigen::Vector2d inside(rng.Uniform(1e-4, 1 - 1e-4), rng.Uniform(1e-4, 1 - 1e-4));
      const Eigen::Vector2d p =
          grid.origin + grid.resolution * (Eigen::Vector2d(column, row) + inside);
      if (grid.at(column, row) != Cell::kOccupied) continue;
      EXPECT_EQ(At(turned, Turned(p, grid, yaw)), Cell::kOccupied) << "seed " << seed;
    }
    for (int row = 0; row < turned.height; ++row) {
      for (int column = 0; column < turned.width; ++column) {
        const Cell cell = turned.at(column, row);
        if (cell == Cell::kOccupied) continue;
        EXPECT_EQ(cell, At(grid, Turned(turned.CentreOf(column, row), grid, -yaw)))
            << "seed " << seed;
      }
    }
  }
}

TEST(TurnedGridTest, AnOccupiedCellOverlapsAnOccupiedOne) {
  for (int seed = 0; seed < Rounds(100); ++seed) {
    base::Rng rng = base::Rng(10).Fork(seed);
    const OccupancyGrid grid = Drawn(&rng, 8);
    const double yaw = rng.Uniform(-3.0, 3.0);
    const OccupancyGrid turned = TurnedGrid(grid, yaw);
    for (int row = 0; row < turned.height; ++row) {
      for (int column = 0; column < turned.width; ++column) {
        if (turned.at(column, row) != Cell::kOccupied) continue;
        bool overlaps = false;  // by looking at many points of the cell, its corners included
        for (int x = 0; x <= 40 && !overlaps; ++x) {
          for (int y = 0; y <= 40 && !overlaps; ++y) {
            const Eigen::Vector2d p =
                turned.origin +
                turned.resolution * Eigen::Vector2d(column + x / 40.0, row + y / 40.0);
            const Eigen::Vector2d p_S = Turned(p, grid, -yaw);
            for (const double shift : {-1e-3, 1e-3}) {
              overlaps |= At(grid, p_S + Eigen::Vector2d(shift, shift) * grid.resolution) ==
                          Cell::kOccupied;
            }
          }
        }
        // A corner of less than a fortieth of a cell may fall between the points.
        if (!overlaps) {
          const Eigen::Vector2d middle = Turned(turned.CentreOf(column, row), grid, -yaw);
          double nearest = 10.0;
          for (int r = 0; r < grid.height; ++r) {
            for (int c = 0; c < grid.width; ++c) {
              if (grid.at(c, r) == Cell::kOccupied)
                nearest = std::min(nearest, (grid.CentreOf(c, r) - middle).norm());
            }
          }
          EXPECT_LT(nearest, std::sqrt(2.0) * grid.resolution) << "seed " << seed;
        }
      }
    }
  }
}

TEST(TurnedGridTest, TooLargeAResultIsRefused) {
  OccupancyGrid grid{0.05, 30000, 1, {0, 0}, std::vector<Cell>(30000, Cell::kFree)};
  EXPECT_THROW(TurnedGrid(grid, 0.78), base::ConfigError);
  EXPECT_EQ(TurnedGrid(grid, kQuarter).height, 30000);
}

}  // namespace
}  // namespace hires::world::turned_grid_test
