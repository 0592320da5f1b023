#include "world/content_hash.h"

#include <algorithm>

#include "hires/base/text.h"

namespace hires::world {
namespace {

void AddVector(base::Hasher* hasher, const Eigen::Vector3d& v) {
  for (const double x : {v.x(), v.y(), v.z()}) hasher->Add(x);
}

struct ShapeHasher {
  base::Hasher* hasher;

  void operator()(const geometry::Box& box) const { AddVector(hasher, box.size); }
  void operator()(const geometry::Cylinder& cylinder) const {
    hasher->Add(cylinder.radius);
    hasher->Add(cylinder.length);
  }
  void operator()(const geometry::Sphere& sphere) const { hasher->Add(sphere.radius); }
  void operator()(const std::shared_ptr<const geometry::TriangleMesh>& mesh) const {
    hasher->Add(static_cast<std::uint64_t>(mesh->vertices.size()));
    for (const Eigen::Vector3d& p : mesh->vertices) AddVector(hasher, p);
    hasher->Add(static_cast<std::uint64_t>(mesh->triangles.size()));
    for (const auto& triangle : mesh->triangles) {
      for (const int corner : triangle) hasher->Add(static_cast<std::uint64_t>(corner));
    }
  }
};

void AddCollision(base::Hasher* hasher, const geometry::Collision& collision) {
  hasher->Add(base::ToLower(collision.name));
  hasher->Add(static_cast<std::uint64_t>(collision.shape.index()));
  std::visit(ShapeHasher{hasher}, collision.shape);
  AddTo(hasher, collision.X_BS);
  hasher->Add(collision.friction);
  hasher->Add(collision.restitution);
}

/// In the order of their names, so that the order in the file does not matter.
void AddCollisions(base::Hasher* hasher, const std::vector<geometry::Collision>& collisions) {
  std::vector<const geometry::Collision*> ordered;
  for (const geometry::Collision& collision : collisions) ordered.push_back(&collision);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto* a, const auto* b) { return a->name < b->name; });
  hasher->Add(static_cast<std::uint64_t>(ordered.size()));
  for (const geometry::Collision* collision : ordered) AddCollision(hasher, *collision);
}

}  // namespace

void AddTo(base::Hasher* hasher, const geometry::Pose3& pose) {
  AddVector(hasher, pose.translation);
  // Both signs of a quaternion are one rotation.
  const Eigen::Vector4d coeffs =
      pose.rotation.w() < 0.0 ? Eigen::Vector4d(-pose.rotation.coeffs()) : pose.rotation.coeffs();
  for (int i = 0; i < 4; ++i) hasher->Add(coeffs[i]);
}

void AddTo(base::Hasher* hasher, const ObjectModel& model) {
  hasher->Add(model.mass_properties.mass);
  AddVector(hasher, model.mass_properties.p_BBcm);
  for (int i = 0; i < 9; ++i) hasher->Add(model.mass_properties.I_BBcm(i / 3, i % 3));
  AddCollisions(hasher, model.collisions);
}

void AddTo(base::Hasher* hasher, const StaticBody& body) {
  hasher->Add(base::ToLower(body.name));
  AddTo(hasher, body.X_MB);
  AddCollisions(hasher, body.collisions);
}

}  // namespace hires::world
