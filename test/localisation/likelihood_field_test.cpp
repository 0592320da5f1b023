#include "localisation/likelihood_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "localisation/distance_transform.h"

namespace hires::localisation::likelihood_field_test {
namespace {

using world::Cell;
using world::OccupancyGrid;

OccupancyGrid FreeGrid(int width, int height, double resolution = 0.1) {
  return {resolution, width, height, {0.0, 0.0}, std::vector<Cell>(width * height, Cell::kFree)};
}

std::int32_t SlowSquaredDistance(const OccupancyGrid& grid, int x, int y, std::int32_t most) {
  std::int32_t nearest = most;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (grid.at(column, row) == Cell::kOccupied)
        nearest = std::min(nearest, (column - x) * (column - x) + (row - y) * (row - y));
  return nearest;
}

TEST(DistanceTransformTest, EveryCellAgreesWithTheSlowWay) {
  base::Rng rng(7);
  for (int trial = 0; trial < 60; ++trial) {
    OccupancyGrid grid = FreeGrid(1 + rng.Index(40), 1 + rng.Index(40));
    const double density = trial % 3 == 0 ? 0.005 : trial % 3 == 1 ? 0.05 : 0.5;
    for (Cell& cell : grid.cells) {
      if (rng.Bernoulli(density))
        cell = Cell::kOccupied;
      else if (rng.Bernoulli(0.1))
        cell = Cell::kUnknown;
    }
    const std::int32_t most = trial % 2 == 0 ? 100000 : 49;
    const std::vector<std::int32_t> squared = SquaredDistances(grid, most);
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x)
        ASSERT_EQ(squared[y * grid.width + x], SlowSquaredDistance(grid, x, y, most))
            << "trial " << trial << ", cell " << x << ", " << y;
  }
}

TEST(DistanceTransformTest, MapWithoutObstaclesIsFarFromThemEverywhere) {
  for (std::int32_t squared : SquaredDistances(FreeGrid(9, 5), 64)) EXPECT_EQ(squared, 64);
}

TEST(DistanceTransformTest, GridWithoutCellsIsRefused) {
  EXPECT_ANY_THROW(SquaredDistances(OccupancyGrid{}, 1));
}

/// No beam ends within a thick wall: a robot that takes itself to be nearer to it than it is has to
/// see that it errs.
TEST(LikelihoodFieldTest, WithinAThickWallItsFaceIsWhatIsNear) {
  OccupancyGrid grid = FreeGrid(30, 20);
  for (int row = 0; row < 20; ++row)
    for (int column = 10; column < 21; ++column) grid.cells[row * 30 + column] = Cell::kOccupied;
  const LikelihoodField field(grid, 2.0);
  EXPECT_EQ(field.DistanceAt(1.05, 1.05), 0.0);
  EXPECT_EQ(field.DistanceAt(2.05, 1.05), 0.0);
  EXPECT_NEAR(field.DistanceAt(1.25, 1.05), 0.2, 1e-9);
  EXPECT_NEAR(field.DistanceAt(1.55, 1.05), 0.5, 1e-9);
  EXPECT_NEAR(field.DistanceAt(0.85, 1.05), 0.2, 1e-9);
}

TEST(LikelihoodFieldTest, DistancesAreThoseBetweenCellCentres) {
  OccupancyGrid grid = FreeGrid(20, 10);
  grid.origin = {-1.0, 2.0};
  grid.cells[3 * 20 + 4] = Cell::kOccupied;  // centre (-0.55, 2.35)
  const LikelihoodField field(grid, 0.8);
  EXPECT_NEAR(field.DistanceAt(-0.55, 2.35), 0.0, 1e-9);
  EXPECT_NEAR(field.DistanceAt(-0.25, 2.75), 0.5, 1e-9);
  EXPECT_NEAR(field.DistanceAt(0.95, 2.35), 0.8, 1e-9) << "farther than counts";
  EXPECT_NEAR(field.DistanceAt(-50.0, 2.35), 0.8, 1e-9) << "outside of the map";
  EXPECT_NEAR(field.DistanceAt(std::nan(""), 2.35), 0.8, 1e-9);
}

TEST(LikelihoodFieldTest, LikelihoodsAreThoseOfTheMixture) {
  OccupancyGrid grid = FreeGrid(30, 30);
  grid.cells[0] = Cell::kOccupied;
  const LikelihoodField field(grid, 2.0);
  const std::vector<float> table = field.LogLikelihoods(0.95, 0.05, 0.2, 10.0);
  ASSERT_EQ(table.size(), 401u);
  EXPECT_NEAR(table[0], std::log(0.955), 1e-6);        // at the obstacle
  EXPECT_NEAR(table[4], std::log(0.58120412), 1e-5);   // 1 sigma: 0.95 * 0.60653066 + 0.005
  EXPECT_NEAR(table[16], std::log(0.13356852), 1e-5);  // 2 sigma: 0.95 * 0.13533528 + 0.005
  EXPECT_NEAR(table[400], std::log(0.005), 1e-5);      // as far as counts
}

TEST(LikelihoodFieldTest, LikelihoodWithoutRandomBeamsStaysFinite) {
  const LikelihoodField field(FreeGrid(3, 3), 2.0);
  for (float value : field.LogLikelihoods(1.0, 0.0, 0.01, 10.0)) EXPECT_TRUE(std::isfinite(value));
}

TEST(LikelihoodFieldTest, DistanceOfTooManyCellsIsRefused) {
  EXPECT_NO_THROW(LikelihoodField(FreeGrid(3, 3), 25.5));
  EXPECT_THROW(LikelihoodField(FreeGrid(3, 3), 26.0), base::ConfigError);
}

}  // namespace
}  // namespace hires::localisation::likelihood_field_test
