#include "perception/tabletop/table.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "hires/perception/depth_sensor.h"

namespace hires::perception {
namespace {

constexpr int kVoters = 6000;  // points that judge a sample; all of them refine the best one
constexpr int kRefinements = 3;
constexpr double kOutlineCell = 0.02;  // [m]
constexpr double kMinPiece = 0.1;      // of the largest piece

struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

bool Supports(const Plane& plane, const Eigen::Vector3d& p, double tolerance) {
  return std::abs(plane.normal.dot(p) + plane.offset) < tolerance * DepthNoise(p.z());
}

std::vector<Eigen::Vector3d> MeasuredPoints(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& point : cloud.points)
    if (IsMeasured(point)) points.push_back(point.cast<double>());
  return points;
}

// With the camera, at the origin, above it.
std::optional<Plane> PlaneThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (normal.norm() < 1e-6) return std::nullopt;
  Plane plane{normal.normalized(), -normal.normalized().dot(a)};
  if (plane.offset < 0.0) plane = {-plane.normal, -plane.offset};
  return plane;
}

bool MayBeTable(const Plane& plane, const std::optional<CameraStand>& stand,
                const TableParams& params) {
  if (!stand) return true;
  const double height = stand->height - plane.offset;
  return plane.normal.dot(stand->up_C) >= std::cos(params.max_inclination) &&
         height >= params.min_height && height <= params.max_height;
}

Plane LeastSquares(const std::vector<Eigen::Vector3d>& points, const Plane& plane,
                   double tolerance) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const Eigen::Vector3d& p : points) {
    if (!Supports(plane, p, tolerance)) continue;
    mean += p;
    moments += p * p.transpose();
    n += 1.0;
  }
  if (n < 3.0) return plane;
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / n -
                                                              mean * mean.transpose());
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.dot(mean) < 0.0 ? Plane{normal, -normal.dot(mean)}
                                : Plane{-normal, normal.dot(mean)};
}

std::optional<Plane> BestSample(const std::vector<Eigen::Vector3d>& points,
                                const std::optional<CameraStand>& stand, const TableParams& params,
                                base::Rng* rng) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kVoters);
  std::optional<Plane> best;
  int best_votes = 0;
  for (int i = 0; i < params.num_samples; ++i) {
    const auto pick = [&] { return points[rng->Index(static_cast<int>(points.size()))]; };
    const Eigen::Vector3d a = pick(), b = pick(), c = pick();
    const auto plane = PlaneThrough(a, b, c);
    if (!plane || !MayBeTable(*plane, stand, params)) continue;
    int votes = 0;
    for (std::size_t k = 0; k < points.size(); k += step)
      votes += Supports(*plane, points[k], params.tolerance);
    if (votes <= best_votes) continue;
    best_votes = votes;
    best = plane;
  }
  return best;
}

using Grid = std::map<std::pair<int, int>, std::vector<Eigen::Vector2d>>;

// What hangs together in the grid with its first cell; taken out of it.
std::vector<Eigen::Vector2d> TakeConnected(Grid* grid) {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::pair<int, int>> open{grid->begin()->first};
  while (!open.empty()) {
    const auto cell = open.back();
    open.pop_back();
    const auto it = grid->find(cell);
    if (it == grid->end()) continue;
    points.insert(points.end(), it->second.begin(), it->second.end());
    grid->erase(it);
    for (int k = 0; k < 9; ++k) open.emplace_back(cell.first + k % 3 - 1, cell.second + k / 3 - 1);
  }
  return points;
}

// Around all pieces of the plane that are not small: things hide what is between them, while other
// furniture beside the table crosses the plane in small ones.
geometry::Polygon OutlineOf(const std::vector<Eigen::Vector2d>& points) {
  Grid grid;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2i cell = (p / kOutlineCell).array().floor().cast<int>();
    grid[{cell.x(), cell.y()}].push_back(p);
  }
  std::vector<std::vector<Eigen::Vector2d>> pieces;
  std::size_t largest = 0;
  while (!grid.empty()) {
    pieces.push_back(TakeConnected(&grid));
    largest = std::max(largest, pieces.back().size());
  }
  std::vector<Eigen::Vector2d> kept;
  for (const auto& piece : pieces)
    if (piece.size() > kMinPiece * largest) kept.insert(kept.end(), piece.begin(), piece.end());
  return geometry::ConvexHull(std::move(kept));
}

}  // namespace

std::optional<Table> FindTable(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                               const TableParams& params, base::Rng rng) {
  const std::vector<Eigen::Vector3d> points = MeasuredPoints(cloud);
  if (points.size() < 3) return std::nullopt;
  const auto best = BestSample(points, stand, params, &rng);
  if (!best) return std::nullopt;
  Plane plane = *best;
  for (int i = 0; i < kRefinements; ++i) plane = LeastSquares(points, plane, params.tolerance);
  Table table;
  table.normal = plane.normal;
  table.offset = plane.offset;
  table.along_x = plane.normal.unitOrthogonal();
  table.along_y = table.normal.cross(table.along_x);
  std::vector<Eigen::Vector2d> on_it;
  for (const Eigen::Vector3d& p : points)
    if (Supports(plane, p, params.tolerance)) on_it.push_back(table.FromAbove(p));
  if (on_it.size() < 3 || on_it.size() < params.min_share * points.size()) return std::nullopt;
  table.outline = OutlineOf(on_it);
  return table;
}

}  // namespace hires::perception
