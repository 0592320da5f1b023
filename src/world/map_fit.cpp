#include "hires/world/map_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/geometry/angles.h"

namespace hires::world {
namespace {

using geometry::MapToWorld;
using geometry::Pose2;

std::vector<Eigen::Vector2d> Occupied(const OccupancyGrid& grid) {
  std::vector<Eigen::Vector2d> points;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) == Cell::kOccupied) points.push_back(grid.CentreOf(column, row));
    }
  }
  return points;
}

/// Where obstacles are, each grown by the tolerance; everything beyond the grid is free.
class Grown {
 public:
  Grown(const OccupancyGrid& grid, double tolerance)
      : grid_(grid), near_(grid.cells.size(), false) {
    const int reach = static_cast<int>(std::floor(tolerance / grid.resolution + 1e-9));
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        if (grid.at(column, row) == Cell::kOccupied) Grow(column, row, reach);
      }
    }
  }

  bool IsNear(const Eigen::Vector2d& p) const {
    const auto index = IndexOf(p);
    return index >= 0 && near_[index];
  }
  bool IsKnown(const Eigen::Vector2d& p) const {
    const auto index = IndexOf(p);
    return index >= 0 && grid_.cells[index] != Cell::kUnknown;
  }

 private:
  long IndexOf(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d cell = (p - grid_.origin) / grid_.resolution;
    if (!(cell.minCoeff() >= 0.0 && cell.x() < grid_.width && cell.y() < grid_.height)) return -1;
    return static_cast<long>(cell.y()) * grid_.width + static_cast<long>(cell.x());
  }

  void Grow(int column, int row, int reach) {
    for (int y = std::max(0, row - reach); y <= std::min(grid_.height - 1, row + reach); ++y) {
      for (int x = std::max(0, column - reach); x <= std::min(grid_.width - 1, column + reach);
           ++x) {
        const int dx = x - column, dy = y - row;
        if (dx * dx + dy * dy > reach * reach) continue;
        near_[static_cast<std::size_t>(y) * grid_.width + x] = true;
      }
    }
  }

  const OccupancyGrid& grid_;
  std::vector<bool> near_;
};

constexpr std::size_t kEnough = 1500;  // obstacles' cells tell as much as all of them

std::vector<Eigen::Vector2d> Sample(std::vector<Eigen::Vector2d> points) {
  const std::size_t stride = points.size() / kEnough + 1;
  std::vector<Eigen::Vector2d> some;
  for (std::size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
  return some;
}

/// Both grids once, for many transformations.
class Comparison {
 public:
  Comparison(const OccupancyGrid& map, const OccupancyGrid& slice, double tolerance)
      : map_points_(Sample(Occupied(map))),
        world_points_(Sample(Occupied(slice))),
        grown_map_(map, tolerance),
        grown_world_(slice, tolerance) {}

  bool is_map_empty() const { return map_points_.empty(); }

  MapFit Fit(const MapToWorld& map_to_world) const {
    MapFit fit;
    fit.explained = Explained(map_to_world);
    fit.found = Found(map_to_world);
    const double sum = fit.explained + fit.found;
    fit.score = sum > 0.0 ? 2.0 * fit.explained * fit.found / sum : 0.0;
    return fit;
  }

 private:
  double Explained(const MapToWorld& map_to_world) const {
    const auto is_explained = [&](const Eigen::Vector2d& p_M) {
      return grown_world_.IsNear(map_to_world.ToWorld(p_M));
    };
    const auto count = std::count_if(map_points_.begin(), map_points_.end(), is_explained);
    return map_points_.empty() ? 0.0 : static_cast<double>(count) / map_points_.size();
  }

  double Found(const MapToWorld& map_to_world) const {
    std::size_t found = 0, looked_at = 0;
    for (const Eigen::Vector2d& p_W : world_points_) {
      const Eigen::Vector2d p_M = map_to_world.ToMap(Pose2{p_W.x(), p_W.y(), 0.0}).position();
      const bool is_near = grown_map_.IsNear(p_M);
      if (!is_near && !grown_map_.IsKnown(p_M)) continue;
      ++looked_at;
      if (is_near) ++found;
    }
    return looked_at == 0 ? 0.0 : static_cast<double>(found) / looked_at;
  }

  std::vector<Eigen::Vector2d> map_points_, world_points_;
  Grown grown_map_, grown_world_;
};

/// The map shifted and turned in the world, about the middle of its obstacles, so that turning
/// alone does not carry them away.
MapToWorld Moved(const MapToWorld& from, const Eigen::Vector2d& middle_W, double dx, double dy,
                 double turn) {
  const Pose2 X_WC{middle_W.x() + dx, middle_W.y() + dy, turn};
  MapToWorld moved = from;
  moved.X_WM = X_WC * Pose2{-middle_W.x(), -middle_W.y(), 0.0} * from.X_WM;
  return moved;
}

Eigen::Vector2d MiddleOf(const OccupancyGrid& map, const MapToWorld& map_to_world) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const auto points = Occupied(map);
  for (const Eigen::Vector2d& p_M : points) sum += map_to_world.ToWorld(p_M);
  return sum / std::max<double>(1.0, static_cast<double>(points.size()));
}

/// Tries a lattice of shifts and turns around `from`, `steps` and `turns` to both sides.
MapToWorld BestAround(const Comparison& comparison, const Eigen::Vector2d& middle_W,
                      const MapToWorld& from, int steps, double step, int turns, double turn_step) {
  MapToWorld best = from;
  double score = comparison.Fit(from).score;
  for (int t = -turns; t <= turns; ++t) {
    for (int y = -steps; y <= steps; ++y) {
      for (int x = -steps; x <= steps; ++x) {
        const auto tried = Moved(from, middle_W, x * step, y * step, t * turn_step);
        const double its = comparison.Fit(tried).score;
        if (its <= score) continue;
        score = its;
        best = tried;
      }
    }
  }
  return best;
}

constexpr double kTurnStep = 0.05;  // [rad]
constexpr int kFiner = 5;           // times, in the second round

/// Coarse steps that the tolerance forgives; then finer ones, which only a cell more is forgiven.
MapToWorld Search(const OccupancyGrid& map, const OccupancyGrid& slice, const Comparison& coarse,
                  const MapToWorld& from, const MapFitParams& params) {
  const Eigen::Vector2d middle_W = MiddleOf(map, from);
  const auto count = [](double range, double step) {
    return static_cast<int>(std::lround(range / step));
  };
  const MapToWorld near =
      BestAround(coarse, middle_W, from, count(params.search_distance, params.tolerance),
                 params.tolerance, count(params.search_angle, kTurnStep), kTurnStep);
  const Comparison fine(map, slice, std::max(map.resolution, slice.resolution));
  return BestAround(fine, middle_W, near, kFiner, params.tolerance / kFiner, kFiner,
                    kTurnStep / kFiner);
}

std::string TextOf(const MapToWorld& m) {
  return fmt::format("{:.2f} {:.2f} {:.3f} {:g}", m.X_WM.x, m.X_WM.y, m.X_WM.yaw, m.scale);
}

std::string Advice(const MapToWorld& given, const MapToWorld& better, double score,
                   const MapFitParams& params) {
  if (score < params.min_score) {
    return fmt::format(
        "; nothing within {:g} m and {:g} rad is better than {:.2f}: is it the world of this "
        "laboratory?",
        params.search_distance, params.search_angle, score);
  }
  const Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  return fmt::format(
      "; it is off by {:.2f} m and {:.3f} rad: with '{}' they would agree with {:.2f}",
      (better.ToWorld(origin) - given.ToWorld(origin)).norm(),
      std::abs(geometry::WrapToPi(better.X_WM.yaw - given.X_WM.yaw)), TextOf(better), score);
}

}  // namespace

MapFit FitMap(const OccupancyGrid& map, const OccupancyGrid& slice, const MapToWorld& map_to_world,
              double tolerance) {
  return Comparison(map, slice, tolerance).Fit(map_to_world);
}

MapFit RequireMapFits(const OccupancyGrid& map, const OccupancyGrid& slice,
                      const MapToWorld& map_to_world, const MapFitParams& params) {
  HIRES_CHECK(params.tolerance > 0.0, "a tolerance is a distance");
  const Comparison comparison(map, slice, params.tolerance);
  if (comparison.is_map_empty()) {
    throw base::ConfigError(
        "the robot's map has no obstacle at all; is it the map that the robot drives by?");
  }
  const MapFit fit = comparison.Fit(map_to_world);
  const MapToWorld better = Search(map, slice, comparison, map_to_world, params);
  const MapFit better_fit = comparison.Fit(better);
  const bool is_best = better_fit.score < fit.score + params.worth_saying;
  if (fit.score >= params.min_score && is_best) return fit;
  std::string why = fmt::format(
      "map_to_world '{}': map and world agree with {:.2f} ({:.0f} % of the map's obstacles stand "
      "in "
      "the world, {:.0f} % of the world's in the map)",
      TextOf(map_to_world), fit.score, 100.0 * fit.explained, 100.0 * fit.found);
  if (fit.score < params.min_score) why += fmt::format(", wanted {:.2f} or more", params.min_score);
  throw base::ConfigError(why + Advice(map_to_world, better, better_fit.score, params));
}

}  // namespace hires::world
