#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/shape.h"

/// Where rays meet shapes, by closed forms, for tests of faster ways.
namespace hires::test_support {

inline Eigen::Vector3d AnyUnitVector(base::Rng* rng) {
  const double z = rng->Uniform(-1.0, 1.0), angle = rng->Uniform(0.0, 2.0 * geometry::kPi);
  const double around = std::sqrt(1.0 - z * z);
  return {around * std::cos(angle), around * std::sin(angle), z};
}

/// Within 1 m of `middle` along each axis, turned anyhow.
inline geometry::Pose3 AnyPose(base::Rng* rng, const Eigen::Vector3d& middle) {
  geometry::Pose3 pose;
  for (int axis = 0; axis < 3; ++axis) {
    pose.translation[axis] = middle[axis] + rng->Uniform(-1.0, 1.0);
  }
  pose.rotation = Eigen::AngleAxisd(rng->Uniform(0.0, geometry::kPi), AnyUnitVector(rng));
  return pose;
}

/// The stretch of a ray within slabs and round bodies: entered at the largest of all entries.
struct Stretch {
  double enter{0.0};
  double leave{std::numeric_limits<double>::infinity()};

  void CutSlab(double p, double d, double half) {
    if (d == 0.0) {
      if (std::abs(p) > half) leave = -1.0;
      return;
    }
    enter = std::max(enter, std::min((-half - p) / d, (half - p) / d));
    leave = std::min(leave, std::max((-half - p) / d, (half - p) / d));
  }
  /// a t^2 + 2 b t + c <= 0
  void CutRound(double a, double b, double c) {
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) {
      leave = -1.0;
      return;
    }
    enter = std::max(enter, (-b - std::sqrt(discriminant)) / a);
    leave = std::min(leave, (-b + std::sqrt(discriminant)) / a);
  }
};

inline Stretch StretchWithin(const geometry::Shape& shape, const Eigen::Vector3d& p,
                             const Eigen::Vector3d& d) {
  Stretch stretch;
  if (const auto* box = std::get_if<geometry::Box>(&shape)) {
    for (int axis = 0; axis < 3; ++axis) stretch.CutSlab(p[axis], d[axis], box->size[axis] / 2);
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&shape)) {
    stretch.CutRound(1.0, p.dot(d), p.squaredNorm() - sphere->radius * sphere->radius);
  } else {
    const auto& cylinder = std::get<geometry::Cylinder>(shape);
    const Eigen::Vector2d flat_p = p.head<2>(), flat_d = d.head<2>();
    stretch.CutRound(flat_d.squaredNorm(), flat_p.dot(flat_d),
                     flat_p.squaredNorm() - cylinder.radius * cylinder.radius);
    stretch.CutSlab(p.z(), d.z(), cylinder.length / 2);
  }
  return stretch;
}

/// [m] from outside along a unit vector to the shape (no mesh); infinite if it is missed.
inline double DistanceTo(const geometry::Shape& shape, const geometry::Pose3& X_MS,
                         const Eigen::Vector3d& from_M, const Eigen::Vector3d& direction) {
  const Stretch stretch =
      StretchWithin(shape, X_MS.Inverse() * from_M, X_MS.rotation.conjugate() * direction);
  return stretch.leave >= stretch.enter ? stretch.enter : std::numeric_limits<double>::infinity();
}

/// The shape with all its surface moved outwards; inwards where `by` is negative.
inline geometry::Shape Grown(const geometry::Shape& shape, double by) {
  if (const auto* box = std::get_if<geometry::Box>(&shape)) {
    return geometry::Box{box->size + 2.0 * Eigen::Vector3d::Constant(by)};
  }
  if (const auto* sphere = std::get_if<geometry::Sphere>(&shape)) {
    return geometry::Sphere{sphere->radius + by};
  }
  const auto& cylinder = std::get<geometry::Cylinder>(shape);
  return geometry::Cylinder{cylinder.radius + by, cylinder.length + 2.0 * by};
}

inline std::shared_ptr<const geometry::TriangleMesh> MeshOf(const geometry::Box& box) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner((k & 1) - 0.5, (k >> 1 & 1) - 0.5, (k >> 2 & 1) - 0.5);
    mesh->vertices.push_back(corner.cwiseProduct(box.size));
  }
  mesh->triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

}  // namespace hires::test_support
