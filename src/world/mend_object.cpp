#include "world/mend_object.h"

#include <fmt/format.h>

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

}  // namespace hires::world
