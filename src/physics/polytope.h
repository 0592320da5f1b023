#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "hires/geometry/shape.h"
#include "physics/contact_points.h"

namespace hires::physics {

/// A convex solid with flat faces, in its own frame.
struct Polytope {
  struct Face {
    Eigen::Vector3d normal;    ///< unit, outwards
    double offset;             ///< [m] the solid has normal . p <= offset
    std::vector<int> corners;  ///< indices of vertices, counter-clockwise seen from outside
  };
  struct Edge {
    int from, to;              ///< indices of vertices
    std::array<int, 2> faces;  ///< that meet in it: on its left and on its right
  };
  std::vector<Eigen::Vector3d> vertices;  ///< [m]
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

Polytope PolytopeOf(const geometry::Box& box);

/// The solid within a mesh: triangles of one plane are one face.
/// @return null if the mesh is not convex, not closed, not counter-clockwise seen from outside, or
/// has more than 64 faces.
std::unique_ptr<const Polytope> PolytopeOf(const geometry::TriangleMesh& mesh);

/// A polytope somewhere in the world. It does not own its solid.
struct PlacedPolytope {
  const Polytope* solid;
  Eigen::Vector3d centre;  ///< [m] the solid's origin
  Eigen::Matrix3d R_WB;
};

/// Adds where two polytopes (A and B) touch, by separating axes: across the face of least overlap
/// the corners of the other one's facing face, clipped to it, or one point of two edges.
/// @return whether they touch.
bool AddPolytopeOnPolytope(const PlacedPolytope& a, const PlacedPolytope& b, ContactList* contacts);

/// A is the cylinder, B the polytope.
QuickLook AddCylinderOnPolytope(const PlacedCylinder& cylinder, const PlacedPolytope& polytope,
                                const Eigen::Vector3d& lean, ContactList* contacts);

}  // namespace hires::physics
