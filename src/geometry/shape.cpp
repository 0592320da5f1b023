#include "hires/geometry/shape.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/overloaded.h"
#include "hires/geometry/angles.h"

namespace hires::geometry {
namespace {

constexpr int kRoundCorners = 24;
constexpr double kTinyCorner = 1e-9;  // [m]
constexpr double kAlike = 5e-4;       // [m]

bool IsSamePlace(const Pose3& a, const Pose3& b) {
  constexpr double kTurn = 1e-3;  // [rad]
  return (a.translation - b.translation).cwiseAbs().maxCoeff() <= kAlike &&
         a.rotation.angularDistance(b.rotation) <= kTurn;
}

bool IsSame(double a, double b) { return std::abs(a - b) <= kAlike; }
bool IsSame(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kAlike;
}

bool IsSameForm(const Shape& a, const Shape& b) {
  using Mesh = std::shared_ptr<const TriangleMesh>;
  const auto differ = [](const auto&, const auto&) { return false; };
  return std::visit(
      base::Overloaded{
          differ, [](const Box& one, const Box& other) { return IsSame(one.size, other.size); },
          [](const Sphere& one, const Sphere& other) { return IsSame(one.radius, other.radius); },
          [](const Cylinder& one, const Cylinder& other) {
            return IsSame(one.radius, other.radius) && IsSame(one.length, other.length);
          },
          [](const Mesh& one, const Mesh& other) {
            const auto is_same = [](const auto& p, const auto& q) { return IsSame(p, q); };
            return one->triangles == other->triangles &&
                   std::equal(one->vertices.begin(), one->vertices.end(), other->vertices.begin(),
                              other->vertices.end(), is_same);
          }},
      a, b);
}

/// Corners of a regular polygon around the circle.
void AddCircumscribed(double radius, double z, std::vector<Eigen::Vector3d>* corners) {
  const double around = radius / std::cos(kPi / kRoundCorners);
  for (int i = 0; i < kRoundCorners; ++i) {
    const double angle = 2.0 * kPi * i / kRoundCorners;
    corners->emplace_back(around * std::cos(angle), around * std::sin(angle), z);
  }
}

std::vector<Eigen::Vector3d> CornersOf(const Box& box) {
  std::vector<Eigen::Vector3d> corners;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) {
        corners.push_back(box.size.cwiseProduct(Eigen::Vector3d(x, y, z)));
      }
    }
  }
  return corners;
}

/// Corners of a prism around the cylinder.
std::vector<Eigen::Vector3d> CornersOf(const Cylinder& cylinder) {
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {-cylinder.length / 2, cylinder.length / 2}) {
    AddCircumscribed(cylinder.radius, z, &corners);
  }
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

std::vector<Eigen::Vector2d> CutPolytopeToBand(std::vector<Eigen::Vector3d> corners,
                                               const Pose3& X_WS, double z_min, double z_max) {
  for (Eigen::Vector3d& corner : corners) corner = X_WS * corner;
  return CutToBand(corners, z_min, z_max);
}

/// The widest circle that the band cuts from the sphere, as corners around it.
std::vector<Eigen::Vector2d> CutSphereToBand(const Sphere& sphere, const Eigen::Vector3d& p_WS,
                                             double z_min, double z_max) {
  const double off = std::clamp(p_WS.z(), z_min, z_max) - p_WS.z();
  if (std::abs(off) >= sphere.radius) return {};
  std::vector<Eigen::Vector3d> corners;
  AddCircumscribed(std::sqrt((sphere.radius - off) * (sphere.radius + off)), 0.0, &corners);
  std::vector<Eigen::Vector2d> points;
  points.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners) points.push_back((p_WS + corner).head<2>());
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

/// Cut points that should fall together, or on one line, miss each other by a rounding; without
/// this the hull of 24 corners would have some forty.
Polygon WithoutTinyCorners(const Polygon& hull) {
  Polygon kept;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d& previous = kept.empty() ? hull.back() : kept.back();
    const Eigen::Vector2d chord = hull[(i + 1) % hull.size()] - previous;
    const Eigen::Vector2d p = hull[i] - previous;
    if (p.x() * chord.y() - p.y() * chord.x() > kTinyCorner * chord.norm()) kept.push_back(hull[i]);
  }
  return kept.size() >= 3 ? kept : hull;
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
  const auto around = [&X_WS](const Eigen::Vector3d& half) {
    return Aabb{X_WS.translation - half, X_WS.translation + half};
  };
  return std::visit(
      base::Overloaded{
          [&](const Box& box) {
            const Eigen::Matrix3d R_WS = X_WS.rotation.toRotationMatrix();
            return around(R_WS.cwiseAbs() * box.size / 2.0);
          },
          [&](const Cylinder& cylinder) {
            const Eigen::Array3d axis = X_WS.rotation * Eigen::Vector3d::UnitZ();
            const Eigen::Array3d across = (1.0 - axis.square()).cwiseMax(0.0).sqrt();
            return around(cylinder.length / 2 * axis.abs() + cylinder.radius * across);
          },
          [&](const Sphere& sphere) { return around(Eigen::Vector3d::Constant(sphere.radius)); },
          [&](const std::shared_ptr<const TriangleMesh>& mesh) {
            Aabb bounds;
            for (const Eigen::Vector3d& p : mesh->vertices) bounds.Include(X_WS * p);
            return bounds;
          }},
      shape);
}

int TurnSymmetry(const std::vector<Collision>& collisions_B) {
  constexpr double kSame = 1e-4;  // [m], and of unit vectors
  int symmetry = kRound;
  for (const Collision& one : collisions_B) {
    const Eigen::Matrix3d R_BS = one.X_BS.rotation.toRotationMatrix();
    const bool is_on_axis = one.X_BS.translation.head<2>().norm() < kSame;
    const bool is_upright = std::abs(R_BS(2, 2)) > 1.0 - kSame;
    int own = 1;
    if (is_on_axis && std::holds_alternative<Sphere>(one.shape)) own = kRound;
    if (is_on_axis && is_upright && std::holds_alternative<Cylinder>(one.shape)) own = kRound;
    if (const Box* box = std::get_if<Box>(&one.shape); box && is_on_axis && is_upright)
      own = std::abs(box->size.x() - box->size.y()) < kSame ? 4 : 2;
    symmetry = std::min(symmetry, own);
  }
  // Squares that are turned against each other have the symmetry of two alone, or none at all.
  return symmetry == 4 && collisions_B.size() > 1 ? 2 : symmetry;
}

bool AreAlike(const std::vector<Collision>& a, const std::vector<Collision>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const Collision& one, const Collision& other) {
        return IsSamePlace(one.X_BS, other.X_BS) && IsSameForm(one.shape, other.shape);
      });
}

std::optional<Polygon> OutlineInBand(const Shape& shape, const Pose3& X_WS, double z_min,
                                     double z_max) {
  HIRES_CHECK(z_min <= z_max, "a band ends below its beginning");
  std::vector<Eigen::Vector2d> points = std::visit(
      base::Overloaded{[&](const Sphere& sphere) {
                         return CutSphereToBand(sphere, X_WS.translation, z_min, z_max);
                       },
                       [&](const std::shared_ptr<const TriangleMesh>& mesh) {
                         return CutMeshToBand(*mesh, X_WS, z_min, z_max);
                       },
                       [&](const auto& box_or_cylinder) {
                         return CutPolytopeToBand(CornersOf(box_or_cylinder), X_WS, z_min, z_max);
                       }},
      shape);
  if (!SpansAnArea(points)) return std::nullopt;
  return WithoutTinyCorners(ConvexHull(std::move(points)));
}

}  // namespace hires::geometry
