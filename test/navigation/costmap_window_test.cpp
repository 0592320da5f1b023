#include "hires/navigation/costmap_window.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "navigation/scenes.h"

namespace hires::navigation::costmap_window_test {
namespace {

std::int8_t At(const CostmapWindow& window, const Eigen::Vector2d& point) {
  const Eigen::Vector2d cell = (point - window.origin) / window.resolution;
  return window.occupancy[static_cast<std::size_t>(cell.y()) * window.width +
                          static_cast<std::size_t>(cell.x())];
}

/// 10 m x 10 m in cells of 0.5 m, an obstacle in the cell round (5.25, 5.25), robots of 0.6 m.
Costmap OneObstacle() {
  world::OccupancyGrid grid = test_support::FreeGrid(20, 20, 0.5);
  test_support::Set(&grid, 10, 10);
  return {grid, 0.6, {1.2, 1.0, true}};
}

TEST(CostmapWindowTest, CountsAsOtherProgramsDo) {
  const CostmapWindow window = WindowAround(OneObstacle(), {5.25, 5.25}, 2.0);
  EXPECT_EQ(At(window, {5.25, 5.25}), 100);
  EXPECT_EQ(At(window, {5.75, 5.25}), 99) << "0.5 m off: the robot's centre collides";
  // 1.0 m off costs 252 exp(-(1.0 - 0.6)) = 168, which is 1 + 97 * 167 / 251 of 98.
  EXPECT_EQ(At(window, {6.25, 5.25}), 65);
  EXPECT_EQ(At(window, {6.75, 5.25}), 0) << "beyond the inflation";
}

TEST(CostmapWindowTest, LiesRoundThePointsCell) {
  const CostmapWindow window = WindowAround(OneObstacle(), {3.1, 4.9}, 1.2);
  EXPECT_EQ(window.width, 5);
  EXPECT_EQ(window.occupancy.size(), 25u);
  EXPECT_EQ(window.resolution, 0.5);
  EXPECT_NEAR(window.origin.x(), 2.0, 1e-12);
  EXPECT_NEAR(window.origin.y(), 3.5, 1e-12);
}

TEST(CostmapWindowTest, WhatIsBeyondTheMapIsUnknown) {
  const CostmapWindow window = WindowAround(OneObstacle(), {0.25, 9.75}, 1.0);
  EXPECT_EQ(window.width, 5);
  EXPECT_EQ(At(window, {0.25, 9.75}), 0);
  EXPECT_EQ(At(window, {-0.25, 9.75}), -1);
  EXPECT_EQ(At(window, {0.25, 10.25}), -1);
}

TEST(CostmapWindowTest, UnknownCellsStayUnknown) {
  world::OccupancyGrid grid = test_support::FreeGrid(20, 20, 0.5);
  grid.cells[0] = world::Cell::kUnknown;
  const CostmapWindow window = WindowAround({grid, 0.0, {0.0, 1.0, true}}, {0.25, 0.25}, 0.5);
  EXPECT_EQ(At(window, {0.25, 0.25}), -1);
  EXPECT_EQ(At(window, {0.75, 0.25}), 0);
}

TEST(CostmapWindowTest, NeedsAnExtent) {
  EXPECT_THROW(WindowAround(OneObstacle(), {1.0, 1.0}, -0.1), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::costmap_window_test
