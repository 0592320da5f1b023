#include "manipulation/collision_shapes.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/overloaded.h"

namespace hires::manipulation {
namespace {

using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;
using Mesh = std::shared_ptr<const geometry::TriangleMesh>;

template <typename Shape>
Geometry Bounded(std::shared_ptr<Shape> shape) {
  shape->computeLocalAABB();
  return shape;
}

Geometry MakeMesh(const geometry::TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(mesh.triangles.size()),
                    static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return Bounded(model);
}

constexpr double kSmallest = 0.01;  // [m] edge or diameter of what is left of a shrunk shape

double Length(double length, double padding) {
  return padding < 0.0 ? std::max(std::min(length, kSmallest), length + 2.0 * padding)
                       : length + 2.0 * padding;
}

/// The shape with `padding` added on every side; a negative one makes it smaller. Nothing for a
/// mesh, unless it stays as it is.
Geometry Grown(const geometry::Shape& shape, double padding) {
  return std::visit(
      base::Overloaded{
          [&](const geometry::Box& box) -> Geometry {
            const Eigen::Vector3d size =
                box.size.unaryExpr([&](double edge) { return Length(edge, padding); });
            return Bounded(std::make_shared<fcl::Boxd>(size));
          },
          [&](const geometry::Cylinder& c) -> Geometry {
            return Bounded(std::make_shared<fcl::Cylinderd>(0.5 * Length(2.0 * c.radius, padding),
                                                            Length(c.length, padding)));
          },
          [&](const geometry::Sphere& s) -> Geometry {
            return Bounded(std::make_shared<fcl::Sphered>(0.5 * Length(2.0 * s.radius, padding)));
          },
          [&](const Mesh& mesh) -> Geometry { return padding > 0.0 ? nullptr : MakeMesh(*mesh); }},
      shape);
}

bool AreCloserThan(const PlacedCollisionShape& a, const PlacedCollisionShape& b, double distance) {
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(a.shape->exact.get(), a.X_MS, b.shape->exact.get(), b.X_MS, request,
                       result) <= distance;
}

bool Collide(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& X_MA,
             const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& X_MB) {
  const fcl::CollisionRequestd request;  // one contact, none described
  fcl::CollisionResultd result;
  return fcl::collide(&a, X_MA, &b, X_MB, request, result) > 0;
}

bool BoundsOverlap(const PlacedCollisionShape& a, const PlacedCollisionShape& b, double padding) {
  return (a.lower.array() - padding <= b.upper.array()).all() &&
         (b.lower.array() - padding <= a.upper.array()).all();
}

}  // namespace

Eigen::Isometry3d ToIsometry(const geometry::Pose3& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = pose.rotation.toRotationMatrix();
  X.translation() = pose.translation;
  return X;
}

CollisionShape MakeCollisionShape(const geometry::Collision& collision, double padding,
                                  const std::string& what) {
  const Mesh* mesh = std::get_if<Mesh>(&collision.shape);
  if (mesh != nullptr && (!*mesh || (*mesh)->triangles.empty())) {
    throw base::ConfigError(fmt::format(
        "{}, collision '{}': the mesh has no triangles; give it some, or use a box, cylinder or "
        "sphere",
        what, collision.name));
  }
  CollisionShape shape;
  shape.exact = Grown(collision.shape, 0.0);
  shape.padded = padding > 0.0 ? Grown(collision.shape, padding) : shape.exact;
  shape.X_OS = ToIsometry(collision.X_BS);
  const geometry::Aabb bounds = geometry::BoundsOf(collision.shape, {});
  shape.centre = 0.5 * (bounds.lower + bounds.upper);
  shape.half_size = 0.5 * (bounds.upper - bounds.lower);
  return shape;
}

void AddShrunk(const geometry::Shape& of, CollisionShape* shape) {
  shape->shrunk.front() = shape->exact;
  for (std::size_t i = 1; i < kShrinkage.size(); ++i) shape->shrunk[i] = Grown(of, -kShrinkage[i]);
}

void Place(const CollisionShape& shape, const Eigen::Isometry3d& X_MO, PlacedCollisionShape* out) {
  out->shape = &shape;
  out->X_MS = X_MO * shape.X_OS;
  const Eigen::Vector3d centre = out->X_MS * shape.centre;
  const Eigen::Vector3d reach = out->X_MS.linear().cwiseAbs() * shape.half_size;
  out->lower = centre - reach;
  out->upper = centre + reach;
}

bool AreTouching(const PlacedCollisionShape& a, const PlacedCollisionShape& b, double padding) {
  if (!BoundsOverlap(a, b, padding)) return false;
  if (padding <= 0.0) return Collide(*a.shape->exact, a.X_MS, *b.shape->exact, b.X_MS);
  if (a.shape->padded) return Collide(*a.shape->padded, a.X_MS, *b.shape->exact, b.X_MS);
  if (b.shape->padded) return Collide(*a.shape->exact, a.X_MS, *b.shape->padded, b.X_MS);
  return AreCloserThan(a, b, padding);
}

bool AreTouchingShrunk(const PlacedCollisionShape& a, const PlacedCollisionShape& b,
                       std::size_t level) {
  return BoundsOverlap(a, b, 0.0) &&
         Collide(*a.shape->shrunk[level], a.X_MS, *b.shape->shrunk[level], b.X_MS);
}

}  // namespace hires::manipulation
