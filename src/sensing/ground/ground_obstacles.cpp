#include "sensing/ground/ground_obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sensing/unmapped.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Points of one cell of the grid.
struct Cell {
  int num_marks{0}, num_floor{0};
  Vector2d sum_M{0.0, 0.0};  // [m] of marks
  double lowest{0.0}, highest{0.0};
};

}  // namespace

GroundObstacles::GroundObstacles(std::shared_ptr<const navigation::Costmap> map,
                                 geometry::Polygon footprint, const ScanParams& scan,
                                 const GroundParams& params)
    : map_(std::move(map)), footprint_(std::move(footprint)), scan_(scan), params_(params) {}

GroundReading GroundObstacles::Find(const perception::PointCloud& cloud,
                                    const geometry::Pose3& X_BC, const geometry::Pose2& X_MB,
                                    double robot_height, base::Rng* rng) const {
  const Eigen::Matrix3d R_BC = X_BC.rotation.toRotationMatrix();
  std::vector<Vector3d> points_B;
  points_B.reserve(cloud.points.size());
  for (const Eigen::Vector3f& p_C : cloud.points) {
    const Vector3d p_B = R_BC * p_C.cast<double>() + X_BC.translation;
    if (p_B.head<2>().squaredNorm() <= scan_.range * scan_.range && p_B.allFinite()) {
      points_B.push_back(p_B);
    }
  }
  GroundReading reading;
  reading.floor = FindFloor(points_B, params_.floor, rng);
  const Vector2d eye_M = X_MB * Vector2d(X_BC.translation.head<2>());
  reading.eye_M = {eye_M.x(), eye_M.y(), reading.floor.HeightOf(X_BC.translation)};
  Count(Sorted(points_B, X_BC.translation, reading.floor, robot_height), X_MB, &reading);
  return reading;
}

/// Points that stand out, where beams go through the floor, and the floor itself.
GroundObstacles::Points GroundObstacles::Sorted(const std::vector<Vector3d>& points_B,
                                                const Vector3d& p_BC, const FloorPlane& floor,
                                                double robot_height) const {
  const double eye = floor.HeightOf(p_BC);
  Points sorted;
  for (const Vector3d& p_B : points_B) {
    const double height = floor.HeightOf(p_B);
    if (height >= params_.min_height && height <= robot_height) {
      sorted.marks_B.emplace_back(p_B.x(), p_B.y(), height);
    } else if (height <= -params_.min_depth && eye > 0.0) {
      const Vector3d through_B = p_BC + eye / (eye - height) * (p_B - p_BC);
      sorted.marks_B.emplace_back(through_B.x(), through_B.y(), height);
    } else if (height < params_.min_height && height > -params_.min_depth) {
      sorted.floor_B.emplace_back(p_B.head<2>());
    }
  }
  return sorted;
}

void GroundObstacles::Count(const Points& points, const geometry::Pose2& X_MB,
                            GroundReading* reading) const {
  const auto cell_of = [&](double x) { return static_cast<long>(std::floor(x / scan_.cell)); };
  // A window of the grid about the robot, so that each point costs the same.
  const long first_column = cell_of(X_MB.x - scan_.range),
             first_row = cell_of(X_MB.y - scan_.range);
  const long size = cell_of(2.0 * scan_.range) + 3;
  std::vector<Cell> cells(static_cast<std::size_t>(size * size));
  const auto at = [&](const Vector2d& p_M) -> Cell* {
    const long column = cell_of(p_M.x()) - first_column, row = cell_of(p_M.y()) - first_row;
    if (column < 0 || row < 0 || column >= size || row >= size) return nullptr;
    return &cells[column * size + row];
  };
  for (const Vector3d& mark_B : points.marks_B) {
    if (geometry::Contains(footprint_, mark_B.head<2>())) continue;
    const Vector2d mark_M = X_MB * Vector2d(mark_B.head<2>());
    Cell* cell = at(mark_M);
    if (cell == nullptr) continue;
    const bool is_first = cell->num_marks++ == 0;
    cell->sum_M += mark_M;
    cell->lowest = is_first ? mark_B.z() : std::min(cell->lowest, mark_B.z());
    cell->highest = is_first ? mark_B.z() : std::max(cell->highest, mark_B.z());
  }
  for (const Vector2d& p_B : points.floor_B) {
    if (Cell* cell = at(X_MB * p_B)) ++cell->num_floor;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    const GroundCell key{first_column + static_cast<long>(i) / size,
                         first_row + static_cast<long>(i) % size};
    if (cell.num_marks == 0 && cell.num_floor > 0) reading->clear.push_back(key);
    if (cell.num_marks == 0 || cell.num_marks < params_.min_points) continue;
    const Vector2d middle_M = cell.sum_M / cell.num_marks;
    if (IsExplained(*map_, middle_M, scan_.tolerance)) continue;
    reading->spots.push_back({key, middle_M, cell.lowest, cell.highest});
  }
}

}  // namespace hires::sensing
