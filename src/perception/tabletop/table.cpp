#include "hires/perception/table.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/perception/depth_sensor.h"

namespace hires::perception {
namespace {

constexpr int kVoters = 6000;  // points that judge a sample; all of them refine the best one
constexpr int kRefinements = 3;
constexpr double kOutlineCell = 0.02;  // [m]
constexpr int kMostCells = 2000;       // along each axis; larger tables have larger cells
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

/// Where the floor is known, only what is as high as tables are (the pass-through filter of the
/// dissertation, section 4.4). Heights of planes would not do: one that leans is as high as a table
/// below the camera, and lies on the floor where its points are.
std::vector<Eigen::Vector3d> AtTableHeight(const std::vector<Eigen::Vector3d>& points,
                                           const std::optional<CameraStand>& stand,
                                           const TableParams& params) {
  if (!stand) return points;
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& p : points) {
    const double height = stand->height + stand->up_C.dot(p);
    if (height >= params.min_height && height <= params.max_height) kept.push_back(p);
  }
  return kept;
}

bool IsLevel(const Plane& plane, const std::optional<CameraStand>& stand,
             const TableParams& params) {
  return !stand || plane.normal.dot(stand->up_C) >= std::cos(params.max_inclination);
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
    if (!plane || !IsLevel(*plane, stand, params)) continue;
    int votes = 0;
    for (std::size_t k = 0; k < points.size(); k += step)
      votes += Supports(*plane, points[k], params.tolerance);
    if (votes <= best_votes) continue;
    best_votes = votes;
    best = plane;
  }
  return best;
}

/// Points of a plane in square cells, and which of the cells hang together.
class Pieces {
 public:
  explicit Pieces(const std::vector<Eigen::Vector2d>& points);
  /// Whether a point is in a piece that is not small, and may be a corner of the hull: those of a
  /// cell between four others, one at each of its corners, cannot.
  bool IsAtBorder(std::size_t point) const;

 private:
  void Spread(int first, int piece);

  int columns_, rows_;              // with an empty cell at each border
  std::vector<int> cell_;           // of each point
  std::vector<int> count_, piece_;  // of each cell; piece 0: no point is there
  std::vector<int> sizes_{0};       // points of each piece
  int largest_{0};                  // of them
};

Pieces::Pieces(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Array2d lower = points.front(), upper = lower;
  for (const Eigen::Vector2d& p : points) {
    lower = lower.min(p.array());
    upper = upper.max(p.array());
  }
  const double edge = std::max(kOutlineCell, (upper - lower).maxCoeff() / kMostCells);
  columns_ = static_cast<int>((upper - lower).x() / edge) + 3;
  rows_ = static_cast<int>((upper - lower).y() / edge) + 3;
  count_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  piece_ = count_;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Array2i cell = ((p.array() - lower) / edge).cast<int>() + 1;
    cell_.push_back(cell.y() * columns_ + cell.x());
    ++count_[cell_.back()];
  }
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (count_[i] == 0 || piece_[i] != 0) continue;
    sizes_.push_back(0);
    Spread(static_cast<int>(i), static_cast<int>(sizes_.size()) - 1);
  }
  largest_ = *std::max_element(sizes_.begin(), sizes_.end());
}

void Pieces::Spread(int first, int piece) {
  std::vector<int> open{first};
  while (!open.empty()) {
    const int cell = open.back();
    open.pop_back();
    if (count_[cell] == 0 || piece_[cell] != 0) continue;
    piece_[cell] = piece;
    sizes_[piece] += count_[cell];
    for (int k = 0; k < 9; ++k) open.push_back(cell + (k / 3 - 1) * columns_ + k % 3 - 1);
  }
}

bool Pieces::IsAtBorder(std::size_t point) const {
  const int cell = cell_[point];
  const auto is_kept = [&](int c) { return sizes_[piece_[c]] > kMinPiece * largest_; };
  return is_kept(cell) && !(is_kept(cell - columns_ - 1) && is_kept(cell - columns_ + 1) &&
                            is_kept(cell + columns_ - 1) && is_kept(cell + columns_ + 1));
}

// Around all pieces of the plane that are not small: things hide what is between them, while other
// furniture beside the table crosses the plane in small ones.
geometry::Polygon OutlineOf(const std::vector<Eigen::Vector2d>& points) {
  const Pieces pieces(points);
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (pieces.IsAtBorder(i)) kept.push_back(points[i]);
  return geometry::ConvexHull(std::move(kept));
}

}  // namespace

std::optional<Table> FindTable(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                               const TableParams& params, base::Rng rng) {
  const std::vector<Eigen::Vector3d> measured = MeasuredPoints(cloud);
  const std::vector<Eigen::Vector3d> points = AtTableHeight(measured, stand, params);
  if (points.size() < 3) return std::nullopt;
  const auto best = BestSample(points, stand, params, &rng);
  if (!best) return std::nullopt;
  Plane plane = *best;
  for (int i = 0; i < kRefinements; ++i) plane = LeastSquares(points, plane, params.tolerance);
  if (!IsLevel(plane, stand, params)) return std::nullopt;
  Table table;
  table.normal = plane.normal;
  table.offset = plane.offset;
  table.along_x = plane.normal.unitOrthogonal();
  table.along_y = table.normal.cross(table.along_x);
  std::vector<Eigen::Vector2d> on_it;
  for (const Eigen::Vector3d& p : points)
    if (Supports(plane, p, params.tolerance)) on_it.push_back(table.FromAbove(p));
  if (on_it.size() < 3 || on_it.size() < params.min_share * measured.size()) return std::nullopt;
  table.outline = OutlineOf(on_it);
  return table;
}

}  // namespace hires::perception
