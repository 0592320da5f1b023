#pragma once

#include <cstdint>
#include <vector>

#include "hires/world/occupancy_grid.h"

namespace hires::localisation {

/// Obstacles without what no beam gets to: cells that obstacles surround. Else a pose from which
/// beams end within a thick wall would be as good as the right one, and robots would take
/// themselves to be nearer to the walls ahead of them than they are.
world::OccupancyGrid FacesOf(const world::OccupancyGrid& grid);

/// How far each place of a map is from the nearest face of an obstacle, where beams can end, for
/// lookups without a branch: of a thick wall the cells within are as far from it as they lie deep.
/// What is kept is the square of the distance in cells: a whole number, so it is exact in 16 bits,
/// and a table of a few kB gives whatever depends on it.
///
/// A place is a cell by `Cell(...)` of coordinates in cells; all that lies outside of the map is
/// one border cell, as far from obstacles as can be.
class LikelihoodField {
 public:
  /// @param max_distance  [m] laser_likelihood_max_dist: what is farther counts as that far.
  /// @throws base::ConfigError where max_distance is more than 255 cells of the map.
  /// @pre width and height >= 1, width * height cells, resolution > 0, max_distance > 0
  LikelihoodField(const world::OccupancyGrid& grid, double max_distance);

  double resolution() const { return resolution_; }
  double max_distance() const { return max_distance_; }

  /// x, y [m] in the map to what Index wants: cells from the outer corner of the border.
  float Column(double x) const { return static_cast<float>((x - origin_.x()) * per_metre_ + 1.0); }
  float Row(double y) const { return static_cast<float>((y - origin_.y()) * per_metre_ + 1.0); }
  float PerMetre() const { return static_cast<float>(per_metre_); }

  std::int32_t Index(float column, float row) const {
    const auto x = static_cast<std::int32_t>(Clamped(column, last_column_));
    const auto y = static_cast<std::int32_t>(Clamped(row, last_row_));
    return y * stride_ + x;
  }
  std::uint16_t SquaredCells(std::int32_t index) const { return squared_[index]; }

  /// [m] from a point of the map to the nearest obstacle, between cell centres; at most
  /// max_distance.
  double DistanceAt(double x, double y) const;

  /// One number for each squared distance in cells, 0 .. that of max_distance: what a beam that
  /// ends there says by AMCL's mixture, ln(z_hit exp(-d^2 / (2 sigma^2)) + z_rand / range_max).
  /// @pre z_hit >= 0, z_rand >= 0, one of them > 0; sigma > 0, range_max > 0 [m]
  std::vector<float> LogLikelihoods(double z_hit, double z_rand, double sigma,
                                    double range_max) const;

 private:
  static float Clamped(float value, float last) {
    const float above = value > 0.0f ? value : 0.0f;  // NaN, too
    return above < last ? above : last;
  }
  double DistanceOf(int squared_cells) const;

  double resolution_, per_metre_, max_distance_;
  Eigen::Vector2d origin_;
  std::int32_t most_, stride_;
  float last_column_, last_row_;
  std::vector<std::uint16_t> squared_;  // with a border of one cell all around
};

}  // namespace hires::localisation
