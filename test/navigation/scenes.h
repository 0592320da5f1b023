#pragma once

#include <cmath>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/polygon.h"
#include "hires/world/occupancy_grid.h"

namespace hires::navigation::test_support {

/// The PR2's outline, the square of its base with the nose that its navigation adds [m].
inline geometry::Polygon Pr2Footprint() {
  return {{-0.334, -0.334}, {0.334, -0.334}, {0.46, 0.0}, {0.334, 0.334}, {-0.334, 0.334}};
}

inline geometry::Polygon Rectangle(double x_min, double y_min, double x_max, double y_max) {
  return {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}};
}

inline world::OccupancyGrid FreeGrid(int width, int height, double resolution = 0.05) {
  world::OccupancyGrid grid;
  grid.resolution = resolution;
  grid.width = width;
  grid.height = height;
  grid.cells.assign(static_cast<std::size_t>(width) * height, world::Cell::kFree);
  return grid;
}

inline void Set(world::OccupancyGrid* grid, int column, int row,
                world::Cell cell = world::Cell::kOccupied) {
  grid->cells[static_cast<std::size_t>(row) * grid->width + column] = cell;
}

/// Marks the cells that share area with an upright rectangle.
inline void AddRectangle(world::OccupancyGrid* grid, double x_min, double y_min, double x_max,
                         double y_max) {
  const auto cell = [&](double value) { return value / grid->resolution; };
  for (int row = std::floor(cell(y_min - grid->origin.y()));
       row < std::ceil(cell(y_max - grid->origin.y())); ++row) {
    for (int column = std::floor(cell(x_min - grid->origin.x()));
         column < std::ceil(cell(x_max - grid->origin.x())); ++column) {
      if (column >= 0 && row >= 0 && column < grid->width && row < grid->height) {
        Set(grid, column, row);
      }
    }
  }
}

inline world::OccupancyGrid RandomGrid(int width, int height, double share, base::Rng* rng) {
  world::OccupancyGrid grid = FreeGrid(width, height);
  for (world::Cell& cell : grid.cells) {
    if (rng->Bernoulli(share)) cell = world::Cell::kOccupied;
  }
  return grid;
}

}  // namespace hires::navigation::test_support
