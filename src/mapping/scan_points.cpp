#include "mapping/scan_points.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "localisation/beams.h"

namespace hires::mapping {
namespace {

constexpr double kNormalReach = 0.2;    // [m] to either side, and at least ...
constexpr int kNormalBeams = 2;         // ... as many beams
constexpr double kWidestGrazing = 5.0;  // gap between beams, as a multiple of that on a facing wall
constexpr double kRoughestSurface = 0.05;  // [m] sd about its line

/// Whether two neighbours lie on one surface.
bool IsJoined(const SurfacePoint& a, const SurfacePoint& b, const Eigen::Vector2d& p_L,
              double increment) {
  const double range = std::min((a.p - p_L).norm(), (b.p - p_L).norm());
  return (a.p - b.p).norm() < 0.05 + kWidestGrazing * range * increment;
}

/// Of the points around one; zero where they are few or no line.
Eigen::Vector2d NormalOf(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& p_L) {
  if (points.size() < 3) return Eigen::Vector2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points)
    spread += (p - mean) * (p - mean).transpose() / static_cast<double>(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector2d widths = solver.eigenvalues();
  if (widths[0] > kRoughestSurface * kRoughestSurface || widths[0] > 0.1 * widths[1])
    return Eigen::Vector2d::Zero();
  const Eigen::Vector2d n = solver.eigenvectors().col(0);
  return n.dot(p_L - mean) < 0.0 ? Eigen::Vector2d(-n) : n;
}

/// A point and those beside it on its surface.
std::vector<Eigen::Vector2d> PointsAround(const SurfacePoints& points,
                                          const std::vector<bool>& starts, std::size_t i) {
  std::vector<Eigen::Vector2d> around{points[i].p};
  const auto is_near = [&](std::size_t j, int beams) {
    return beams < kNormalBeams || (points[j].p - points[i].p).norm() < kNormalReach;
  };
  int beams = 0;
  for (std::size_t j = i; j > 0 && !starts[j] && is_near(j - 1, beams); --j, ++beams)
    around.push_back(points[j - 1].p);
  beams = 0;
  for (std::size_t j = i + 1; j < points.size() && !starts[j] && is_near(j, beams); ++j, ++beams)
    around.push_back(points[j].p);
  return around;
}

}  // namespace

bool HasMet(const robot::ScanReading& scan, std::size_t beam, double max_range) {
  const double range = scan.ranges[beam];
  const bool is_near = range <= max_range && !localisation::HasMetNothing(range, scan.range_max);
  return range >= scan.range_min && range > 0.0 && is_near;
}

Eigen::Vector2d EndOf(const robot::ScanReading& scan, std::size_t beam) {
  const double angle = scan.angle_min + static_cast<double>(beam) * scan.angle_increment;
  return {scan.ranges[beam] * std::cos(angle), scan.ranges[beam] * std::sin(angle)};
}

SurfacePoints PointsOf(const localisation::RobotLog::Scan& scan, double max_range) {
  const robot::ScanReading& reading = scan.reading;
  const Eigen::Vector2d p_BL = scan.X_BL.position();
  SurfacePoints points;
  std::vector<bool> starts;  // whether a surface may end before the point
  bool is_after_gap = true;
  for (std::size_t i = 0; i < reading.ranges.size(); ++i) {
    const bool has_met = HasMet(reading, i, max_range);
    if (has_met) {
      points.push_back({scan.X_BL * EndOf(reading, i)});
      starts.push_back(is_after_gap || !IsJoined(points[points.size() - 2], points.back(), p_BL,
                                                 std::abs(reading.angle_increment)));
    }
    is_after_gap = !has_met;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].n = NormalOf(PointsAround(points, starts, i), p_BL);
  return points;
}

SurfacePoints Thinned(const SurfacePoints& points, double spacing) {
  SurfacePoints thinned;
  for (const SurfacePoint& point : points)
    if (thinned.empty() || (point.p - thinned.back().p).norm() >= spacing) thinned.push_back(point);
  return thinned;
}

}  // namespace hires::mapping
