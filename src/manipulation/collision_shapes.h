#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <array>
#include <memory>

#include "hires/geometry/shape.h"

namespace hires::manipulation {

/// [m] by which shapes are made smaller on every side where they cover more than the real part.
constexpr std::array<double, 4> kShrinkage = {0.0, 0.02, 0.04, 0.06};

/// A shape as FCL takes it, fixed to its owner (a link or an object).
struct CollisionShape {
  using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;
  Geometry exact;
  Geometry padded;                                   ///< null for meshes
  std::array<Geometry, kShrinkage.size()> shrunk{};  ///< see AddShrunk; the first is `exact`
  Eigen::Isometry3d X_OS;                            ///< shape in its owner
  Eigen::Vector3d centre, half_size;                 ///< box around the exact shape, in S [m]
};

/// @param what  for messages: "link 'r_forearm_link'".
/// @throws base::ConfigError for a mesh that has no triangles.
CollisionShape MakeCollisionShape(const geometry::Collision& collision, double padding,
                                  const std::string& what);
/// Adds the smaller versions; a mesh has none. No edge gets shorter than 0.01 m.
void AddShrunk(const geometry::Shape& of, CollisionShape* shape);

/// A shape in its place in the map, with bounds along the map's axes.
struct PlacedCollisionShape {
  const CollisionShape* shape{nullptr};
  Eigen::Isometry3d X_MS;
  Eigen::Vector3d lower, upper;  ///< [m]
};
void Place(const CollisionShape& shape, const Eigen::Isometry3d& X_MO, PlacedCollisionShape* out);

/// @pre padding is that of MakeCollisionShape, or 0 for the exact shapes.
bool AreTouching(const PlacedCollisionShape& a, const PlacedCollisionShape& b, double padding);
/// Both shapes smaller by kShrinkage[level].  @pre both have that version.
bool AreTouchingShrunk(const PlacedCollisionShape& a, const PlacedCollisionShape& b,
                       std::size_t level);

Eigen::Isometry3d ToIsometry(const geometry::Pose3& pose);

}  // namespace hires::manipulation
