#include "mapping/scan_matcher.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/geometry/angles.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;

constexpr int kMostIterations = 20;
constexpr double kFits = 0.1;             // [m] from a point to its wall
constexpr int kFewFacing = 20;            // points that tell how well a scan fits
constexpr double kParallel = 0.3;         // [rad] between faces that count as parallel
constexpr double kRobust = 3.0;           // sd from which on a distance counts less
constexpr double kMatchConverged = 1e-4;  // [m], [rad]
constexpr double kRivalBeside = 0.5;      // [m] from which on another pose is a rival ...
constexpr double kAsNear = 0.8;           // ... whose points lie so near, as a share of the best
constexpr double kFarSearch = 1.5;        // [m] to either side, where rivals are asked for
constexpr std::size_t kMostSearchPoints = 150;

/// A point on the piece of wall that is nearest to it.
struct Pair {
  const SurfaceMap::Piece* piece;
  Eigen::Vector2d r;  // [m] from the base, along the map's axes
};

/// Normal equations of all points and the prior about a pose.
struct Equations {
  Eigen::Matrix3d hessian{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d gradient{Eigen::Vector3d::Zero()};
  int num_fitting{0}, num_facing{0};
};

void AddPrior(const PosePrior& prior, const Pose2& X_MB, Equations* equations) {
  const Eigen::Vector3d weights(1.0 / (prior.position_sd * prior.position_sd),
                                1.0 / (prior.position_sd * prior.position_sd),
                                1.0 / (prior.yaw_sd * prior.yaw_sd));
  const Eigen::Vector3d error(X_MB.x - prior.X_MB.x, X_MB.y - prior.X_MB.y,
                              geometry::WrapToPi(X_MB.yaw - prior.X_MB.yaw));
  equations->hessian += weights.asDiagonal();
  equations->gradient += weights.cwiseProduct(error);
}

/// Across which the fewest walls stand.
Eigen::Vector2d LeastTold(const std::vector<Pair>& pairs) {
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Pair& pair : pairs) spread += pair.piece->n * pair.piece->n.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(spread);
  return solver.eigenvectors().col(0);
}

/// The piece of wall that each point with a normal lies on, if there is one.
/// @param[out] num_facing  points with normals.
std::vector<Pair> PairsAt(const SurfaceMap& map, const SurfacePoints& points, const Pose2& X_MB,
                          int* num_facing) {
  std::vector<Pair> pairs;
  const double c = std::cos(X_MB.yaw), s = std::sin(X_MB.yaw);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  for (const SurfacePoint& point : points) {
    if (!point.has_normal()) continue;
    ++*num_facing;
    const Eigen::Vector2d r = R * point.p, p = r + X_MB.position();
    const SurfaceMap::Piece* piece = map.Nearest(p, R * point.n);
    if (piece != nullptr) pairs.push_back({piece, r});
  }
  return pairs;
}

/// [m] of the point from its piece, along the piece's normal.
double DistanceOf(const Pair& pair, const Pose2& X_MB) {
  return pair.piece->n.dot(pair.r + X_MB.position() - pair.piece->p);
}

std::ptrdiff_t NumFitting(const std::vector<Pair>& pairs, const Pose2& X_MB) {
  return std::count_if(pairs.begin(), pairs.end(),
                       [&](const Pair& pair) { return std::abs(DistanceOf(pair, X_MB)) < kFits; });
}

Equations EquationsAt(const SurfaceMap& map, const SurfacePoints& points, const Pose2& X_MB,
                      double surface_sd) {
  Equations equations;
  const std::vector<Pair> pairs = PairsAt(map, points, X_MB, &equations.num_facing);
  const Eigen::Vector2d least = LeastTold(pairs);
  for (const Pair& pair : pairs) {
    const auto& [piece, r] = pair;
    const double distance = DistanceOf(pair, X_MB);
    if (std::abs(distance) < kFits) ++equations.num_fitting;
    const double sds = std::abs(distance) / surface_sd;
    const double weight = (sds <= kRobust ? 1.0 : kRobust / sds) / (surface_sd * surface_sd);
    const double along = least.dot(piece->n);
    const Eigen::Vector2d told =
        std::abs(along) < kParallel ? Eigen::Vector2d(piece->n - along * least) : piece->n;
    const Eigen::Vector3d J(told.x(), told.y(), piece->n.dot(Eigen::Vector2d(-r.y(), r.x())));
    equations.hessian += weight * J * J.transpose();
    equations.gradient += weight * distance * J;
  }
  return equations;
}

std::vector<Eigen::Vector2d> EveryFew(const SurfacePoints& points) {
  const std::size_t step = 1 + points.size() / kMostSearchPoints;
  std::vector<Eigen::Vector2d> few;
  for (std::size_t i = 0; i < points.size(); i += step) few.push_back(points[i].p);
  return few;
}

}  // namespace

Eigen::Matrix2d PositionCovarianceOf(const ScanMatch& match) {
  // By far less than any wall tells: a singular matrix has an inverse then.
  const Eigen::Matrix3d damped = match.information + 1e-6 * Eigen::Matrix3d::Identity();
  return damped.inverse().topLeftCorner<2, 2>();
}

LeastKnown LeastKnownOf(const ScanMatch& match) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(PositionCovarianceOf(match));
  return {solver.eigenvectors().col(1), std::sqrt(std::max(solver.eigenvalues()[1], 0.0))};
}

int NumFacing(const SurfacePoints& points) {
  return static_cast<int>(std::count_if(
      points.begin(), points.end(), [](const SurfacePoint& point) { return point.has_normal(); }));
}

bool SeesMuch(const SurfacePoints& points) { return NumFacing(points) >= kFewFacing; }

FitWhereSeen FitWhereSeenAt(const SurfaceMap& map, const SurfacePoints& points, const Pose2& X_MB) {
  SurfacePoints seen;
  for (const SurfacePoint& point : points)
    if (point.has_normal() && map.HasNear(X_MB * point.p)) seen.push_back(point);
  FitWhereSeen out;
  const std::vector<Pair> pairs = PairsAt(map, seen, X_MB, &out.num_points);
  if (out.num_points > 0) out.fit = static_cast<double>(NumFitting(pairs, X_MB)) / out.num_points;
  return out;
}

std::optional<double> FitAt(const SurfaceMap& map, const SurfacePoints& points, const Pose2& X_MB) {
  if (!SeesMuch(points)) return std::nullopt;
  int num_facing = 0;
  const std::vector<Pair> pairs = PairsAt(map, points, X_MB, &num_facing);
  return static_cast<double>(NumFitting(pairs, X_MB)) / num_facing;
}

ScanMatch RefineMatch(const SurfaceMap& map, const SurfacePoints& points, const Pose2& guess,
                      const std::optional<PosePrior>& prior, double surface_sd) {
  ScanMatch match;
  match.X_MB = guess;
  for (int i = 0; i < kMostIterations; ++i) {
    Equations equations = EquationsAt(map, points, match.X_MB, surface_sd);
    match.fit = equations.num_facing == 0
                    ? 0.0
                    : static_cast<double>(equations.num_fitting) / equations.num_facing;
    if (prior) AddPrior(*prior, match.X_MB, &equations);
    match.information = equations.hessian;
    // A direction that nothing tells of stays as it is.
    const Eigen::Matrix3d damped = equations.hessian + 1e-3 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = -damped.ldlt().solve(equations.gradient);
    match.X_MB = {match.X_MB.x + step.x(), match.X_MB.y + step.y(),
                  geometry::WrapToPi(match.X_MB.yaw + step.z())};
    if (step.cwiseAbs().maxCoeff() < kMatchConverged) break;
  }
  return match;
}

FoundPose SearchMatch(const SurfaceMap& map, const SurfacePoints& points, const Pose2& guess,
                      const SearchWindow& window) {
  const std::vector<Eigen::Vector2d> few = EveryFew(points);
  const GridSearch search(map.nearness(), few, guess, window, {2, 0.02});
  const GridMatch coarse = search.Best();
  const GridSearch fine(map.nearness(), few, coarse.X_MB, {0.1, 0.02}, {1, 0.01});
  FoundPose found{fine.Best().X_MB, std::nullopt};
  if (window.reach < kFarSearch) return found;
  const GridMatch other = search.Best(Disc{coarse.X_MB.position(), kRivalBeside});
  if (other.score >= kAsNear * coarse.score) found.X_MRival = other.X_MB;
  return found;
}

}  // namespace hires::mapping
