#include "robot/model_hash.h"

#include "hires/base/hash.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

void AddTo(base::Hasher* hash, const Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i) hash->Add(v[i]);
}

void AddTo(base::Hasher* hash, const Pose3& pose) {
  AddTo(hash, pose.translation);
  for (int i = 0; i < 4; ++i) hash->Add(pose.rotation.coeffs()[i]);
}

void AddTo(base::Hasher* hash, const geometry::TriangleMesh& mesh) {
  hash->Add(static_cast<std::uint64_t>(mesh.vertices.size()));
  for (const Eigen::Vector3d& vertex : mesh.vertices) AddTo(hash, vertex);
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) hash->Add(static_cast<std::uint64_t>(corner));
  }
}

void AddTo(base::Hasher* hash, const geometry::Collision& collision) {
  hash->Add(collision.name);
  AddTo(hash, collision.X_BS);
  hash->Add(collision.friction);
  hash->Add(collision.restitution);
  hash->Add(static_cast<std::uint64_t>(collision.shape.index()));
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) AddTo(hash, box->size);
  if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    hash->Add(cylinder->radius);
    hash->Add(cylinder->length);
  }
  if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    hash->Add(sphere->radius);
  }
  using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;
  if (const auto* mesh = std::get_if<MeshPtr>(&collision.shape)) AddTo(hash, **mesh);
}

void AddTo(base::Hasher* hash, const Joint& joint) {
  hash->Add(joint.name);
  hash->Add(static_cast<std::uint64_t>(joint.type));
  hash->Add(static_cast<std::uint64_t>(joint.parent));
  AddTo(hash, joint.X_PJ);
  AddTo(hash, joint.axis);
  hash->Add(static_cast<std::uint64_t>(joint.limits.has_value()));
  const JointLimits limits = joint.limits.value_or(JointLimits{});
  for (const double value : {limits.lower, limits.upper, limits.velocity, limits.effort,
                             joint.mimic_multiplier, joint.mimic_offset}) {
    hash->Add(value);
  }
  hash->Add(joint.mimics);
}

void AddTo(base::Hasher* hash, const geometry::MassProperties& mass) {
  hash->Add(mass.mass);
  AddTo(hash, mass.p_BBcm);
  for (int column = 0; column < 3; ++column) {
    AddTo(hash, Eigen::Vector3d(mass.I_BBcm.col(column)));
  }
}

}  // namespace

std::uint64_t HashOf(const RobotModel& model) {
  base::Hasher hash;
  hash.Add(model.name);
  for (const Link& link : model.links) {
    hash.Add(link.name);
    if (link.joint) AddTo(&hash, *link.joint);
    hash.Add(static_cast<std::uint64_t>(link.inertial.has_value()));
    if (link.inertial) AddTo(&hash, *link.inertial);
    hash.Add(static_cast<std::uint64_t>(link.collisions.size()));
    for (const geometry::Collision& collision : link.collisions) AddTo(&hash, collision);
  }
  return hash.value();
}

}  // namespace hires::robot
