#include "hires/geometry/shape.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::geometry {
namespace {

constexpr int kRoundCorners = 24;

template <typename... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <typename... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

/// Corners of a convex polytope around the shape, in the shape's frame.
std::vector<Eigen::Vector3d> Corners(const Shape& shape) {
  std::vector<Eigen::Vector3d> corners;
  const auto add_prism = [&corners](double radius, double z_min, double z_max) {
    const double around = radius / std::cos(kPi / kRoundCorners);
    for (int i = 0; i < kRoundCorners; ++i) {
      const double angle = 2.0 * kPi * i / kRoundCorners;
      for (const double z : {z_min, z_max}) {
        corners.emplace_back(around * std::cos(angle), around * std::sin(angle), z);
      }
    }
  };
  std::visit(Overloaded{[&](const Box& box) {
                          for (const double x : {-0.5, 0.5}) {
                            for (const double y : {-0.5, 0.5}) {
                              for (const double z : {-0.5, 0.5}) {
                                corners.push_back(box.size.cwiseProduct(Eigen::Vector3d(x, y, z)));
                              }
                            }
                          }
                        },
                        [&](const Cylinder& cylinder) {
                          add_prism(cylinder.radius, -cylinder.length / 2, cylinder.length / 2);
                        },
                        [&](const Sphere& sphere) {
                          add_prism(sphere.radius, -sphere.radius, sphere.radius);
                        },
                        [&](const std::shared_ptr<const TriangleMesh>& mesh) {
                          corners = mesh->vertices;
                        }},
             shape);
  return corners;
}

/// Corners of the polytope's part in the band. All corner pairs count as edges: the hull of the cut
/// is the same, and shapes are small. A mesh's edges are its triangles'.
std::vector<Eigen::Vector2d> CutToBand(const std::vector<Eigen::Vector3d>& corners, double z_min,
                                       double z_max) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : corners) {
    if (p.z() >= z_min && p.z() <= z_max) points.push_back(p.head<2>());
  }
  for (const double z : {z_min, z_max}) {
    for (const Eigen::Vector3d& low : corners) {
      if (low.z() >= z) continue;
      for (const Eigen::Vector3d& high : corners) {
        if (high.z() <= z) continue;
        const double t = (z - low.z()) / (high.z() - low.z());
        points.push_back((low + t * (high - low)).head<2>());
      }
    }
  }
  return points;
}

/// A mesh has too many corner pairs; its triangles' edges carry the cut.
std::vector<Eigen::Vector2d> CutMeshToBand(const TriangleMesh& mesh, const Pose3& X_WS,
                                           double z_min, double z_max) {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector3d> corners;
  for (const auto& triangle : mesh.triangles) {
    corners.clear();
    for (const int index : triangle) corners.push_back(X_WS * mesh.vertices[index]);
    const std::vector<Eigen::Vector2d> cut = CutToBand(corners, z_min, z_max);
    points.insert(points.end(), cut.begin(), cut.end());
  }
  return points;
}

bool SpansAnArea(const std::vector<Eigen::Vector2d>& points) {
  for (std::size_t i = 2; i < points.size(); ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      const Eigen::Vector2d a = points[i] - points[0], b = points[j] - points[0];
      if (std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-12) return true;
    }
  }
  return false;
}

}  // namespace

void Aabb::Include(const Eigen::Vector3d& point) {
  lower = lower.cwiseMin(point);
  upper = upper.cwiseMax(point);
}

void Aabb::Include(const Aabb& other) {
  lower = lower.cwiseMin(other.lower);
  upper = upper.cwiseMax(other.upper);
}

bool Aabb::Overlaps(const Aabb& other) const {
  return (lower.array() <= other.upper.array()).all() &&
         (other.lower.array() <= upper.array()).all();
}

Aabb BoundsOf(const Shape& shape, const Pose3& X_WS) {
  Aabb bounds;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    bounds.lower = X_WS.translation.array() - sphere->radius;
    bounds.upper = X_WS.translation.array() + sphere->radius;
    return bounds;
  }
  for (const Eigen::Vector3d& corner : Corners(shape)) bounds.Include(X_WS * corner);
  return bounds;
}

std::optional<Polygon> OutlineInBand(const Shape& shape, const Pose3& X_WS, double z_min,
                                     double z_max) {
  std::vector<Eigen::Vector2d> points;
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    points = CutMeshToBand(**mesh, X_WS, z_min, z_max);
  } else {
    std::vector<Eigen::Vector3d> corners = Corners(shape);
    for (Eigen::Vector3d& corner : corners) corner = X_WS * corner;
    points = CutToBand(corners, z_min, z_max);
  }
  if (!SpansAnArea(points)) return std::nullopt;
  return ConvexHull(std::move(points));
}

}  // namespace hires::geometry
