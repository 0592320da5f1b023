#include "hires/world/turned_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"

namespace hires::world {
namespace {

constexpr double kHardlyTurned = 1e-6;  // [rad] what tools write for 0
constexpr double kSamePlace = 0.05;     // of a cell's edge
constexpr double kTouching = 1e-6;      // of a cell's edge: cells that only touch do not overlap
constexpr double kMostCells = 1e8;

/// The same cells after whole quarters of a turn about the lower left corner.
OccupancyGrid ByQuarters(const OccupancyGrid& grid, int quarters) {
  if (quarters == 0) return grid;
  OccupancyGrid turned{grid.resolution, grid.width, grid.height, grid.origin, {}, grid.notes};
  if (quarters % 2 == 1) std::swap(turned.width, turned.height);
  if (quarters <= 2) turned.origin.x() -= turned.width * grid.resolution;
  if (quarters >= 2) turned.origin.y() -= turned.height * grid.resolution;
  turned.cells.reserve(grid.cells.size());
  for (int row = 0; row < turned.height; ++row) {
    for (int column = 0; column < turned.width; ++column) {
      const int from_right = turned.width - 1 - column, from_top = turned.height - 1 - row;
      turned.cells.push_back(quarters == 1   ? grid.at(row, from_right)
                             : quarters == 2 ? grid.at(from_right, from_top)
                                             : grid.at(from_top, column));
    }
  }
  return turned;
}

/// Turns cells into those of a grid that is not turned. All lengths are edges of a cell; S is the
/// frame of the picture, T that of the result, both with their origins in the picture's corner.
class Resampling {
 public:
  Resampling(const OccupancyGrid& grid, double yaw)
      : grid_(grid), cos_(std::cos(yaw)), sin_(std::sin(yaw)) {
    for (const double x : {0.0, 1.0 * grid.width}) {
      for (const double y : {0.0, 1.0 * grid.height}) {
        lower_ = lower_.cwiseMin(ToT({x, y}));
        upper_ = upper_.cwiseMax(ToT({x, y}));
      }
    }
  }

  OccupancyGrid Take() {
    const Eigen::Array2d size = ((upper_ - lower_).array() - kTouching).ceil();
    if (!(size.prod() <= kMostCells)) {
      throw base::ConfigError(fmt::format(
          "turned by its origin's yaw it would have {:g} x {:g} cells, at most {:g} are "
          "read; turn the picture, and write a yaw of 0",
          size.x(), size.y(), kMostCells));
    }
    OccupancyGrid turned{grid_.resolution,
                         static_cast<int>(size.x()),
                         static_cast<int>(size.y()),
                         grid_.origin + grid_.resolution * lower_,
                         {},
                         grid_.notes};
    turned.cells.reserve(static_cast<std::size_t>(size.prod()));
    for (int row = 0; row < turned.height; ++row) {
      for (int column = 0; column < turned.width; ++column) {
        turned.cells.push_back(CellAt(lower_ + Eigen::Vector2d(column + 0.5, row + 0.5)));
      }
    }
    for (int row = 0; row < grid_.height; ++row) {
      for (int column = 0; column < grid_.width; ++column) {
        if (grid_.at(column, row) == Cell::kOccupied) Occupy(column, row, &turned);
      }
    }
    return turned;
  }

 private:
  Eigen::Vector2d ToT(const Eigen::Vector2d& p_S) const {
    return {cos_ * p_S.x() - sin_ * p_S.y(), sin_ * p_S.x() + cos_ * p_S.y()};
  }
  Eigen::Vector2d ToS(const Eigen::Vector2d& p_T) const {
    return {cos_ * p_T.x() + sin_ * p_T.y(), -sin_ * p_T.x() + cos_ * p_T.y()};
  }

  Cell CellAt(const Eigen::Vector2d& p_T) const {
    const Eigen::Vector2d p_S = ToS(p_T);
    const int column = static_cast<int>(std::floor(p_S.x())),
              row = static_cast<int>(std::floor(p_S.y()));
    const bool is_inside = column >= 0 && column < grid_.width && row >= 0 && row < grid_.height;
    return is_inside ? grid_.at(column, row) : Cell::kUnknown;
  }

  /// All cells of the result with which this one overlaps: two squares of edge 1 do unless one of
  /// the four directions of their edges parts them.
  void Occupy(int column, int row, OccupancyGrid* turned) const {
    const Eigen::Vector2d middle_T = ToT({column + 0.5, row + 0.5}) - lower_;
    const double reach = (1.0 + std::abs(cos_) + std::abs(sin_)) / 2.0 - kTouching;
    const int right = static_cast<int>(std::floor(middle_T.x() + reach - 0.5)),
              top = static_cast<int>(std::floor(middle_T.y() + reach - 0.5));
    for (int y = std::max(0, static_cast<int>(std::ceil(middle_T.y() - reach - 0.5)));
         y <= std::min(turned->height - 1, top); ++y) {
      for (int x = std::max(0, static_cast<int>(std::ceil(middle_T.x() - reach - 0.5)));
           x <= std::min(turned->width - 1, right); ++x) {
        const Eigen::Vector2d apart_T = Eigen::Vector2d(x + 0.5, y + 0.5) - middle_T;
        if (apart_T.cwiseAbs().maxCoeff() >= reach) continue;
        if (ToS(apart_T).cwiseAbs().maxCoeff() >= reach) continue;
        turned->cells[static_cast<std::size_t>(y) * turned->width + x] = Cell::kOccupied;
      }
    }
  }

  const OccupancyGrid& grid_;
  const double cos_, sin_;
  Eigen::Vector2d lower_{0.0, 0.0}, upper_{0.0, 0.0};
};

}  // namespace

std::optional<int> QuartersOf(double yaw, int width, int height) {
  const double quarters = std::round(yaw / (EIGEN_PI / 2.0));
  const double rest = std::abs(yaw - quarters * (EIGEN_PI / 2.0));
  if (rest > kHardlyTurned && rest * std::hypot(width, height) > kSamePlace) return std::nullopt;
  return (static_cast<int>(std::fmod(quarters, 4.0)) + 4) % 4;
}

OccupancyGrid TurnedGrid(const OccupancyGrid& grid, double yaw) {
  HIRES_CHECK(std::isfinite(yaw), "a yaw is finite");
  if (const auto quarters = QuartersOf(yaw, grid.width, grid.height))
    return ByQuarters(grid, *quarters);
  return Resampling(grid, yaw).Take();
}

}  // namespace hires::world
