#include "perception/shape_mesh.h"

#include <cmath>

#include "hires/base/overloaded.h"
#include "hires/geometry/angles.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;
using geometry::kPi;
using geometry::TriangleMesh;

/// Ring of corners round z, and a prism's or globe's side between two of them.
int AddRing(double radius, double z, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (int i = 0; i < kRoundSides; ++i) {
    const double angle = 2.0 * kPi * i / kRoundSides;
    mesh->vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return first;
}

void AddBand(int lower, int upper, TriangleMesh* mesh) {
  for (int i = 0; i < kRoundSides; ++i) {
    const int next = (i + 1) % kRoundSides;
    mesh->triangles.push_back({lower + i, lower + next, upper + next});
    mesh->triangles.push_back({lower + i, upper + next, upper + i});
  }
}

/// Joins a ring to one point: a disc, or the cap of a globe.
void AddFan(int ring, const Vector3d& tip, bool is_above, TriangleMesh* mesh) {
  const int middle = static_cast<int>(mesh->vertices.size());
  mesh->vertices.push_back(tip);
  for (int i = 0; i < kRoundSides; ++i) {
    const int next = (i + 1) % kRoundSides;
    const int a = ring + (is_above ? i : next), b = ring + (is_above ? next : i);
    mesh->triangles.push_back({middle, a, b});
  }
}

using Points = std::vector<SurfacePoint>;

/// 3 x 3 points on each face.
Points PointsOn(const geometry::Box& box) {
  Points points;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double area = box.size[u] * box.size[v] / 9.0;
    for (int k = 0; k < 18; ++k) {
      const double side = k < 9 ? 1.0 : -1.0;
      Vector3d p, n = Vector3d::Zero();
      n[axis] = side;
      p[axis] = side * box.size[axis] / 2;
      p[u] = box.size[u] * (k % 3 - 1) / 3.0;
      p[v] = box.size[v] * (k / 3 % 3 - 1) / 3.0;
      points.push_back({p, n, area});
    }
  }
  return points;
}

/// 12 points round at each of 4 heights, and 7 on each end: the middle and 6 at 0.7 of the radius.
Points PointsOn(const geometry::Cylinder& cylinder) {
  Points points;
  const double r = cylinder.radius, side_area = 2.0 * kPi * r * cylinder.length;
  for (int k = 0; k < 48; ++k) {
    const double angle = 2.0 * kPi * (k % 12) / 12.0;
    const Vector3d n(std::cos(angle), std::sin(angle), 0.0);
    const double z = cylinder.length * ((k / 12 + 0.5) / 4.0 - 0.5);
    points.push_back({r * n + z * Vector3d::UnitZ(), n, side_area / 48});
  }
  for (const double end : {1.0, -1.0}) {
    const Vector3d middle(0.0, 0.0, end * cylinder.length / 2);
    const double area = kPi * r * r / 7;
    points.push_back({middle, end * Vector3d::UnitZ(), area});
    for (int k = 0; k < 6; ++k) {
      const Vector3d out(std::cos(kPi * k / 3), std::sin(kPi * k / 3), 0.0);
      points.push_back({middle + 0.7 * r * out, end * Vector3d::UnitZ(), area});
    }
  }
  return points;
}

/// Along a spiral from pole to pole, each point for an equal area.
Points PointsOn(const geometry::Sphere& sphere) {
  constexpr int kNumPoints = 48;
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  Points points;
  for (int k = 0; k < kNumPoints; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kNumPoints, around = std::sqrt(1.0 - z * z);
    const Vector3d n(around * std::cos(k * golden_angle), around * std::sin(k * golden_angle), z);
    points.push_back(
        {sphere.radius * n, n, 4.0 * kPi * sphere.radius * sphere.radius / kNumPoints});
  }
  return points;
}

Vector3d AreaVector(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const Vector3d& a = mesh.vertices[triangle[0]];
  return 0.5 * (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
}

/// The middles of the triangles in which equal steps of the summed-up area end.
Points PointsOn(const std::shared_ptr<const TriangleMesh>& mesh) {
  constexpr int kNumPoints = 96;
  double total = 0.0;
  for (const auto& triangle : mesh->triangles) total += AreaVector(*mesh, triangle).norm();
  Points points;
  double covered = 0.0;
  for (const auto& triangle : mesh->triangles) {
    const Vector3d area = AreaVector(*mesh, triangle);
    const int before = static_cast<int>(points.size());
    covered += area.norm();
    // At `before` points so far the next one is due in the middle of its own step.
    int due = 0;
    while (before + due < kNumPoints && (before + due + 0.5) * total / kNumPoints <= covered) ++due;
    if (due == 0) continue;
    const Vector3d p =
        (mesh->vertices[triangle[0]] + mesh->vertices[triangle[1]] + mesh->vertices[triangle[2]]) /
        3.0;
    for (int k = 0; k < due; ++k) points.push_back({p, area.normalized(), total / kNumPoints});
  }
  return points;
}

/// Whether p lies within the shape by more than 0.1 mm; nothing lies within a mesh.
bool IsInside(const geometry::Shape& shape, const Vector3d& p) {
  constexpr double kSlack = 1e-4;
  return std::visit(
      base::Overloaded{
          [&](const geometry::Box& box) {
            return ((box.size / 2 - p.cwiseAbs()).array() > kSlack).all();
          },
          [&](const geometry::Cylinder& cylinder) {
            return std::hypot(p.x(), p.y()) < cylinder.radius - kSlack &&
                   std::abs(p.z()) < cylinder.length / 2 - kSlack;
          },
          [&](const geometry::Sphere& sphere) { return p.norm() < sphere.radius - kSlack; },
          [](const std::shared_ptr<const TriangleMesh>&) { return false; }},
      shape);
}

bool IsInsideAny(const std::vector<geometry::Collision>& collisions_O, const Vector3d& p_O) {
  for (const geometry::Collision& collision : collisions_O) {
    if (IsInside(collision.shape, collision.X_BS.Inverse() * p_O)) return true;
  }
  return false;
}

}  // namespace

TriangleMesh UnitBoxMesh() {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back((k & 1) - 0.5, (k >> 1 & 1) - 0.5, (k >> 2 & 1) - 0.5);
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

TriangleMesh UnitCylinderMesh() {
  TriangleMesh mesh;
  const int lower = AddRing(1.0, -0.5, &mesh), upper = AddRing(1.0, 0.5, &mesh);
  AddBand(lower, upper, &mesh);
  AddFan(lower, {0.0, 0.0, -0.5}, false, &mesh);
  AddFan(upper, {0.0, 0.0, 0.5}, true, &mesh);
  return mesh;
}

TriangleMesh UnitSphereMesh() {
  TriangleMesh mesh;
  constexpr int kRings = kRoundSides / 2 - 1;
  int ring = 0;
  for (int k = 1; k <= kRings; ++k) {
    const double angle = kPi * k / (kRings + 1);
    const int next = AddRing(std::sin(angle), -std::cos(angle), &mesh);
    if (k > 1) AddBand(ring, next, &mesh);
    ring = next;
  }
  AddFan(0, {0.0, 0.0, -1.0}, false, &mesh);
  AddFan(ring, {0.0, 0.0, 1.0}, true, &mesh);
  return mesh;
}

Vector3d ScaleOf(const geometry::Shape& shape) {
  return std::visit(base::Overloaded{[](const geometry::Box& box) -> Vector3d { return box.size; },
                                     [](const geometry::Cylinder& cylinder) -> Vector3d {
                                       return {cylinder.radius, cylinder.radius, cylinder.length};
                                     },
                                     [](const geometry::Sphere& sphere) -> Vector3d {
                                       return Vector3d::Constant(sphere.radius);
                                     },
                                     [](const std::shared_ptr<const TriangleMesh>&) -> Vector3d {
                                       return Vector3d::Ones();
                                     }},
                    shape);
}

std::vector<SurfacePoint> SurfacePattern(const std::vector<geometry::Collision>& collisions_O) {
  std::vector<SurfacePoint> pattern;
  for (const geometry::Collision& collision : collisions_O) {
    const Points points_S =
        std::visit([](const auto& shape) { return PointsOn(shape); }, collision.shape);
    for (const SurfacePoint& point_S : points_S) {
      const Vector3d p_O = collision.X_BS * point_S.p_O;
      if (IsInsideAny(collisions_O, p_O)) continue;
      pattern.push_back({p_O, collision.X_BS.rotation * point_S.n_O, point_S.area});
    }
  }
  return pattern;
}

}  // namespace hires::perception
