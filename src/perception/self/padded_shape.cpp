#include "perception/self/padded_shape.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/overloaded.h"
#include "perception/self/mesh_distance.h"

namespace hires::perception {

using Eigen::Vector3f;

PaddedShape::PaddedShape(const geometry::Collision& shape_S, const MeshLibrary& library,
                         float padding)
    : R_ShapeS_(shape_S.X_BS.rotation.conjugate().toRotationMatrix().cast<float>()),
      p_SShape_(shape_S.X_BS.translation.cast<float>()),
      padding_(padding) {
  std::visit(base::Overloaded{[&](const geometry::Box& box) {
                                kind_ = Kind::kBox;
                                half_ = box.size.cast<float>() / 2.0f;
                              },
                              [&](const geometry::Cylinder& cylinder) {
                                kind_ = Kind::kCylinder;
                                half_ = {static_cast<float>(cylinder.radius), 0.0f,
                                         static_cast<float>(cylinder.length / 2.0)};
                              },
                              [&](const geometry::Sphere& sphere) {
                                kind_ = Kind::kSphere;
                                half_.x() = static_cast<float>(sphere.radius);
                              },
                              [&](const std::shared_ptr<const geometry::TriangleMesh>& mesh) {
                                mesh_ = mesh.get();
                                scene_ = library.Find(shape_S.shape);
                                HIRES_CHECK(scene_ != nullptr, "a mesh is not in the library");
                              }},
             shape_S.shape);
  const auto bounds = geometry::BoundsOf(shape_S.shape, shape_S.X_BS);
  const Vector3f pad = Vector3f::Constant(padding);
  bounds_ = {bounds.lower.cast<float>() - pad, bounds.upper.cast<float>() + pad};
  const auto own = geometry::BoundsOf(shape_S.shape, {});
  middle_ = (shape_S.X_BS * Eigen::Vector3d((own.lower + own.upper) / 2.0)).cast<float>();
  radius_ = static_cast<float>((own.upper - own.lower).norm() / 2.0) + padding;
}

float PaddedShape::Distance(const Vector3f& p_S, float limit) const {
  const Vector3f p = R_ShapeS_ * (p_S - p_SShape_);
  switch (kind_) {
    case Kind::kBox:
      return (p.cwiseAbs() - half_).cwiseMax(0.0f).norm();
    case Kind::kCylinder: {
      const float beside = std::max(0.0f, std::sqrt(p.x() * p.x() + p.y() * p.y()) - half_.x());
      const float above = std::max(0.0f, std::abs(p.z()) - half_.z());
      return std::sqrt(beside * beside + above * above);
    }
    case Kind::kSphere:
      return std::max(0.0f, p.norm() - half_.x());
    case Kind::kMesh:
      break;
  }
  return DistanceToMesh(scene_, *mesh_, p, limit);
}

bool PaddedShape::IsCrossed(const Vector3f& p_S) const {
  constexpr float kGraze = 1e-3f;  // [m]
  const float length = p_S.norm();
  const Vector3f direction = p_S / length;
  const float nearest = middle_.dot(direction);
  const float beside = (middle_ - nearest * direction).squaredNorm();
  if (beside > radius_ * radius_) return false;
  const float half_chord = std::sqrt(radius_ * radius_ - beside);
  const float end = std::min(length, nearest + half_chord);
  // As far as the next surface is away, no step can pass through it.
  for (float t = std::max(0.0f, nearest - half_chord); t <= end;) {
    const float gap = Distance(t * direction, 2.0f * radius_) - padding_;
    if (gap <= 0.0f) return true;
    t += std::max(gap, kGraze);
  }
  return false;
}

}  // namespace hires::perception
