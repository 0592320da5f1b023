#include "localisation/likelihood_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "localisation/distance_transform.h"

namespace hires::localisation {
namespace {

constexpr int kMostCells = 255;  // whose square fits into 16 bits

std::int32_t MostSquared(double cells) {
  return static_cast<std::int32_t>(std::ceil(cells * cells - 1e-6));
}

}  // namespace

world::OccupancyGrid FacesOf(const world::OccupancyGrid& grid) {
  world::OccupancyGrid faces = grid;
  const auto is_occupied = [&](int column, int row) {
    const bool is_outside = column < 0 || row < 0 || column >= grid.width || row >= grid.height;
    return is_outside || grid.at(column, row) == world::Cell::kOccupied;
  };
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      bool is_within = true;
      for (int k = 0; k < 9; ++k) is_within &= is_occupied(column + k % 3 - 1, row + k / 3 - 1);
      if (is_within)
        faces.cells[static_cast<std::size_t>(row) * grid.width + column] = world::Cell::kFree;
    }
  }
  return faces;
}

LikelihoodField::LikelihoodField(const world::OccupancyGrid& grid, double max_distance)
    : resolution_(grid.resolution),
      per_metre_(1.0 / grid.resolution),
      max_distance_(max_distance),
      origin_(grid.origin),
      most_(0),
      stride_(grid.width + 2),
      last_column_(grid.width + 1.0f),
      last_row_(grid.height + 1.0f) {
  HIRES_CHECK(grid.resolution > 0.0, "a cell has an edge above 0 m");
  HIRES_CHECK(max_distance > 0.0, "a distance at which obstacles end to count is above 0 m");
  const double cells = max_distance / grid.resolution;
  if (!(cells <= kMostCells)) {
    throw base::ConfigError(fmt::format(
        "laser_likelihood_max_dist is {} m, {:.0f} cells of this map, wanted at most {} "
        "cells ({:.2f} m)",
        max_distance, cells, kMostCells, kMostCells * grid.resolution));
  }
  most_ = MostSquared(cells);
  const std::vector<std::int32_t> squared = SquaredDistances(FacesOf(grid), most_);
  squared_.assign(static_cast<std::size_t>(stride_) * (grid.height + 2), most_);
  for (int row = 0; row < grid.height; ++row) {
    std::copy_n(squared.begin() + static_cast<std::ptrdiff_t>(row) * grid.width, grid.width,
                squared_.begin() + static_cast<std::ptrdiff_t>(row + 1) * stride_ + 1);
  }
}

double LikelihoodField::DistanceOf(int squared_cells) const {
  return std::min(resolution_ * std::sqrt(squared_cells), max_distance_);
}

double LikelihoodField::DistanceAt(double x, double y) const {
  return DistanceOf(SquaredCells(Index(Column(x), Row(y))));
}

std::vector<float> LikelihoodField::LogLikelihoods(double z_hit, double z_rand, double sigma,
                                                   double range_max) const {
  HIRES_CHECK(z_hit >= 0.0 && z_rand >= 0.0 && z_hit + z_rand > 0.0, "a beam ends somewhere");
  HIRES_CHECK(sigma > 0.0 && range_max > 0.0, "sigma and range are above 0 m");
  constexpr double kLeast = 1e-30;  // z_rand may be 0
  std::vector<float> table(most_ + 1);
  for (int squared = 0; squared <= most_; ++squared) {
    const double d = DistanceOf(squared) / sigma;
    const double p = z_hit * std::exp(-0.5 * d * d) + z_rand / range_max;
    table[squared] = static_cast<float>(std::log(std::max(p, kLeast)));
  }
  return table;
}

}  // namespace hires::localisation
