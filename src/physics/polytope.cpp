#include "physics/polytope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hires::physics {
namespace {

using Eigen::Vector3d;

/// Pairs of edges are all looked at, so effort grows with the square.
constexpr std::size_t kMostFaces = 64;
/// Corners of files are rounded to single precision: what is flatter than this part of the solid's
/// size is flat.
constexpr double kFlat = 1e-6;

struct Plane {
  Vector3d normal;
  double offset;
};

/// The planes of a mesh's triangles, each once; empty if the mesh is not convex or has too many.
std::vector<Plane> PlanesOf(const geometry::TriangleMesh& mesh, double tolerance) {
  std::vector<Plane> planes;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d& corner = mesh.vertices[triangle[0]];
    const Vector3d across =
        (mesh.vertices[triangle[1]] - corner).cross(mesh.vertices[triangle[2]] - corner);
    const double length = across.norm();
    if (!(length > tolerance * tolerance)) continue;
    const Vector3d normal = across / length;
    const double offset = normal.dot(corner);
    bool is_new = true;
    for (const Plane& plane : planes) {
      bool is_in = true;
      for (const int index : triangle) {
        is_in &= std::abs(plane.normal.dot(mesh.vertices[index]) - plane.offset) <= tolerance;
      }
      if (is_in && plane.normal.dot(normal) > 0.5) is_new = false;
    }
    if (!is_new) continue;
    for (const Vector3d& vertex : mesh.vertices) {
      if (normal.dot(vertex) > offset + tolerance) return {};
    }
    planes.push_back({normal, offset});
    if (planes.size() > kMostFaces) return {};
  }
  return planes;
}

/// The corners of the convex polygon that the vertices in a plane span, counter-clockwise seen
/// against its normal; vertices between two corners are left out (Andrew's monotone chain).
std::vector<int> CornersIn(const Plane& plane, const std::vector<Vector3d>& vertices,
                           double tolerance) {
  const Vector3d u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  struct Point {
    double x, y;
    int index;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (std::abs(plane.normal.dot(vertices[i]) - plane.offset) > tolerance) continue;
    points.push_back({u.dot(vertices[i]), v.dot(vertices[i]), static_cast<int>(i)});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::make_pair(a.x, a.y) < std::make_pair(b.x, b.y);
  });
  const auto turns_left = [tolerance](const Point& a, const Point& b, const Point& c) {
    const double length = std::hypot(c.x - a.x, c.y - a.y);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > tolerance * length;
  };
  std::vector<Point> corners;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = corners.size();
    for (const Point& point : points) {
      while (corners.size() >= first + 2 &&
             !turns_left(corners[corners.size() - 2], corners.back(), point)) {
        corners.pop_back();
      }
      corners.push_back(point);
    }
    corners.pop_back();  // it begins the other half
    std::reverse(points.begin(), points.end());
  }
  std::vector<int> indices;
  for (const Point& corner : corners) indices.push_back(corner.index);
  return indices;
}

/// Pairs the borders of faces; false if one has no partner, as in a surface that is not closed.
bool AddEdges(Polytope* solid) {
  std::map<std::pair<int, int>, int> left_of;
  for (std::size_t f = 0; f < solid->faces.size(); ++f) {
    const std::vector<int>& corners = solid->faces[f].corners;
    if (corners.size() < 3) return false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::pair<int, int> way{corners[i], corners[(i + 1) % corners.size()]};
      if (!left_of.emplace(way, static_cast<int>(f)).second) return false;
    }
  }
  for (const auto& [way, face] : left_of) {
    const auto other = left_of.find({way.second, way.first});
    if (other == left_of.end()) return false;
    if (way.first < way.second) {
      solid->edges.push_back({way.first, way.second, {face, other->second}});
    }
  }
  return true;
}

/// Leaves out the vertices that are no corner of any face.
void KeepCorners(Polytope* solid) {
  std::vector<int> renamed(solid->vertices.size(), -1);
  std::vector<Vector3d> kept;
  for (Polytope::Face& face : solid->faces) {
    for (int& corner : face.corners) {
      if (renamed[corner] < 0) {
        renamed[corner] = static_cast<int>(kept.size());
        kept.push_back(solid->vertices[corner]);
      }
      corner = renamed[corner];
    }
  }
  solid->vertices = std::move(kept);
}

std::unique_ptr<const Polytope> Make(const std::vector<Plane>& planes,
                                     const std::vector<Vector3d>& vertices, double tolerance) {
  auto solid = std::make_unique<Polytope>();
  solid->vertices = vertices;
  for (const Plane& plane : planes) {
    solid->faces.push_back({plane.normal, plane.offset, CornersIn(plane, vertices, tolerance)});
  }
  KeepCorners(solid.get());
  if (solid->faces.size() < 4 || !AddEdges(solid.get())) return nullptr;
  return solid;
}

}  // namespace

Polytope PolytopeOf(const geometry::Box& box) {
  std::vector<Vector3d> vertices;
  for (int i = 0; i < 8; ++i) {
    const Vector3d signs(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    vertices.push_back(0.5 * signs.cwiseProduct(box.size));
  }
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      planes.push_back({sign * Vector3d::Unit(axis), 0.5 * box.size[axis]});
    }
  }
  return *Make(planes, vertices, kFlat * box.size.minCoeff());
}

std::unique_ptr<const Polytope> PolytopeOf(const geometry::TriangleMesh& mesh) {
  double reach = 0.0;
  for (const Vector3d& vertex : mesh.vertices) reach = std::max(reach, vertex.norm());
  const double tolerance = kFlat * reach;
  const std::vector<Plane> planes = PlanesOf(mesh, tolerance);
  return Make(planes, mesh.vertices, tolerance);
}

}  // namespace hires::physics
