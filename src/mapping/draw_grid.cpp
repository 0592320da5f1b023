#include "mapping/draw_grid.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "mapping/scan_points.h"

namespace hires::mapping {
namespace {

constexpr double kMostCells = 1e8;
constexpr double kGridBorder = 0.5;      // [m] around what is drawn
constexpr double kOccupiedShare = 0.25;  // of the beams that reached a cell

struct Beam {
  Eigen::Vector2d from, to;  // [m] in map
};

/// Beams that met something.
template <typename Use>
void ForEachBeam(const localisation::RobotLog::Scan& scan, const geometry::Pose2& X_MB,
                 double max_range, const Use& use) {
  const geometry::Pose2 X_ML = X_MB * scan.X_BL;
  for (std::size_t i = 0; i < scan.reading.ranges.size(); ++i) {
    if (HasMet(scan.reading, i, max_range))
      use(Beam{X_ML.position(), X_ML * EndOf(scan.reading, i)});
  }
}

/// How many beams passed and ended in each cell.
class BeamCounts {
 public:
  explicit BeamCounts(world::OccupancyGrid* grid)
      : grid_(*grid), passed_(grid->cells.size()), ended_(grid->cells.size()) {}

  void Add(const Beam& beam) {
    const Eigen::Vector2d from = (beam.from - grid_.origin) / grid_.resolution;
    const Eigen::Vector2d to = (beam.to - grid_.origin) / grid_.resolution;
    const std::size_t end = CellOf(static_cast<int>(to.x()), static_cast<int>(to.y()));
    ForEachCell(from, to, end);
    ++ended_[end];
  }

  void Classify() {
    for (std::size_t i = 0; i < grid_.cells.size(); ++i) {
      const double reached = static_cast<double>(passed_[i]) + ended_[i];
      if (reached == 0.0) continue;
      grid_.cells[i] =
          ended_[i] > kOccupiedShare * reached ? world::Cell::kOccupied : world::Cell::kFree;
    }
  }

 private:
  std::size_t CellOf(int column, int row) const {
    return static_cast<std::size_t>(row) * grid_.width + column;
  }

  /// All cells before `end`, from border to border [Amanatides and Woo 1987, Eurographics].
  void ForEachCell(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::size_t end) {
    int cell[2] = {static_cast<int>(from.x()), static_cast<int>(from.y())};
    const Eigen::Vector2d way = to - from;
    int step[2];
    double next[2], between[2];
    for (int axis = 0; axis < 2; ++axis) {
      step[axis] = way[axis] > 0.0 ? 1 : -1;
      between[axis] =
          way[axis] == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(way[axis]);
      const double to_border =
          way[axis] > 0.0 ? cell[axis] + 1 - from[axis] : from[axis] - cell[axis];
      next[axis] = way[axis] == 0.0 ? between[axis] : to_border * between[axis];
    }
    while (CellOf(cell[0], cell[1]) != end && std::min(next[0], next[1]) < 1.0) {
      ++passed_[CellOf(cell[0], cell[1])];
      const int axis = next[0] < next[1] ? 0 : 1;
      next[axis] += between[axis];
      cell[axis] += step[axis];
    }
  }

  world::OccupancyGrid& grid_;
  std::vector<std::uint32_t> passed_, ended_;
};

}  // namespace

world::OccupancyGrid DrawGrid(const std::vector<const localisation::RobotLog::Scan*>& scans,
                              const std::vector<geometry::Pose2>& X_MBs, double resolution,
                              double max_range) {
  Eigen::Array2d lower = Eigen::Array2d::Zero();
  if (!X_MBs.empty()) lower = X_MBs.front().position();
  Eigen::Array2d upper = lower;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    ForEachBeam(*scans[i], X_MBs[i], max_range, [&](const Beam& beam) {
      lower = lower.min(beam.from.array()).min(beam.to.array());
      upper = upper.max(beam.from.array()).max(beam.to.array());
    });
  }
  // Whole cells from the map's origin on, so that maps of one place have the same cells.
  const Eigen::Array2d first = ((lower - kGridBorder) / resolution).floor();
  const Eigen::Array2d size = ((upper + kGridBorder) / resolution).ceil() - first;
  if (size.x() * size.y() > kMostCells) {
    throw base::ConfigError(fmt::format(
        "a map of {:.0f} m x {:.0f} m has more than {:.0f} million cells of {} m; wanted larger "
        "cells, or a shorter drive",
        size.x() * resolution, size.y() * resolution, kMostCells / 1e6, resolution));
  }
  world::OccupancyGrid grid;
  grid.resolution = resolution;
  grid.origin = first * resolution;
  grid.width = static_cast<int>(size.x());
  grid.height = static_cast<int>(size.y());
  grid.cells.assign(static_cast<std::size_t>(grid.width) * grid.height, world::Cell::kUnknown);
  BeamCounts counts(&grid);
  for (std::size_t i = 0; i < scans.size(); ++i)
    ForEachBeam(*scans[i], X_MBs[i], max_range, [&](const Beam& beam) { counts.Add(beam); });
  counts.Classify();
  return grid;
}

}  // namespace hires::mapping
