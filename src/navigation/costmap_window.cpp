#include "hires/navigation/costmap_window.h"

#include <cmath>

#include "hires/base/check.h"

namespace hires::navigation {
namespace {

/// As costmap_2d's publisher maps costs: what is beyond the inscribed radius shares 1..98 evenly.
std::int8_t OccupancyOf(std::uint8_t cost) {
  switch (cost) {
    case kFreeCost:
      return 0;
    case kInscribedCost:
      return 99;
    case kLethalCost:
      return 100;
    case kUnknownCost:
      return -1;
    default:
      return static_cast<std::int8_t>(1 + 97 * (cost - 1) / (kInscribedCost - 2));
  }
}

}  // namespace

CostmapWindow WindowAround(const Costmap& costmap, const Eigen::Vector2d& point_M,
                           double half_width) {
  HIRES_CHECK(std::isfinite(half_width) && half_width >= 0.0, "a window has an extent");
  const int reach = static_cast<int>(std::floor(half_width / costmap.resolution()));
  int left = 0, lower = 0;
  costmap.CellOf(point_M, &left, &lower);
  left -= reach;
  lower -= reach;
  CostmapWindow window;
  window.resolution = costmap.resolution();
  window.width = 2 * reach + 1;
  window.origin =
      costmap.CentreOf(left, lower) - Eigen::Vector2d::Constant(0.5 * costmap.resolution());
  window.occupancy.reserve(static_cast<std::size_t>(window.width) * window.width);
  for (int row = lower; row < lower + window.width; ++row) {
    for (int column = left; column < left + window.width; ++column) {
      window.occupancy.push_back(
          costmap.Inside(column, row) ? OccupancyOf(costmap.cost(column, row)) : std::int8_t{-1});
    }
  }
  return window;
}

}  // namespace hires::navigation
