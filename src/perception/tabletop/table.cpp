#include "hires/perception/table.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/averages.h"
#include "hires/perception/depth_sensor.h"
#include "perception/patches/ransac_plane.h"

namespace hires::perception {
namespace {

constexpr int kVoters = 6000;  // points that choose a plane; all of them refine it
constexpr int kRefinements = 3;
constexpr int kMostSamples = 10;       // times num_samples, while no plane holds enough points
constexpr double kOutlineCell = 0.02;  // [m]
constexpr int kMostCells = 2000;       // along each axis; larger tables have larger cells
constexpr double kMinPiece = 0.1;      // of the largest piece
constexpr int kMinOver = 3;   // times as many points in a cell's plane as below it: a table
                              // hides what is below it, a wall goes on there
constexpr int kMinUnder = 2;  // likewise as above it: a wall goes on there, and so does a thing,
                              // whose cells a table can do without
constexpr double kPlateReach = 0.03;  // [m] by which a plate's place may err upwards or downwards
constexpr double kPlateTilt = 0.05;   // [rad] by which it may lean otherwise
constexpr std::size_t kPlatePoints = 200, kTablePoints = 200;  // fewer are none
constexpr double kBeside = 3.0;  // tolerances up to which points are beside a plane
// Who does not know how his camera stands holds it upright: level planes then look up in the
// picture, and walls do not, unless he looks straight down.
constexpr double kMostUpright = 1.37;     // [rad] of a normal against the picture's up
constexpr double kFromAbove = 0.3;        // [rad] against the way to the camera
constexpr double kFarthestBelow = 2.5;    // [m] from the camera then; farther away are walls
constexpr double kLeastOverFloor = 0.45;  // [m] of a table over a floor
constexpr double kParallel = 0.1;         // [rad] between the two

struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

struct Point {
  Eigen::Vector3d p;
  double tolerance;  // [m] by which it may be off a plane that it is on
};

bool Supports(const Plane& plane, const Point& point) {
  return std::abs(plane.normal.dot(point.p) + plane.offset) < point.tolerance;
}

/// -1, 1 where it lies so little below or above the plane that a wall which crosses it there has as
/// many points on it, else 0.
int SideOf(const Plane& plane, const Point& point) {
  const double height = (plane.normal.dot(point.p) + plane.offset) / point.tolerance;
  if (std::abs(height) < 1.0 || std::abs(height) >= kBeside) return 0;
  return height < 0.0 ? -1 : 1;
}

/// Where the floor is known, only what is as high as tables are (the pass-through filter of the
/// dissertation, section 4.4). Heights of planes would not do: one that leans is as high as a table
/// below the camera, and lies on the floor where its points are.
bool IsAtTableHeight(const Eigen::Vector3d& p, const std::optional<CameraStand>& stand,
                     const TableParams& params) {
  if (!stand) return true;
  const double height = stand->height + stand->up_C.dot(p);
  return height >= params.min_height && height <= params.max_height;
}

struct Candidates {
  std::vector<Point> points{};
  std::size_t num_measured{0};  // the others are not as high as tables are
};

Candidates CandidatesOf(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                        const TableParams& params) {
  Candidates out;
  out.points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& point : cloud.points) {
    if (!IsMeasured(point)) continue;
    ++out.num_measured;
    const Eigen::Vector3d p = point.cast<double>();
    if (IsAtTableHeight(p, stand, params))
      out.points.push_back({p, params.tolerance * DepthNoise(p.z())});
  }
  return out;
}

/// Which planes may be a table's.
struct Level {
  Eigen::Vector3d up_C;    // of length 1
  double max_inclination;  // [rad] of its normal against that
};

bool IsLevel(const Plane& plane, const Level& level) {
  return plane.normal.dot(level.up_C) >= std::cos(level.max_inclination);
}

Plane LeastSquares(const std::vector<Point>& points, const Plane& plane) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const Point& point : points) {
    if (!Supports(plane, point)) continue;
    const Eigen::Vector3d& p = point.p;
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

/// The one that most points are on. Noise is taken as of the middle one's distance.
std::optional<Plane> LargestPlane(const std::vector<Point>& points, const Level& level,
                                  const TableParams& params) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kVoters);
  std::vector<Eigen::Vector3d> voters;
  std::vector<double> tolerances;
  for (std::size_t k = 0; k < points.size(); k += step) {
    voters.push_back(points[k].p);
    tolerances.push_back(points[k].tolerance);
  }
  const auto found = FindPlaneByRansac(
      voters, level.up_C,
      {base::Median(tolerances), level.max_inclination, kMostSamples * params.num_samples});
  if (!found) return std::nullopt;
  return Plane{found->head<3>(), found->w()};
}

/// Points of a plane in square cells, and which of the cells hang together. Cells in which
/// something goes on below the plane, or above it, belong to none: a table that is seen from afar
/// hides the foot of the wall behind it.
class Pieces {
 public:
  Pieces(const std::vector<Eigen::Vector2d>& points, const std::vector<Eigen::Vector2d>& below,
         const std::vector<Eigen::Vector2d>& above);
  /// Whether a point is in a piece that is not small.
  bool IsKept(std::size_t point) const { return IsCellKept(cell_[point]); }
  /// Whether it may be a corner of the hull, too: those of a cell between four others, one at each
  /// of its corners, cannot.
  bool IsAtBorder(std::size_t point) const;

 private:
  bool IsCellKept(int cell) const { return sizes_[piece_[cell]] > kMinPiece * largest_; }
  int CellOf(const Eigen::Vector2d& p) const;  // -1: beside all of them
  void DropSteepCells(const std::vector<Eigen::Vector2d>& beside, int least);
  void Spread(int first, int piece);

  Eigen::Array2d lower_;
  double edge_;                     // [m]
  int columns_, rows_;              // with an empty cell at each border
  std::vector<int> cell_;           // of each point
  std::vector<int> count_, piece_;  // of each cell; piece 0: no point is there
  std::vector<int> sizes_{0};       // points of each piece
  int largest_{0};                  // of them
};

Pieces::Pieces(const std::vector<Eigen::Vector2d>& points,
               const std::vector<Eigen::Vector2d>& below,
               const std::vector<Eigen::Vector2d>& above) {
  lower_ = points.front();
  Eigen::Array2d upper = lower_;
  for (const Eigen::Vector2d& p : points) {
    lower_ = lower_.min(p.array());
    upper = upper.max(p.array());
  }
  edge_ = std::max(kOutlineCell, (upper - lower_).maxCoeff() / kMostCells);
  columns_ = static_cast<int>((upper - lower_).x() / edge_) + 3;
  rows_ = static_cast<int>((upper - lower_).y() / edge_) + 3;
  count_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  piece_ = count_;
  for (const Eigen::Vector2d& p : points) {
    cell_.push_back(CellOf(p));
    ++count_[cell_.back()];
  }
  DropSteepCells(below, kMinOver);
  DropSteepCells(above, kMinUnder);
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (count_[i] == 0 || piece_[i] != 0) continue;
    sizes_.push_back(0);
    Spread(static_cast<int>(i), static_cast<int>(sizes_.size()) - 1);
  }
  largest_ = *std::max_element(sizes_.begin(), sizes_.end());
}

int Pieces::CellOf(const Eigen::Vector2d& p) const {
  const Eigen::Array2d cell = ((p.array() - lower_) / edge_).floor() + 1.0;
  if ((cell < 0.0).any() || cell.x() >= columns_ || cell.y() >= rows_) return -1;
  return static_cast<int>(cell.y()) * columns_ + static_cast<int>(cell.x());
}

/// @param least  times as many points in a cell's plane as beside it.
void Pieces::DropSteepCells(const std::vector<Eigen::Vector2d>& beside, int least) {
  std::vector<int> count_beside(count_.size(), 0);
  for (const Eigen::Vector2d& p : beside)
    if (const int cell = CellOf(p); cell >= 0) ++count_beside[cell];
  for (std::size_t i = 0; i < count_.size(); ++i)
    if (least * count_beside[i] > count_[i]) count_[i] = 0;
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
  return IsCellKept(cell) && !(IsCellKept(cell - columns_ - 1) && IsCellKept(cell - columns_ + 1) &&
                               IsCellKept(cell + columns_ - 1) && IsCellKept(cell + columns_ + 1));
}

/// What of the plane is the table: all pieces of it that are not small, as things hide what is
/// between them, while other furniture beside the table crosses the plane in small ones.
struct TableTop {
  std::vector<Point> points{};
  std::vector<Eigen::Vector3d> border{};
};

TableTop TopOf(const std::vector<Point>& points, const Table& table) {
  const Plane plane{table.normal, table.offset};
  std::vector<Point> on_it;
  std::vector<Eigen::Vector2d> from_above, below, above;
  for (const Point& point : points) {
    if (Supports(plane, point)) {
      on_it.push_back(point);
      from_above.push_back(table.FromAbove(point.p));
    } else if (const int side = SideOf(plane, point); side != 0) {
      (side < 0 ? below : above).push_back(table.FromAbove(point.p));
    }
  }
  TableTop top;
  if (on_it.empty()) return top;
  const Pieces pieces(from_above, below, above);
  for (std::size_t i = 0; i < on_it.size(); ++i) {
    if (!pieces.IsKept(i)) continue;
    top.points.push_back(on_it[i]);
    if (pieces.IsAtBorder(i)) top.border.push_back(on_it[i].p);
  }
  return top;
}

/// Those over the plate's outline, and as high.
std::vector<Point> PointsAbout(const Table& plate, const PointCloud& cloud,
                               const TableParams& params) {
  std::vector<Point> points;
  for (const Eigen::Vector3f& point : cloud.points) {
    if (!IsMeasured(point)) continue;
    const Eigen::Vector3d p = point.cast<double>();
    if (std::abs(plate.HeightOf(p)) > kPlateReach) continue;
    if (!geometry::Contains(plate.outline, plate.FromAbove(p))) continue;
    points.push_back({p, params.tolerance * DepthNoise(p.z())});
  }
  return points;
}

double MedianHeight(const std::vector<Point>& points, const Table& plate) {
  std::vector<double> heights;
  for (const Point& point : points) heights.push_back(plate.HeightOf(point.p));
  return base::Median(std::move(heights));
}

Table TableIn(const Plane& plane) {
  Table table;
  table.normal = plane.normal;
  table.offset = plane.offset;
  table.along_x = plane.normal.unitOrthogonal();
  table.along_y = table.normal.cross(table.along_x);
  return table;
}

/// @param least  points that it must have
std::optional<Table> LargestTable(const std::vector<Point>& points, const Level& level,
                                  double least, const TableParams& params) {
  if (points.size() < kTablePoints) return std::nullopt;
  const auto best = LargestPlane(points, level, params);
  if (!best) return std::nullopt;
  Plane plane = *best;
  for (int i = 0; i < kRefinements; ++i) plane = LeastSquares(points, plane);
  const TableTop top = TopOf(points, TableIn(plane));
  if (top.border.size() < 3 || top.points.size() < least) return std::nullopt;
  plane = LeastSquares(top.points, plane);
  if (!IsLevel(plane, level)) return std::nullopt;
  Table table = TableIn(plane);
  for (const Eigen::Vector3d& p : top.border) table.outline.push_back(table.FromAbove(p));
  table.outline = geometry::ConvexHull(std::move(table.outline));
  return table;
}

/// The same over a floor, so high as tables are and not what stands on them; else the floor.
Table TableOver(const Table& floor, const std::vector<Point>& points, double least,
                const TableParams& params) {
  std::vector<Point> above;
  for (const Point& point : points) {
    const double height = floor.HeightOf(point.p);
    if (height > kLeastOverFloor && height < params.max_height) above.push_back(point);
  }
  return LargestTable(above, {floor.normal, kParallel}, least, params).value_or(floor);
}

}  // namespace

std::optional<Table> FindTable(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                               const TableParams& params) {
  const Candidates candidates = CandidatesOf(cloud, stand, params);
  const std::vector<Point>& points = candidates.points;
  const double least = std::max<double>(kTablePoints, params.min_share * candidates.num_measured);
  if (stand) return LargestTable(points, {stand->up_C, params.max_inclination}, least, params);
  const auto seen_from_aside =
      LargestTable(points, {-Eigen::Vector3d::UnitY(), kMostUpright}, least, params);
  if (seen_from_aside) return TableOver(*seen_from_aside, points, least, params);
  const auto from_above =
      LargestTable(points, {-Eigen::Vector3d::UnitZ(), kFromAbove}, least, params);
  return from_above && from_above->offset < kFarthestBelow ? from_above : std::nullopt;
}

Table PlateIn(const PointCloud& cloud, Table expected, const TableParams& params) {
  const std::vector<Point> points = PointsAbout(expected, cloud, params);
  if (points.size() < kPlatePoints) return expected;
  Plane plane{expected.normal, expected.offset - MedianHeight(points, expected)};
  for (int i = 0; i < kRefinements; ++i) plane = LeastSquares(points, plane);
  const auto num_on_it = static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [&](const Point& point) { return Supports(plane, point); }));
  if (2 * num_on_it < points.size() || plane.normal.dot(expected.normal) < std::cos(kPlateTilt))
    return expected;
  Table plate = TableIn(plane);
  for (const Eigen::Vector2d& corner : expected.outline)
    plate.outline.push_back(plate.FromAbove(expected.Lift(corner)));
  return plate;
}

}  // namespace hires::perception
