#include "hires/geometry/bearing_face.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/mesh_pieces.h"

namespace hires::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLevelFace = 0.02;       // [rad] that a level face may be tilted
constexpr double kOneHeight = 2e-3;       // [m] faces that differ by less are one
constexpr double kNearlyAsLarge = 0.8;    // of the largest face's area
constexpr double kLeastOfOutline = 0.1;   // of the area from above
constexpr double kSteepestBearing = 0.7;  // z of a unit normal: 45 degrees

std::array<Vector3d, 3> CornersOf(const TriangleMesh& mesh, const std::array<int, 3>& triangle,
                                  const Pose3& X_WM) {
  return {X_WM * mesh.vertices[triangle[0]], X_WM * mesh.vertices[triangle[1]],
          X_WM * mesh.vertices[triangle[2]]};
}

struct LevelFace {
  double height;  // [m]
  double area;    // [m^2]
  Aabb bounds;
};

/// Triangles of one height together, from below.
/// @param winding  1 where triangles are counter-clockwise from outside, -1 where from inside: only
/// those that look up; 0: those that look down, too
std::vector<LevelFace> LevelFacesOf(const TriangleMesh& mesh, const Pose3& X_WM, double winding) {
  std::vector<LevelFace> triangles;
  for (const auto& triangle : mesh.triangles) {
    const auto [a, b, c] = CornersOf(mesh, triangle, X_WM);
    const Vector3d normal = 0.5 * (b - a).cross(c - a);
    if (normal.norm() <= 0.0 || std::abs(normal.z()) < std::cos(kLevelFace) * normal.norm())
      continue;
    if (winding * normal.z() < 0.0) continue;
    LevelFace face{(a.z() + b.z() + c.z()) / 3.0, normal.norm(), {}};
    for (const Vector3d& corner : {a, b, c}) face.bounds.Include(corner);
    triangles.push_back(face);
  }
  std::stable_sort(
      triangles.begin(), triangles.end(),
      [](const LevelFace& one, const LevelFace& other) { return one.height < other.height; });
  std::vector<LevelFace> faces;
  for (const LevelFace& triangle : triangles) {
    if (faces.empty() || triangle.height > faces.back().height + kOneHeight) {
      faces.push_back(triangle);
    } else {
      faces.back().area += triangle.area;
      faces.back().bounds.Include(triangle.bounds);
    }
  }
  return faces;
}

double LargestOf(const std::vector<LevelFace>& faces) {
  double largest = 0.0;
  for (const LevelFace& face : faces) largest = std::max(largest, face.area);
  return largest;
}

}  // namespace

Aabb BearingBounds(const Shape& shape, const Pose3& X_WS) {
  const Aabb whole = BoundsOf(shape, X_WS);
  const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
  if (mesh == nullptr) return whole;
  const Vector3d size = whole.upper - whole.lower;
  const double least = kLeastOfOutline * size.x() * size.y();
  const Vector3d p_SMiddle = X_WS.Inverse() * Vector3d(0.5 * (whole.lower + whole.upper));
  const double winding = SixfoldVolume(**mesh, p_SMiddle) < 0.0 ? -1.0 : 1.0;
  std::vector<LevelFace> faces = LevelFacesOf(**mesh, X_WS, winding);
  // Sheets are wound either way.
  if (LargestOf(faces) < least) faces = LevelFacesOf(**mesh, X_WS, 0.0);
  const double largest = LargestOf(faces);
  if (largest <= 0.0 || largest < least) return whole;
  const auto top = std::find_if(faces.rbegin(), faces.rend(), [&](const LevelFace& face) {
    return face.area >= kNearlyAsLarge * largest;
  });
  Aabb bounds = top->bounds;
  bounds.lower.z() = whole.lower.z();
  return bounds;
}

bool HasFaceAt(const TriangleMesh& mesh, const Pose3& X_WM, const Vector3d& p_W, double gap) {
  return std::any_of(
      mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<int, 3>& triangle) {
        const auto [a, b, c] = CornersOf(mesh, triangle, X_WM);
        const Vector3d normal = (b - a).cross(c - a);
        if (std::abs(normal.z()) < kSteepestBearing * normal.norm() || normal.norm() <= 0.0)
          return false;
        // The height of its plane there, and whether the point lies on one side of all its edges.
        const double z = a.z() - normal.head<2>().dot((p_W - a).head<2>()) / normal.z();
        if (std::abs(z - p_W.z()) > gap) return false;
        const auto side = [&](const Vector3d& from, const Vector3d& to) {
          const Vector2d along = (to - from).head<2>(), off = (p_W - from).head<2>();
          return (along.x() * off.y() - along.y() * off.x()) * normal.z();
        };
        return side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0;
      });
}

}  // namespace hires::geometry
