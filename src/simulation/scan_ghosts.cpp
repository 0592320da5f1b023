#include "hires/simulation/scan_ghosts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hires::simulation {
namespace {

using geometry::Polygon;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

double DistanceTo(const Polygon& outline, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& direction) {
  if (geometry::Contains(outline, from)) return 0.0;
  const Eigen::Vector2d along = direction.normalized();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - a;
    const double denominator = Cross(along, edge);
    if (denominator == 0.0) continue;  // parallel: another edge is met first
    const double distance = Cross(a - from, edge) / denominator;
    const double share = Cross(a - from, along) / denominator;
    if (distance >= 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

void AddGhosts(const std::vector<Polygon>& ghosts_M, const LaserParams& params,
               const geometry::Pose2& X_ML, std::vector<double>* ranges) {
  if (ghosts_M.empty()) return;
  const double step = (params.angle_max - params.angle_min) / (params.num_beams - 1);
  for (std::size_t i = 0; i < ranges->size(); ++i) {
    const double angle = X_ML.yaw + params.angle_min + static_cast<double>(i) * step;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    for (const Polygon& ghost : ghosts_M) {
      const double range = DistanceTo(ghost, X_ML.position(), direction);
      if (range <= params.range_max) {
        (*ranges)[i] = std::max(std::min((*ranges)[i], range), params.range_min);
      }
    }
  }
}

}  // namespace hires::simulation
