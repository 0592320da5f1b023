#include "geometry/convex_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/mesh_pieces.h"
#include "hires/geometry/polygon.h"

namespace hires::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPlate = 1e-3;           // [m] thickness
constexpr double kSmallest = 1e-3;        // [m^2] of a face that things stand on: 10 cm^2
constexpr double kSameNormal = 1e-6;      // 1 - cosine between triangles of one face
constexpr double kConvexSlack = 1e-6;     // of a face's area
constexpr std::size_t kMostCorners = 60;  // of a face, as contacts take solids of so many faces
constexpr std::size_t kMostPieces = 100;

/// Triangles that hang together in one plane.
struct FlatFace {
  std::vector<int> triangles;
  Vector3d normal;
  double area{0.0};
};

Vector3d AreaNormal(const TriangleMesh& mesh, int triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vector3d& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

using Edges = std::map<std::pair<int, int>, std::vector<int>>;

Edges TrianglesByEdge(const TriangleMesh& mesh) {
  Edges edges;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    const auto& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) edges[std::minmax(t[k], t[(k + 1) % 3])].push_back(i);
  }
  return edges;
}

/// In the order of their first triangle; triangles without an area are of none.
std::vector<FlatFace> FlatFacesOf(const TriangleMesh& mesh) {
  const Edges edges = TrianglesByEdge(mesh);
  std::vector<bool> is_taken(mesh.triangles.size(), false);
  std::vector<FlatFace> faces;
  for (int first = 0; first < static_cast<int>(mesh.triangles.size()); ++first) {
    const Vector3d normal = AreaNormal(mesh, first).normalized();
    if (is_taken[first] || !(normal.norm() > 0.5)) continue;
    FlatFace face{{first}, normal};
    is_taken[first] = true;
    for (std::size_t i = 0; i < face.triangles.size(); ++i) {
      const int at = face.triangles[i];
      face.area += AreaNormal(mesh, at).norm();
      for (int k = 0; k < 3; ++k) {
        const auto& t = mesh.triangles[at];
        for (const int other : edges.at(std::minmax(t[k], t[(k + 1) % 3]))) {
          if (is_taken[other]) continue;
          if (AreaNormal(mesh, other).normalized().dot(normal) < 1.0 - kSameNormal) continue;
          is_taken[other] = true;
          face.triangles.push_back(other);
        }
      }
    }
    faces.push_back(std::move(face));
  }
  return faces;
}

double AreaOf(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

/// The face as a plate below it; null where it is small, not convex, or has holes.
std::shared_ptr<const TriangleMesh> PlateOf(const TriangleMesh& mesh, const FlatFace& face) {
  if (face.area < kSmallest) return nullptr;
  const Vector3d u = face.normal.unitOrthogonal(), v = face.normal.cross(u);
  const Vector3d& origin = mesh.vertices[mesh.triangles[face.triangles.front()][0]];
  std::vector<Vector2d> points;
  for (const int triangle : face.triangles) {
    for (const int corner : mesh.triangles[triangle]) {
      const Vector3d p = mesh.vertices[corner] - origin;
      points.emplace_back(u.dot(p), v.dot(p));
    }
  }
  const Polygon outline = ConvexHull(std::move(points));
  if (outline.size() > kMostCorners) return nullptr;
  if (AreaOf(outline) > (1.0 + kConvexSlack) * face.area) return nullptr;
  auto plate = std::make_shared<TriangleMesh>();
  for (const double depth : {0.0, kPlate}) {
    for (const Vector2d& p : outline)
      plate->vertices.push_back(origin + p.x() * u + p.y() * v - depth * face.normal);
  }
  const int n = static_cast<int>(outline.size());
  for (int i = 1; i + 1 < n; ++i) {
    plate->triangles.push_back({0, i, i + 1});
    plate->triangles.push_back({n, n + i + 1, n + i});
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    plate->triangles.push_back({i, n + i, n + next});
    plate->triangles.push_back({i, n + next, next});
  }
  return plate;
}

void AppendTriangle(const TriangleMesh& from, int triangle, TriangleMesh* to) {
  std::array<int, 3> corners;
  for (int k = 0; k < 3; ++k) {
    corners[k] = static_cast<int>(to->vertices.size());
    to->vertices.push_back(from.vertices[from.triangles[triangle][k]]);
  }
  to->triangles.push_back(corners);
}

}  // namespace

ConvexPieces ConvexPiecesOf(const TriangleMesh& mesh) {
  ConvexPieces pieces;
  auto rest = std::make_shared<TriangleMesh>();
  for (TriangleMesh& part : ConnectedParts(mesh)) {
    if (pieces.solids.size() > kMostPieces) break;
    if (IsSolid(part)) {
      pieces.solids.push_back(std::make_shared<const TriangleMesh>(std::move(part)));
      continue;
    }
    for (const FlatFace& face : FlatFacesOf(part)) {
      if (auto plate = PlateOf(part, face)) {
        pieces.solids.push_back(std::move(plate));
      } else {
        for (const int triangle : face.triangles) AppendTriangle(part, triangle, rest.get());
      }
    }
  }
  if (pieces.solids.size() > kMostPieces) return {{}, std::make_shared<const TriangleMesh>(mesh)};
  if (!rest->triangles.empty()) pieces.rest = std::move(rest);
  return pieces;
}

}  // namespace hires::geometry
