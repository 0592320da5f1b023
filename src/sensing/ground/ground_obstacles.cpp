#include "sensing/ground/ground_obstacles.h"

#include <cmath>
#include <utility>

#include "sensing/unmapped.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Points of one cell of the grid.
struct Cell {
  int count{0};
  Vector2d sum_M{0.0, 0.0};  // [m]
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
  reading.obstacles_M =
      Squares(Marks(points_B, X_BC.translation, reading.floor, robot_height), X_MB);
  return reading;
}

/// Points that stand out, and where beams go through the floor.
std::vector<Vector3d> GroundObstacles::Marks(const std::vector<Vector3d>& points_B,
                                             const Vector3d& p_BC, const FloorPlane& floor,
                                             double robot_height) const {
  const double eye = floor.HeightOf(p_BC);
  std::vector<Vector3d> marks_B;
  for (const Vector3d& p_B : points_B) {
    const double height = floor.HeightOf(p_B);
    if (height >= params_.min_height && height <= robot_height) marks_B.push_back(p_B);
    if (height <= -params_.min_depth && eye > 0.0) {
      marks_B.emplace_back(p_BC + eye / (eye - height) * (p_B - p_BC));
    }
  }
  return marks_B;
}

std::vector<geometry::Polygon> GroundObstacles::Squares(const std::vector<Vector3d>& marks_B,
                                                        const geometry::Pose2& X_MB) const {
  const auto cell_of = [&](double x) { return static_cast<long>(std::floor(x / scan_.cell)); };
  // A window of the grid about the robot, so that each point costs the same.
  const long first_column = cell_of(X_MB.x - scan_.range),
             first_row = cell_of(X_MB.y - scan_.range);
  const long size = cell_of(2.0 * scan_.range) + 3;
  std::vector<Cell> cells(static_cast<std::size_t>(size * size));
  for (const Vector3d& mark_B : marks_B) {
    if (geometry::Contains(footprint_, mark_B.head<2>())) continue;
    const Vector2d mark_M = X_MB * Vector2d(mark_B.head<2>());
    const long column = cell_of(mark_M.x()) - first_column, row = cell_of(mark_M.y()) - first_row;
    if (column < 0 || row < 0 || column >= size || row >= size) continue;
    Cell& cell = cells[row * size + column];
    ++cell.count;
    cell.sum_M += mark_M;
  }
  std::vector<geometry::Polygon> squares;
  for (long column = 0; column < size; ++column) {
    for (long row = 0; row < size; ++row) {
      const Cell& cell = cells[row * size + column];
      if (cell.count == 0 || cell.count < params_.min_points ||
          IsExplained(*map_, cell.sum_M / cell.count, scan_.tolerance)) {
        continue;
      }
      squares.push_back(SquareOf(first_column + column, first_row + row, scan_.cell));
    }
  }
  return squares;
}

}  // namespace hires::sensing
