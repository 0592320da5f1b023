#include "perception/recognition/distance_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"
#include "hires/base/overloaded.h"
#include "perception/ray_scene.h"

namespace hires::perception {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCells = 48;                            // along the longest edge of the body
constexpr double kFinest = 0.0025, kCoarsest = 0.01;  // [m]
constexpr double kMet = 5e-4;                         // [m] from the surface, on a ray
constexpr int kMostSteps = 64;

// Of a point to the boundary of a convex body, from how far it is beyond each pair of faces.
template <typename Vector>
double Boxlike(const Vector& beyond) {
  return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
}

Vector3d NearestOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                           const Vector3d& c) {
  const auto on_edge = [&p](const Vector3d& from, const Vector3d& to) -> Vector3d {
    const Vector3d along = to - from;
    return from + std::clamp(along.dot(p - from) / along.squaredNorm(), 0.0, 1.0) * along;
  };
  const Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > 0.0) {
    const double u = normal.dot((b - a).cross(p - a)), v = normal.dot((c - b).cross(p - b)),
                 w = normal.dot((a - c).cross(p - c));
    if (u >= 0.0 && v >= 0.0 && w >= 0.0) return p - normal * (normal.dot(p - a) / area);
  }
  Vector3d nearest = a;
  for (const Vector3d& on : {on_edge(a, b), on_edge(b, c), on_edge(c, a)})
    if (!((on - p).squaredNorm() >= (nearest - p).squaredNorm())) nearest = on;
  return nearest;
}

/// What is known of the triangles that were looked at.
struct Nearest {
  const geometry::TriangleMesh& mesh;
  const Vector3d p;
  double distance{std::numeric_limits<double>::infinity()};
  double facing{0.0};  // of the normal towards p; where several are as near, of the one most so
};

/// Called by Embree for each triangle within the radius, which shrinks to the nearest one so far.
bool Consider(RTCPointQueryFunctionArguments* arguments) {
  constexpr double kAsNear = 1e-9, kSinglePrecision = 1e-6;  // [m]
  Nearest& found = *static_cast<Nearest*>(arguments->userPtr);
  const auto& corner = found.mesh.triangles[arguments->primID];
  const Vector3d &a = found.mesh.vertices[corner[0]], &b = found.mesh.vertices[corner[1]],
                 &c = found.mesh.vertices[corner[2]];
  const Vector3d way = found.p - NearestOnTriangle(found.p, a, b, c);
  const double towards = (b - a).cross(c - a).normalized().dot(way);
  const double distance = way.norm();
  const bool is_as_near = distance < found.distance + kAsNear;
  if (distance < found.distance - kAsNear ||
      (is_as_near && std::abs(towards) > std::abs(found.facing))) {
    found.facing = towards;
  }
  if (distance >= found.distance) return false;
  found.distance = distance;
  arguments->query->radius = static_cast<float>(distance + kSinglePrecision);
  return true;
}

/// By the nearest triangle; where several are, by the one that faces the point most.
double DistanceTo(RTCScene scene, const geometry::TriangleMesh& mesh, const Vector3d& p) {
  Nearest found{mesh, p};
  const Eigen::Vector3f at = p.cast<float>();
  RTCPointQuery query{at.x(), at.y(), at.z(), 0.0f, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, Consider, &found);
  return found.facing < 0.0 ? -found.distance : found.distance;
}

double DistanceTo(const MeshLibrary& meshes, const geometry::Shape& shape, const Vector3d& p) {
  return std::visit(
      base::Overloaded{[&](const geometry::Box& box) {
                         return Boxlike<Vector3d>(p.cwiseAbs() - box.size / 2.0);
                       },
                       [&](const geometry::Cylinder& cylinder) {
                         return Boxlike<Vector2d>({p.head<2>().norm() - cylinder.radius,
                                                   std::abs(p.z()) - cylinder.length / 2.0});
                       },
                       [&](const geometry::Sphere& sphere) { return p.norm() - sphere.radius; },
                       [&](const std::shared_ptr<const geometry::TriangleMesh>& mesh) {
                         return DistanceTo(meshes.Find(shape), *mesh, p);
                       }},
      shape);
}

}  // namespace

DistanceField::DistanceField(const std::vector<geometry::Collision>& collisions_B) {
  HIRES_CHECK(!collisions_B.empty(), "a body without shapes has no surface");
  MeshLibrary meshes;
  for (const geometry::Collision& one : collisions_B) {
    bounds_.Include(geometry::BoundsOf(one.shape, one.X_BS));
    meshes.Add(one.shape);
  }
  const Vector3d extent = bounds_.upper - bounds_.lower;
  cell_ = std::clamp(extent.maxCoeff() / kCells, kFinest, kCoarsest);
  origin_ = bounds_.lower.array() - kMargin;
  size_ = ((extent.array() + 2.0 * kMargin) / cell_).ceil().cast<int>() + 1;
  distances_.reserve(static_cast<std::size_t>(size_.prod()));
  std::vector<Eigen::Matrix3d> R_SB;
  for (const geometry::Collision& one : collisions_B)
    R_SB.push_back(one.X_BS.rotation.conjugate().toRotationMatrix());
  for (int i = 0; i < size_.prod(); ++i) {
    const Vector3d node(i % size_.x(), i / size_.x() % size_.y(), i / (size_.x() * size_.y()));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < R_SB.size(); ++k) {
      const Vector3d p_S = R_SB[k] * (origin_ + cell_ * node - collisions_B[k].X_BS.translation);
      nearest = std::min(nearest, DistanceTo(meshes, collisions_B[k].shape, p_S));
    }
    distances_.push_back(static_cast<float>(nearest));
  }
}

std::optional<DistanceField::Value> DistanceField::At(const Vector3d& p_B) const {
  const Vector3d p = (p_B - origin_) / cell_;
  const Eigen::Vector3i base = p.array().floor().cast<int>();
  if ((base.array() < 0).any() || (base.array() + 1 >= size_.array()).any()) return std::nullopt;
  const Vector3d f = p - base.cast<double>();
  double d[2][2][2];
  for (int k = 0; k < 8; ++k) {
    d[k >> 2][k >> 1 & 1][k & 1] =
        distances_[IndexOf(base.x() + (k & 1), base.y() + (k >> 1 & 1), base.z() + (k >> 2))];
  }
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  double along_x[2][2], slope_x[2][2];
  for (int k = 0; k < 4; ++k) {
    const double* edge = d[k >> 1][k & 1];
    along_x[k >> 1][k & 1] = mix(edge[0], edge[1], f.x());
    slope_x[k >> 1][k & 1] = edge[1] - edge[0];
  }
  const double lower = mix(along_x[0][0], along_x[0][1], f.y());
  const double upper = mix(along_x[1][0], along_x[1][1], f.y());
  Value value;
  value.distance = mix(lower, upper, f.z());
  value.gradient =
      Vector3d(mix(mix(slope_x[0][0], slope_x[0][1], f.y()),
                   mix(slope_x[1][0], slope_x[1][1], f.y()), f.z()),
               mix(along_x[0][1] - along_x[0][0], along_x[1][1] - along_x[1][0], f.z()),
               upper - lower) /
      cell_;
  return value;
}

std::optional<double> DistanceField::Meet(const Vector3d& from_B,
                                          const Vector3d& direction_B) const {
  double enter = 0.0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = bounds_.lower[axis] - cell_ - from_B[axis];
    const double upper = bounds_.upper[axis] + cell_ - from_B[axis];
    if (direction_B[axis] == 0.0) {
      if (lower > 0.0 || upper < 0.0) return std::nullopt;
      continue;
    }
    const double a = lower / direction_B[axis], b = upper / direction_B[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  for (int step = 0; step < kMostSteps && enter <= leave; ++step) {
    const auto value = At(from_B + enter * direction_B);
    if (!value) return std::nullopt;
    if (value->distance < kMet) return enter + value->distance;
    enter += value->distance;
  }
  return std::nullopt;
}

}  // namespace hires::perception
