#include "simulation/clearance/touch_shape.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "geometry/mesh_pieces.h"
#include "hires/base/overloaded.h"

namespace hires::simulation {
namespace {

using Mesh = std::shared_ptr<const geometry::TriangleMesh>;
using Solid = std::shared_ptr<fcl::CollisionGeometryd>;

Solid MakeMesh(const geometry::TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

Solid MakeSolid(const geometry::Shape& shape) {
  const Solid solid = std::visit(
      base::Overloaded{
          [](const geometry::Box& box) -> Solid { return std::make_shared<fcl::Boxd>(box.size); },
          [](const geometry::Cylinder& c) -> Solid {
            return std::make_shared<fcl::Cylinderd>(c.radius, c.length);
          },
          [](const geometry::Sphere& s) -> Solid {
            return std::make_shared<fcl::Sphered>(s.radius);
          },
          [](const Mesh& mesh) -> Solid { return MakeMesh(*mesh); }},
      shape);
  solid->computeLocalAABB();
  return solid;
}

Eigen::Isometry3d ToIsometry(const geometry::Pose3& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = pose.rotation.toRotationMatrix();
  X.translation() = pose.translation;
  return X;
}

using Plane = Eigen::Hyperplane<double, 3>;
using ConvexPart = std::vector<Plane>;  // normals outwards

std::vector<ConvexPart> SolidPartsOf(const geometry::TriangleMesh& mesh) {
  std::vector<ConvexPart> solid;
  for (const geometry::TriangleMesh& part : geometry::ConnectedParts(mesh)) {
    if (!geometry::IsSolid(part)) continue;
    ConvexPart planes;
    for (const auto& t : part.triangles) {
      const Eigen::Vector3d& a = part.vertices[t[0]];
      const Eigen::Vector3d normal = (part.vertices[t[1]] - a).cross(part.vertices[t[2]] - a);
      if (normal.norm() > 0.0) planes.emplace_back(normal.normalized(), a);
    }
    solid.push_back(std::move(planes));
  }
  return solid;
}

}  // namespace

struct TouchShape::Geometry {
  Solid solid;
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};  // one of its own
  std::vector<ConvexPart> solid_parts;             // of a mesh
};

TouchShape::TouchShape(const geometry::Shape& shape) {
  auto geometry = std::make_unique<Geometry>();
  geometry->solid = MakeSolid(shape);
  if (const Mesh* mesh = std::get_if<Mesh>(&shape)) {
    is_mesh_ = true;
    geometry->point = (*mesh)->vertices.at((*mesh)->triangles.front()[0]);
    geometry->solid_parts = SolidPartsOf(**mesh);
  }
  geometry_ = std::move(geometry);
}
TouchShape::~TouchShape() = default;
TouchShape::TouchShape(TouchShape&&) noexcept = default;
TouchShape& TouchShape::operator=(TouchShape&&) noexcept = default;

bool TouchShape::Contains(const Eigen::Vector3d& p_S) const {
  const auto contains = [&](const ConvexPart& part) {
    return std::all_of(part.begin(), part.end(),
                       [&](const Plane& plane) { return plane.signedDistance(p_S) <= 0.0; });
  };
  return std::any_of(geometry_->solid_parts.begin(), geometry_->solid_parts.end(), contains);
}

bool TouchShape::Touches(const geometry::Pose3& X_MS, const TouchShape& other,
                         const geometry::Pose3& X_MO) const {
  const fcl::CollisionRequestd request;  // one contact, none described
  fcl::CollisionResultd result;
  if (fcl::collide(geometry_->solid.get(), ToIsometry(X_MS), other.geometry_->solid.get(),
                   ToIsometry(X_MO), request, result) > 0) {
    return true;
  }
  const geometry::Pose3 X_SO = X_MS.Inverse() * X_MO;
  return Contains(X_SO * other.geometry_->point) ||
         other.Contains(X_SO.Inverse() * geometry_->point);
}

Eigen::Vector3d TouchShape::MeetingPoint(const geometry::Pose3& X_MS, const TouchShape& other,
                                         const geometry::Pose3& X_MO) const {
  const fcl::CollisionRequestd request(1, true);  // one contact, with its place
  fcl::CollisionResultd result;
  if (fcl::collide(geometry_->solid.get(), ToIsometry(X_MS), other.geometry_->solid.get(),
                   ToIsometry(X_MO), request, result) > 0) {
    return result.getContact(0).pos;
  }
  const Eigen::Vector3d p_M = X_MO * other.geometry_->point;  // one lies within the other
  return Contains(X_MS.Inverse() * p_M) ? p_M : X_MS * geometry_->point;
}

double TouchShape::Distance(const geometry::Pose3& X_MS, const TouchShape& other,
                            const geometry::Pose3& X_MO) const {
  if (Touches(X_MS, other, X_MO)) return 0.0;
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return std::max(
      0.0, fcl::distance(geometry_->solid.get(), ToIsometry(X_MS), other.geometry_->solid.get(),
                         ToIsometry(X_MO), request, result));
}

}  // namespace hires::simulation
