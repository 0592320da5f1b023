#include "world/mend_object.h"

#include <fmt/format.h>

#include <cmath>

namespace hires::world {

std::string MendInertia(ObjectModel* object) {
  geometry::MassProperties& mass = object->mass_properties;
  const std::string why = geometry::WhyImplausible(mass, object->collisions);
  if (why.empty()) return "";
  mass.I_BBcm = geometry::SolidOf(object->collisions, mass.mass).I_BBcm;
  const Eigen::Vector3d taken = geometry::PrincipalMoments(mass);
  return fmt::format(
      "whose <inertia> no such body has ({}): that of a solid of its shapes is taken, {:.3g}, "
      "{:.3g}, {:.3g} kg m^2",
      why, taken[0], taken[1], taken[2]);
}

double LowestOf(const ObjectModel& object) {
  if (object.collisions.empty()) return 0.0;
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : object.collisions)
    bounds.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
  return bounds.lower.z();
}

std::string PutOriginAtUnderside(ObjectModel* object) {
  constexpr double kRounding = 1e-6, kWorthSaying = 1e-3;  // [m]
  const double lowest = LowestOf(*object);
  if (std::abs(lowest) <= kRounding) return "";
  object->mass_properties.p_BBcm.z() -= lowest;
  for (geometry::Collision& shape : object->collisions) shape.X_BS.translation.z() -= lowest;
  if (std::abs(lowest) <= kWorthSaying) return "";
  return fmt::format(
      "whose origin is {:.3f} m {} its lowest point: it stands on that point, from which its poses "
      "count here",
      std::abs(lowest), lowest < 0.0 ? "above" : "below");
}

}  // namespace hires::world
