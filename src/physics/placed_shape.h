#pragma once

#include <Eigen/Core>
#include <memory>

#include "hires/geometry/shape.h"
#include "physics/contact_points.h"
#include "physics/polytope.h"

struct dxGeom;
struct dxTriMeshData;

namespace hires::physics {

/// @throws base::ConfigError naming the collision if a size is not positive and finite, a mesh is
/// empty or names vertices it does not have, friction or restitution is out of range.
void RequireShape(const geometry::Collision& collision);

/// A collision shape that can be put anywhere and asked where it touches another one.
class PlacedShape {
 public:
  enum class Kind { kFloor, kBox, kCylinder, kSphere, kMesh };

  static PlacedShape Floor(double friction);
  /// @throws base::ConfigError as RequireShape.
  explicit PlacedShape(const geometry::Collision& collision);

  void Place(const Eigen::Vector3d& p_WS, const Eigen::Matrix3d& R_WS);

  Kind kind() const { return kind_; }
  double friction() const { return friction_; }
  double restitution() const { return restitution_; }
  const Eigen::Vector3d& position() const { return p_WS_; }
  double reach() const { return reach_; }    ///< no point is farther from S than this [m]
  double inside() const { return inside_; }  ///< thickness: a ball of this radius fits in [m]

  PlacedCylinder cylinder() const;  ///< @pre kind() is kCylinder
  PlacedBox box() const;            ///< @pre kind() is kBox
  /// Boxes and those meshes that are convex solids of few faces.
  bool is_polytope() const { return kind_ == Kind::kBox || polytope_ != nullptr; }
  PlacedPolytope polytope();  ///< @pre is_polytope()

  /// ODE's own shape, moved to where this one is.
  dxGeom* geom();

 private:
  PlacedShape() = default;
  void MakeBox(const geometry::Box& box);
  void MakeCylinder(const geometry::Cylinder& cylinder);
  void MakeSphere(const geometry::Sphere& sphere);
  void MakeMesh(const geometry::TriangleMesh& mesh);

  struct Release {
    void operator()(dxGeom* geom) const;
    void operator()(dxTriMeshData* data) const;
  };

  Kind kind_{Kind::kFloor};
  double friction_{1.0};
  double restitution_{0.0};
  double reach_{0.0};
  double inside_{0.0};
  Eigen::Vector3d size_{Eigen::Vector3d::Zero()};  // half edges; or radius, -, half length
  Eigen::Vector3d p_WS_{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d R_WS_{Eigen::Matrix3d::Identity()};
  bool is_geom_in_place_{false};
  std::unique_ptr<const Polytope> polytope_;           // of a box once it is asked for
  std::unique_ptr<dxTriMeshData, Release> mesh_data_;  // outlives the geom
  std::vector<double> vertices_;                       // ODE reads both while the geom lives
  std::vector<unsigned> indices_;
  std::unique_ptr<dxGeom, Release> geom_;
};

/// Finds where A touches B. `lean` is the direction in which A is about to tip relative to B [any
/// length]. At most ContactList::kAtMost points.
void FindContacts(PlacedShape& a, PlacedShape& b, const Eigen::Vector3d& lean,
                  ContactList* contacts);

/// Where a ray first enters the shape.
struct RayHit {
  bool hit{false};
  double distance{0.0};                              ///< from the ray's start [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};  ///< against the ray
};
RayHit CastRay(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double length,
               PlacedShape& shape);

}  // namespace hires::physics
