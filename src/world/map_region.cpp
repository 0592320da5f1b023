#include "world/map_region.h"

#include <fmt/format.h>

#include "hires/geometry/shape.h"
#include "world/floor_level.h"

namespace hires::world {
namespace {

constexpr double kWholeArea = 1e4;  // [m^2] 4 million cells of 0.05 m: maps of seconds
constexpr double kBorder = 2.0;     // [m] beyond the outermost body that maps of most robots have
constexpr double kOverhead = 5.0;   // [m] above the floor; few robots are as high

Eigen::AlignedBox2d Flat(const geometry::Aabb& bounds) {
  return {bounds.lower.head<2>(), bounds.upper.head<2>()};
}

double MapArea(const Eigen::AlignedBox2d& region) {
  return (region.sizes().array() + 2.0 * kBorder).prod();
}

/// Whether a robot could meet it, or stand on it where there is no floor without end.
bool Counts(const geometry::Aabb& bounds, const World& world) {
  const bool bears = world.ground_depth > 0.0 && bounds.upper.z() >= -kFloorStep;
  return bounds.lower.z() <= kOverhead && (bears || bounds.upper.z() > kFloorStep);
}

}  // namespace

std::optional<Eigen::AlignedBox2d> MapRegion(const World& world) {
  Eigen::AlignedBox2d all, met, areas;
  for (const auto& [name, X_MF] : world.frames) areas.extend(X_MF.translation.head<2>());
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS);
      all.extend(Flat(bounds));
      if (Counts(bounds, world)) met.extend(Flat(bounds));
    }
  }
  if (areas.isEmpty() || all.isEmpty() || MapArea(all.merged(areas)) <= kWholeArea)
    return std::nullopt;
  Eigen::AlignedBox2d region;
  for (const double around : {50.0, 40.0, 30.0, 20.0}) {  // [m] for detours
    const Eigen::Vector2d more = Eigen::Vector2d::Constant(around);
    const Eigen::AlignedBox2d near(areas.min() - more, areas.max() + more);
    region = met.isEmpty() ? areas : met.intersection(near).merged(areas);
    if (MapArea(region) <= kWholeArea) break;
  }
  return region;
}

void NoteMapRegion(World* world) {
  const auto region = MapRegion(*world);
  if (!region) return;
  world->notes.push_back(fmt::format(
      "the world is so wide that its map for drives covers what lies around the areas, x {:.1f} m "
      "to {:.1f} m, y {:.1f} m to {:.1f} m: no way leads through what lies beyond",
      region->min().x(), region->max().x(), region->min().y(), region->max().y()));
}

}  // namespace hires::world
