#include "hires/navigation/standing_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "hires/base/error.h"
#include "hires/geometry/polygon.h"
#include "hires/geometry/shape.h"

namespace hires::navigation {
namespace {

constexpr double kBaseBand = 0.001;  // [m] of a base's unevenness

double BaseHeight(const world::ObjectModel& model) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const geometry::Collision& part : model.collisions) {
    lowest = std::min(lowest, geometry::BoundsOf(part.shape, part.X_BS).lower.z());
  }
  return lowest;
}

/// Outline of what a model stands on, seen from above; empty where there is nothing.
geometry::Polygon BaseOf(const world::ObjectModel& model) {
  const double lowest = BaseHeight(model);
  geometry::Polygon corners;
  for (const geometry::Collision& part : model.collisions) {
    const auto outline =
        geometry::OutlineInBand(part.shape, part.X_BS, lowest - kBaseBand, lowest + kBaseBand);
    if (outline) corners.insert(corners.end(), outline->begin(), outline->end());
  }
  return corners.empty() ? corners : geometry::ConvexHull(std::move(corners));
}

double FrictionOf(const world::ObjectModel& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const geometry::Collision& part : model.collisions) least = std::min(least, part.friction);
  return least;
}

}  // namespace

StandingLoad LoadOf(const world::ObjectModel& model) {
  const geometry::Polygon base = BaseOf(model);
  const Eigen::Vector3d& com = model.mass_properties.p_BBcm;
  if (base.empty() || !geometry::Contains(base, com.head<2>())) {
    throw base::ConfigError(fmt::format(
        "object model '{}': its centre of mass ({:.3f}, {:.3f}) is not over what it stands on, "
        "wanted a model that stands; give it a base or another <inertial> pose",
        model.name, com.x(), com.y()));
  }
  StandingLoad load;
  load.name = model.name;
  load.support = geometry::InscribedRadius(geometry::Transformed({-com.x(), -com.y(), 0.0}, base));
  load.com_height = com.z() - BaseHeight(model);
  load.friction = FrictionOf(model);
  return load;
}

}  // namespace hires::navigation
