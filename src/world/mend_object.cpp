#include "world/mend_object.h"

#include <fmt/format.h>

#include <cmath>

namespace hires::world {
namespace {

geometry::Aabb BoundsOfShapes(const ObjectModel& object) {
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : object.collisions)
    bounds.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
  return bounds;
}

std::string SizeText(const Eigen::Vector3d& size) {
  return fmt::format("{:.3g} x {:.3g} x {:.3g} m", size.x(), size.y(), size.z());
}

}  // namespace

std::string MendInertia(bool is_said, ObjectModel* object) {
  geometry::MassProperties& mass = object->mass_properties;
  const std::string why = is_said ? geometry::WhyImplausible(mass, object->collisions) : "";
  if (is_said && why.empty()) return "";
  mass.I_BBcm = geometry::SolidOf(object->collisions, mass.mass).I_BBcm;
  const Eigen::Vector3d taken = geometry::PrincipalMoments(mass);
  return fmt::format(
      "{}: that of a solid of its shapes is taken, {:.3g}, {:.3g}, {:.3g} kg m^2",
      is_said ? fmt::format("whose <inertia> no such body has ({})", why) : "without <inertia>",
      taken[0], taken[1], taken[2]);
}

std::vector<std::string> DoubtsOfMass(const ObjectModel& object) {
  constexpr double kDensest = 23000.0;               // [kg/m^3] osmium, rounded up
  constexpr double kThinnest = 0.001;                // [m] as which flat meshes count
  constexpr double kGrams = 0.001, kOutside = 0.01;  // [kg], [m]
  std::vector<std::string> doubts;
  if (object.collisions.empty()) return doubts;
  const geometry::Aabb bounds = BoundsOfShapes(object);
  const Eigen::Vector3d size = bounds.upper - bounds.lower;
  const geometry::MassProperties& mass = object.mass_properties;
  if (mass.mass > kDensest * size.cwiseMax(kThinnest).prod()) {
    doubts.push_back(
        fmt::format("whose {:g} kg are more than any matter has in the {} of its shapes, as if the "
                    "unit were not the kilogram: in grams it would be {:g} kg",
                    mass.mass, SizeText(size), kGrams * mass.mass));
  }
  const Eigen::Vector3d& p = mass.p_BBcm;
  const Eigen::Vector3d outside = (bounds.lower - p).cwiseMax(p - bounds.upper);
  if (outside.maxCoeff() > kOutside) {
    doubts.push_back(
        fmt::format("whose centre of mass ({:.3g}, {:.3g}, {:.3g}) m lies {:.3g} m outside of the "
                    "box round its shapes, as if the pose of its <inertial> were not meant",
                    p.x(), p.y(), p.z(), outside.maxCoeff()));
  }
  return doubts;
}

std::string DoubtOfSize(const ObjectModel& object) {
  constexpr double kLarge = 3.0;  // [m]
  if (object.collisions.empty()) return "";
  const geometry::Aabb bounds = BoundsOfShapes(object);
  const Eigen::Vector3d size = bounds.upper - bounds.lower;
  if (size.maxCoeff() <= kLarge) return "";
  return fmt::format(
      "that is {} large, as if its unit were not the metre: in mm it would be {}, in cm {}",
      SizeText(size), SizeText(0.001 * size), SizeText(0.01 * size));
}

double LowestOf(const ObjectModel& object) {
  if (object.collisions.empty()) return 0.0;
  return BoundsOfShapes(object).lower.z();
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
