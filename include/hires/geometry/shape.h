#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"

namespace hires::geometry {

struct Box {
  Eigen::Vector3d size{1.0, 1.0, 1.0};  ///< full edge lengths [m]
};
struct Cylinder {  ///< axis along z, centred
  double radius{0.5};
  double length{1.0};
};
struct Sphere {
  double radius{0.5};
};
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< [m], scaled
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
};
/// Meshes are constant after loading and shared between worlds.
using Shape = std::variant<Box, Cylinder, Sphere, std::shared_ptr<const TriangleMesh>>;

/// A collision shape S fixed to a body B.
struct Collision {
  std::string name;
  Shape shape;
  Pose3 X_BS;
  double friction{1.0};     ///< Coulomb coefficient; a contact takes the smaller of its two
  double restitution{0.0};  ///< a contact takes the larger of its two
};

struct Aabb {
  Eigen::Vector3d lower{Eigen::Vector3d::Constant(1e300)};
  Eigen::Vector3d upper{Eigen::Vector3d::Constant(-1e300)};
  void Include(const Eigen::Vector3d& point);
  void Include(const Aabb& other);
  bool Overlaps(const Aabb& other) const;
};
/// The smallest box along W's axes around the shape; round shapes count as round.
Aabb BoundsOf(const Shape& shape, const Pose3& X_WS);

/// How often a body comes to lie on itself while it turns once about its z axis; kRound: always.
/// Meshes count as lying on themselves after a whole turn alone.
int TurnSymmetry(const std::vector<Collision>& collisions_B);
inline constexpr int kRound = 1 << 20;

/// Whether two bodies are made of the same shapes in the same places, one by one, within 0.5 mm; of
/// one form that is made in two ways it says no.
bool AreAlike(const std::vector<Collision>& a, const std::vector<Collision>& b);

/// Convex outline, seen from above, of the part of the shape within z_min..z_max of frame W;
/// nothing if no part lies there. Round shapes become polygons of 24 corners around them
/// (circumscribed). A mesh gives the hull of its surface's part in the band.
/// Corners that stand out by less than 1e-9 m are left out.
/// @pre z_min <= z_max
std::optional<Polygon> OutlineInBand(const Shape& shape, const Pose3& X_WS, double z_min,
                                     double z_max);

}  // namespace hires::geometry
