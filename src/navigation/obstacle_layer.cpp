#include "hires/navigation/obstacle_layer.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::navigation {

using Eigen::Vector2d;
using geometry::Pose2;

ObstacleLayer::ObstacleLayer(const ObstacleLayerParams& params, double resolution)
    : params_(params), resolution_(resolution), edge_(1) {
  HIRES_CHECK(resolution > 0.0 && params.obstacle_range > 0.0 && params.raytrace_range > 0.0 &&
                  params.keep >= 0.0,
              "an obstacle layer has cells and ranges");
  const double reach = std::max(params.obstacle_range, params.raytrace_range);
  // Twice: the laser need not sit at the robot's centre, and cells that the robot left stay a
  // while.
  while (edge_ * resolution < 2.0 * (reach + 1.0)) edge_ *= 2;
  cells_.resize(static_cast<std::size_t>(edge_) * edge_);
}

/// All cells that a line passes, the last one left out [Amanatides, Woo 1987, "A fast voxel
/// traversal algorithm for ray tracing", Eurographics].
void ObstacleLayer::Clear(const Vector2d& from_O, const Vector2d& to_O, double time) {
  std::int32_t at[2], step[2];
  double next[2], per_cell[2];  // shares of the way: to the next border, from border to border
  int num_cells = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to_O[axis] - from_O[axis];
    at[axis] = CellAt(from_O[axis]);
    num_cells += std::abs(CellAt(to_O[axis]) - at[axis]);
    step[axis] = way < 0.0 ? -1 : 1;
    per_cell[axis] = way == 0.0 ? HUGE_VAL : resolution_ / std::abs(way);
    const double border = (at[axis] + (way < 0.0 ? 0 : 1)) * resolution_;
    next[axis] = way == 0.0 ? HUGE_VAL : (border - from_O[axis]) / way;
  }
  for (int i = 0; i < num_cells; ++i) {
    Set(at[0], at[1], State::kFree, time);
    const int axis = next[0] <= next[1] ? 0 : 1;
    at[axis] += step[axis];
    next[axis] += per_cell[axis];
  }
}

void ObstacleLayer::Insert(double time, const robot::ScanReading& scan, const Pose2& X_OB,
                           const Pose2& X_BL, const geometry::Polygon& footprint) {
  const Pose2 X_OL = X_OB * X_BL;
  std::vector<Vector2d> echoes_O;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    // Infinite: nothing within range, which is a measurement, too (REP 117).
    if (std::isnan(range) || range < scan.range_min || range <= 0.0) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    const bool has_echo = std::isfinite(range) && (scan.range_max <= 0.0 || range < scan.range_max);
    const double cleared = std::min(range, params_.raytrace_range);
    Clear(X_OL.position(), X_OL * Vector2d(cleared * direction), time);
    if (!has_echo || range > params_.obstacle_range) continue;
    const Vector2d echo_L = range * direction;
    if (!geometry::Contains(footprint, X_BL * echo_L)) echoes_O.push_back(X_OL * echo_L);
  }
  for (const Vector2d& echo : echoes_O)
    Set(CellAt(echo.x()), CellAt(echo.y()), State::kObstacle, time);
}

ObstacleLayer::State ObstacleLayer::At(const Vector2d& point_O, double time) const {
  const std::int32_t column = CellAt(point_O.x()), row = CellAt(point_O.y());
  const Cell& cell = cells_[Slot(column, row)];
  const bool is_it = cell.column == column && cell.row == row;
  return is_it && time - cell.time <= params_.keep ? cell.state : State::kUnseen;
}

std::vector<Vector2d> ObstacleLayer::Marks(const Pose2& X_OB, double time) const {
  std::vector<Vector2d> centres;
  for (const Cell& cell : cells_) {
    if (cell.state != State::kObstacle || time - cell.time > params_.keep) continue;
    const Vector2d centre = resolution_ * Vector2d(cell.column + 0.5, cell.row + 0.5);
    if ((centre - X_OB.position()).norm() <= params_.raytrace_range) centres.push_back(centre);
  }
  return centres;
}

}  // namespace hires::navigation
