#include "hires/perception/table.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/averages.h"
#include "hires/perception/depth_sensor.h"
#include "perception/patches/ransac_plane.h"
#include "perception/tabletop/level_patches.h"
#include "perception/tabletop/table_top.h"

namespace hires::perception {
namespace {

constexpr int kVoters = 6000;  // points that choose a plane; all of them refine it
constexpr int kRefinements = 3;
constexpr int kMostSamples = 10;      // times num_samples, while no plane holds enough points
constexpr double kPlateReach = 0.03;  // [m] by which a plate's place may err upwards or downwards
constexpr double kPlateTilt = 0.05;   // [rad] by which it may lean otherwise
constexpr std::size_t kPlatePoints = 200, kTablePoints = 200;  // fewer are none
constexpr double kUsualScatter = 1.5;  // [DepthNoise] up to which a plane's points are a camera's
constexpr double kWide = 2.0;          // times that, so that few of its points are beside it
constexpr double kLeaning = 0.3;       // [rad] of pieces of a plane against it, by noise
constexpr std::size_t kThingPoints = 100;  // above a plane, of what stands there
constexpr double kHighestThing = 0.6;      // [m] likewise
constexpr double kClearly = 3.0;           // [its scatter] likewise
constexpr double kUneven = 0.003;          // [m] sd by which tables are, at least
// Who does not know how his camera stands holds it upright: level planes then look up in the
// picture, and walls do not, unless he looks straight down.
constexpr double kMostUpright = 1.37;     // [rad] of a normal against the picture's up
constexpr double kFromAbove = 0.3;        // [rad] against the way to the camera
constexpr double kFarthestTable = 2.5;    // [m] from the camera then; farther away are walls
constexpr double kLeastOverFloor = 0.45;  // [m] of a table over a floor
constexpr double kLeastOfSmall = 0.55;    // [m] likewise, of one that holds few of all points:
                                          // seats of chairs are lower
constexpr double kParallel = 0.1;         // [rad] between the two
constexpr double kLongestTable = 2.5;     // [m] from corner to corner; floors are larger

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
  std::vector<TablePoint> points{};
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

bool IsLevel(const TablePlane& plane, const Level& level) {
  return plane.normal.dot(level.up_C) >= std::cos(level.max_inclination);
}

TablePlane LeastSquares(const std::vector<TablePoint>& points, const TablePlane& plane) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const TablePoint& point : points) {
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
  return normal.dot(mean) < 0.0 ? TablePlane{normal, -normal.dot(mean)}
                                : TablePlane{-normal, normal.dot(mean)};
}

/// The one that most points are on. Noise is taken as of the middle one's distance.
std::optional<TablePlane> LargestPlane(const std::vector<TablePoint>& points, const Level& level,
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
  return TablePlane{found->head<3>(), found->w()};
}

/// Those over the plate's outline, and as high.
std::vector<TablePoint> PointsAbout(const Table& plate, const PointCloud& cloud,
                                    const TableParams& params) {
  std::vector<TablePoint> points;
  for (const Eigen::Vector3f& point : cloud.points) {
    if (!IsMeasured(point)) continue;
    const Eigen::Vector3d p = point.cast<double>();
    if (std::abs(plate.HeightOf(p)) > kPlateReach) continue;
    if (!geometry::Contains(plate.outline, plate.FromAbove(p))) continue;
    points.push_back({p, params.tolerance * DepthNoise(p.z())});
  }
  return points;
}

double MedianHeight(const std::vector<TablePoint>& points, const Table& plate) {
  std::vector<double> heights;
  for (const TablePoint& point : points) heights.push_back(plate.HeightOf(point.p));
  return base::Median(std::move(heights));
}

std::vector<LevelPatch> PatchesIn(const std::vector<TablePoint>& points,
                                  const Eigen::Vector3d& up_C) {
  const std::size_t step = points.size() / kVoters + 1;
  std::vector<Eigen::Vector3d> some;
  some.reserve(points.size() / step + 1);
  for (std::size_t k = 0; k < points.size(); k += step) some.push_back(points[k].p);
  return LevelPatchesIn(some, up_C, kLeaning);
}

double ScatterIn(const std::vector<TablePoint>& points, const TablePlane& plane) {
  return ScatterOn(PatchesIn(points, plane.normal), plane.normal, plane.offset);
}

std::vector<TablePoint> WithNoise(std::vector<TablePoint> points, double noise) {
  for (TablePoint& point : points) point.tolerance *= noise;
  return points;
}

/// Points that scatter more than a depth camera's are judged by that, so that a plane has its
/// points however it was measured. Where things or walls seem to be why, these do not count.
double NoiseOn(const std::vector<TablePoint>& points, const TablePlane& plane) {
  double scatter = ScatterIn(points, plane);
  if (scatter > kUsualScatter)
    scatter = ScatterIn(WithoutUpright(points, TableIn(plane), kWide * scatter), plane);
  return scatter > kUsualScatter ? scatter : 1.0;
}

/// The same where the table may be so far that noise along the rays is little across its plane.
double FarNoiseOn(const std::vector<TablePoint>& flat, const TablePlane& plane) {
  const double scatter = ScatterIn(flat, plane);
  std::vector<double> depths;
  for (const TablePoint& point : flat)
    if (Supports(plane, point)) depths.push_back(point.p.z());
  if (scatter == 0.0 || depths.empty()) return 1.0;
  const double least = kUneven / DepthNoise(base::Median(std::move(depths)));
  return scatter > kUsualScatter ? scatter : std::clamp(scatter, std::min(least, 1.0), 1.0);
}

TablePlane Refined(TablePlane plane, const std::vector<TablePoint>& points) {
  for (int i = 0; i < kRefinements; ++i) plane = LeastSquares(points, plane);
  return plane;
}

double CountOn(const TablePlane& plane, const std::vector<TablePoint>& points) {
  return static_cast<double>(std::count_if(
      points.begin(), points.end(), [&](const TablePoint& one) { return Supports(plane, one); }));
}

/// The table in a plane that is known about.
/// @param least  points that it must have
std::optional<Table> TableAbout(TablePlane plane, const std::vector<TablePoint>& points,
                                const Level& level, double least) {
  plane = Refined(plane, points);
  const TableTop top = TopOf(points, TableIn(plane));
  if (top.border.size() < 3 || static_cast<double>(top.points.size()) < least) return std::nullopt;
  plane = LeastSquares(top.points, plane);
  if (!IsLevel(plane, level)) return std::nullopt;
  Table table = TableIn(plane);
  for (const Eigen::Vector3d& p : top.border) table.outline.push_back(table.FromAbove(p));
  table.outline = geometry::ConvexHull(std::move(table.outline));
  return table;
}

std::optional<Table> TableWithNoise(const TablePlane& plane, const std::vector<TablePoint>& points,
                                    const Level& level, double least, double noise) {
  if (noise == 1.0) return TableAbout(plane, points, level, least);
  auto table = TableAbout(plane, WithNoise(points, noise), level, least);
  if (table) table->noise = noise;
  return table;
}

/// What a plane's points are judged by. A wall straight before a camera is taken for a table the
/// easier, the more its points may scatter.
enum class Noise { kMeasured, kUsual };

std::optional<Table> LargestTable(const std::vector<TablePoint>& points, const Level& level,
                                  double least, const TableParams& params,
                                  Noise noise = Noise::kMeasured) {
  if (points.size() < kTablePoints) return std::nullopt;
  const auto best = LargestPlane(points, level, params);
  if (!best) return std::nullopt;
  return TableWithNoise(*best, points, level, least,
                        noise == Noise::kMeasured ? NoiseOn(points, *best) : 1.0);
}

/// Whether something stands over it.
bool HoldsThings(const Table& table, const std::vector<TablePoint>& points) {
  std::size_t num_over = 0;
  for (const TablePoint& point : points) {
    const double height = table.HeightOf(point.p);
    num_over += height > kClearly * table.noise * DepthNoise(point.p.z()) &&
                height < kHighestThing &&
                geometry::Contains(table.outline, table.FromAbove(point.p));
  }
  return num_over >= kThingPoints;
}

/// Whether it is wider than tables are.
bool IsFloor(const Table& table) {
  for (const Eigen::Vector2d& a : table.outline)
    for (const Eigen::Vector2d& b : table.outline)
      if ((a - b).norm() > kLongestTable) return true;
  return false;
}

std::vector<TablePoint> PointsOver(const Table& floor, const std::vector<TablePoint>& points,
                                   double lowest, double highest) {
  std::vector<TablePoint> over;
  for (const TablePoint& point : points) {
    const double height = floor.HeightOf(point.p);
    if (height > lowest && height < highest) over.push_back(point);
  }
  return over;
}

/// What holds few of all points and yet is the table, where things stand on it; of what is as high
/// walls and legs have no say.
std::optional<Table> SmallTable(const std::vector<TablePoint>& points, const Table& floor,
                                const TableParams& params) {
  if (points.size() < kTablePoints || !IsFloor(floor)) return std::nullopt;
  const Level level{floor.normal, kParallel};
  const double about = ScatterOf(PatchesIn(points, floor.normal));
  const auto flat = WithNoise(WithoutUpright(points, floor, about > 1.0 ? kWide * about : 1.0),
                              std::max(1.0, about));
  const auto best = LargestPlane(flat, level, params);
  if (!best) return std::nullopt;
  TablePlane plane = Refined(*best, flat);
  if (CountOn(plane, flat) < params.min_share * static_cast<double>(flat.size()))
    return std::nullopt;
  const double noise = FarNoiseOn(flat, plane);
  for (double wide = 0.5; wide > noise; wide *= 0.5)  // what it holds makes it lean
    plane = Refined(plane, WithNoise(flat, wide));
  const auto table = TableWithNoise(plane, points, level, kTablePoints, noise);
  return table && HoldsThings(*table, points) ? table : std::nullopt;
}

/// The table over a floor, so high as tables are and not what stands on them; else the floor.
Table TableOver(const Table& floor, const std::vector<TablePoint>& points, double least,
                const TableParams& params) {
  const auto over = [&](double lowest) {
    return PointsOver(floor, points, lowest, params.max_height);
  };
  const Level level{floor.normal, kParallel};
  if (const auto large = LargestTable(over(kLeastOverFloor), level, least, params)) return *large;
  return SmallTable(over(kLeastOfSmall), floor, params).value_or(floor);
}

}  // namespace

std::optional<Table> FindTable(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                               const TableParams& params) {
  const Candidates candidates = CandidatesOf(cloud, stand, params);
  const std::vector<TablePoint>& points = candidates.points;
  const double least = std::max<double>(kTablePoints, params.min_share * candidates.num_measured);
  if (stand) return LargestTable(points, {stand->up_C, params.max_inclination}, least, params);
  const auto seen_from_aside =
      LargestTable(points, {-Eigen::Vector3d::UnitY(), kMostUpright}, least, params);
  if (seen_from_aside) return TableOver(*seen_from_aside, points, least, params);
  const auto from_above =
      LargestTable(points, {-Eigen::Vector3d::UnitZ(), kFromAbove}, least, params, Noise::kUsual);
  return from_above && from_above->offset < kFarthestTable ? from_above : std::nullopt;
}

Table PlateIn(const PointCloud& cloud, Table expected, const TableParams& params) {
  const std::vector<TablePoint> points = PointsAbout(expected, cloud, params);
  if (points.size() < kPlatePoints) return expected;
  const TablePlane plane =
      Refined({expected.normal, expected.offset - MedianHeight(points, expected)}, points);
  const auto num_on_it = static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(),
                    [&](const TablePoint& point) { return Supports(plane, point); }));
  if (2 * num_on_it < points.size() || plane.normal.dot(expected.normal) < std::cos(kPlateTilt))
    return expected;
  Table plate = TableIn(plane);
  for (const Eigen::Vector2d& corner : expected.outline)
    plate.outline.push_back(plate.FromAbove(expected.Lift(corner)));
  return plate;
}

}  // namespace hires::perception
