#include "skills/driving/cell_room.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace hires::skills {
namespace {

using navigation::Costmap;

constexpr double kExact = 0.001;  // [m]

/// [m] Across a heading.
double WidthAcross(const geometry::Polygon& footprint, double heading) {
  return WidthOf(geometry::Transformed({0.0, 0.0, -heading}, footprint));
}

}  // namespace

double WidthOf(const geometry::Polygon& footprint) {
  const auto [lowest, highest] =
      std::minmax_element(footprint.begin(), footprint.end(),
                          [](const auto& a, const auto& b) { return a.y() < b.y(); });
  return highest->y() - lowest->y();
}

double NarrowestWidth(const geometry::Polygon& footprint) {
  double narrowest = WidthOf(footprint);
  for (double off = kHeadingStep; off <= kDrivenHeading; off += kHeadingStep)
    narrowest = std::min({narrowest, WidthAcross(footprint, off), WidthAcross(footprint, -off)});
  return narrowest;
}

bool IsSolid(const Costmap& costmap, int column, int row) {
  return costmap.cost(column, row) >= navigation::kLethalCost;
}
bool IsTaken(const Costmap& costmap, int column, int row) {
  return IsSolid(costmap, column, row) || costmap.HasObstacle(column, row);
}

geometry::Polygon CellAt(const Costmap& costmap, const Eigen::Vector2d& cell_M) {
  const double half = 0.5 * costmap.resolution();
  return {cell_M + Eigen::Vector2d(-half, -half), cell_M + Eigen::Vector2d(half, -half),
          cell_M + Eigen::Vector2d(half, half), cell_M + Eigen::Vector2d(-half, half)};
}

std::optional<TakenCell> NearestTakenTo(const Costmap& costmap, const geometry::Polygon& outline_M,
                                        double most) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p_M : outline_M) box.extend(p_M);
  int left = 0, lower = 0, right = 0, upper = 0;
  costmap.CellOf(box.min() - Eigen::Vector2d::Constant(most), &left, &lower);
  costmap.CellOf(box.max() + Eigen::Vector2d::Constant(most), &right, &upper);
  std::optional<TakenCell> nearest;
  for (int row = lower; row <= upper; ++row) {
    for (int column = left; column <= right; ++column) {
      if (!costmap.Inside(column, row) || !IsTaken(costmap, column, row)) continue;
      const Eigen::Vector2d middle = costmap.CentreOf(column, row);
      const double distance = geometry::Distance(outline_M, CellAt(costmap, middle));
      if (distance > most || (nearest && distance >= nearest->distance)) continue;
      nearest = {middle, distance};
    }
  }
  return nearest;
}

bool IsObstacle(const Costmap& costmap, const Eigen::Vector2d& p_M) {
  int column = 0, row = 0;
  costmap.CellOf(p_M, &column, &row);
  return !costmap.Inside(column, row) || IsSolid(costmap, column, row);
}

double FreeTowards(const Costmap& costmap, const Eigen::Vector2d& p_M,
                   const Eigen::Vector2d& along) {
  const double step = costmap.resolution() / kPlaceSteps;
  double free = 0.0;
  while (free < kFarthestSide && !IsObstacle(costmap, p_M + (free + step) * along)) free += step;
  if (free >= kFarthestSide) return free;
  double taken = free + step;
  while (taken - free > kExact) {
    const double middle = 0.5 * (free + taken);
    (IsObstacle(costmap, p_M + middle * along) ? taken : free) = middle;
  }
  return free;
}

}  // namespace hires::skills
