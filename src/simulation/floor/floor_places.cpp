#include "hires/simulation/floor_places.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::simulation {
namespace {

constexpr double kRamp = 0.05;  // [m]

/// From the nearest point of the line between a and b.
double DistanceFrom(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = b - a;
  const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - share * along).norm();
}

double HeightOf(const Sill& sill, const Eigen::Vector2d& p_M) {
  const double beside = DistanceFrom(sill.from_M, sill.to_M, p_M) - 0.5 * sill.width;
  if (beside >= kRamp) return 0.0;
  if (beside <= 0.0) return sill.height;
  return 0.5 * sill.height * (1.0 + std::cos(geometry::kPi * beside / kRamp));
}

}  // namespace

double FloorPlaces::HeightAt(const Eigen::Vector2d& p_M) const {
  double height = 0.0;
  for (const Sill& sill : sills) height = std::max(height, HeightOf(sill, p_M));
  return height;
}

double FloorPlaces::TractionAt(const Eigen::Vector2d& p_M) const {
  double traction = kFullTraction;
  for (const SlipperyPatch& patch : patches) {
    if ((p_M - patch.center_M).norm() <= patch.radius)
      traction = std::min(traction, patch.traction);
  }
  return traction;
}

}  // namespace hires::simulation
