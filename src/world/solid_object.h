#pragma once

#include "hires/world/world.h"

namespace hires::world {

constexpr double kSmallestSolid = 0.001, kLargestSolid = 10.0;  // [m] along each side

/// A solid cylinder or box that stands on its origin. @param height, mass  [m], [kg]; above 0.
template <typename Solid>
ObjectModel SolidObject(const Solid& solid, double height, double mass) {
  ObjectModel model;
  model.mass_properties.mass = mass;
  model.mass_properties.I_BBcm = geometry::SolidInertia(solid, mass);
  model.mass_properties.p_BBcm.z() = height / 2.0;
  geometry::Collision collision;
  collision.name = "body";
  collision.shape = solid;
  collision.X_BS.translation.z() = height / 2.0;
  model.collisions.push_back(std::move(collision));
  return model;
}

}  // namespace hires::world
