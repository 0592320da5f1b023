#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <memory>

#include "hires/geometry/shape.h"

namespace hires::manipulation {

/// A shape as FCL takes it, fixed to its owner (a link or an object).
struct CollisionShape {
  std::shared_ptr<const fcl::CollisionGeometryd> exact;
  std::shared_ptr<const fcl::CollisionGeometryd> padded;  ///< null for meshes
  Eigen::Isometry3d X_OS;                                 ///< shape in its owner
  Eigen::Vector3d centre, half_size;                      ///< box around the exact shape, in S [m]
};

/// @param what  for messages: "link 'r_forearm_link'".
/// @throws base::ConfigError for a mesh that has no triangles.
CollisionShape MakeCollisionShape(const geometry::Collision& collision, double padding,
                                  const std::string& what);

/// A shape in its place in the map, with bounds along the map's axes.
struct PlacedCollisionShape {
  const CollisionShape* shape{nullptr};
  Eigen::Isometry3d X_MS;
  Eigen::Vector3d lower, upper;  ///< [m]
};
void Place(const CollisionShape& shape, const Eigen::Isometry3d& X_MO, PlacedCollisionShape* out);

/// @pre padding is that of MakeCollisionShape, or 0 for the exact shapes.
bool AreTouching(const PlacedCollisionShape& a, const PlacedCollisionShape& b, double padding);

Eigen::Isometry3d ToIsometry(const geometry::Pose3& pose);

}  // namespace hires::manipulation
