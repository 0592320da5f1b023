#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "physics/polytope.h"

namespace hires::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A polytope's vertices and normals in the frame of another one.
struct Seen {
  std::vector<Vector3d> vertices, normals;

  Seen(const Polytope& solid, const Matrix3d& R, const Vector3d& p) {
    vertices.reserve(solid.vertices.size());
    for (const Vector3d& vertex : solid.vertices) vertices.push_back(p + R * vertex);
    normals.reserve(solid.faces.size());
    for (const Polytope::Face& face : solid.faces) normals.push_back(R * face.normal);
  }
};

struct FaceChoice {
  double overlap{std::numeric_limits<double>::infinity()};  ///< [m], negative: apart
  int face{0};
};

/// The face of `solid` across which the other one, seen in its frame, overlaps it least.
FaceChoice LeastFace(const Polytope& solid, const std::vector<Vector3d>& other) {
  FaceChoice least;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const Polytope::Face& face = solid.faces[f];
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vector3d& vertex : other) lowest = std::min(lowest, face.normal.dot(vertex));
    const double overlap = face.offset - lowest;
    if (overlap < least.overlap) least = {overlap, static_cast<int>(f)};
    if (overlap < 0.0) break;
  }
  return least;
}

struct EdgeChoice {
  double overlap{std::numeric_limits<double>::infinity()};  ///< [m]
  const Polytope::Edge* edge_a{nullptr};
  const Polytope::Edge* edge_b{nullptr};
  Vector3d normal;  ///< out of B into A, B's frame
};

/// Whether two edges make a face of the Minkowski difference B - A: the arcs between the normals of
/// the faces that meet in them cross on the unit sphere. A's normals are given negated. See Dirk
/// Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013.
bool ArcsCross(const Vector3d& a1, const Vector3d& a2, const Vector3d& b1, const Vector3d& b2) {
  const Vector3d a = a1.cross(a2), b = b1.cross(b2);
  const double b1_side = b1.dot(a), b2_side = b2.dot(a);
  const double a1_side = a1.dot(b), a2_side = a2.dot(b);
  return b1_side * b2_side < 0.0 && a1_side * a2_side < 0.0 && b1_side * a2_side > 0.0;
}

EdgeChoice LeastEdges(const Polytope& a, const Seen& a_in_b, const Polytope& b) {
  EdgeChoice least;
  for (const Polytope::Edge& edge_a : a.edges) {
    const Vector3d& from_a = a_in_b.vertices[edge_a.from];
    const Vector3d along_a = (a_in_b.vertices[edge_a.to] - from_a).normalized();
    const Vector3d left = -a_in_b.normals[edge_a.faces[0]];
    const Vector3d right = -a_in_b.normals[edge_a.faces[1]];
    for (const Polytope::Edge& edge_b : b.edges) {
      const Vector3d& left_b = b.faces[edge_b.faces[0]].normal;
      const Vector3d& right_b = b.faces[edge_b.faces[1]].normal;
      if (!ArcsCross(left, right, left_b, right_b)) continue;
      const Vector3d& from_b = b.vertices[edge_b.from];
      Vector3d way = along_a.cross((b.vertices[edge_b.to] - from_b).normalized());
      const double length = way.norm();
      if (length < kParallel) continue;
      way /= length;
      if (way.dot(left_b + right_b) < 0.0) way = -way;
      const double overlap = way.dot(from_b - from_a);
      if (overlap < least.overlap) least = {overlap, &edge_a, &edge_b, way};
    }
  }
  return least;
}

/// Keeps what of a polygon has normal . p <= offset.
std::vector<Vector3d> Clipped(const std::vector<Vector3d>& polygon, const Vector3d& normal,
                              double offset) {
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& from = polygon[i];
    const Vector3d& to = polygon[(i + 1) % polygon.size()];
    const double beyond_from = normal.dot(from) - offset, beyond_to = normal.dot(to) - offset;
    if (beyond_from <= 0.0) kept.push_back(from);
    if ((beyond_from < 0.0 && beyond_to > 0.0) || (beyond_from > 0.0 && beyond_to < 0.0)) {
      kept.push_back(from + beyond_from / (beyond_from - beyond_to) * (to - from));
    }
  }
  return kept;
}

/// The points of `other`, seen in the reference's frame, below one of the reference's faces.
/// @param sign  1 if the contacts' normal is the face's, -1 if it is against it
void AddFaceContacts(const PlacedPolytope& reference, int face_index, const Polytope& other,
                     const Seen& seen, double sign, ContactList* contacts) {
  const Polytope::Face& face = reference.solid->faces[face_index];
  std::size_t facing = 0;  // the face of `other` that looks into the reference most squarely
  for (std::size_t f = 1; f < seen.normals.size(); ++f) {
    if (seen.normals[f].dot(face.normal) < seen.normals[facing].dot(face.normal)) facing = f;
  }
  std::vector<Vector3d> polygon;
  for (const int corner : other.faces[facing].corners) polygon.push_back(seen.vertices[corner]);
  const std::vector<Vector3d>& vertices = reference.solid->vertices;
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vector3d& from = vertices[face.corners[i]];
    const Vector3d& to = vertices[face.corners[(i + 1) % face.corners.size()]];
    const Vector3d outwards = (to - from).cross(face.normal).normalized();
    polygon = Clipped(polygon, outwards, outwards.dot(from));
  }
  const Vector3d normal = sign * (reference.R_WB * face.normal);
  for (const Vector3d& corner : polygon) {
    const double depth = face.offset - face.normal.dot(corner);
    if (depth >= 0.0) {
      contacts->Add(reference.centre + reference.R_WB * corner, normal, depth);
    }
  }
}

PlacedEdge EdgeBetween(const std::vector<Vector3d>& vertices, const Polytope::Edge& edge) {
  const Vector3d& from = vertices[edge.from];
  const Vector3d way = vertices[edge.to] - from;
  return {from + 0.5 * way, way.normalized(), 0.5 * way.norm()};
}

void AddEdgeContact(const EdgeChoice& edges, const Seen& a_in_b, const PlacedPolytope& b,
                    ContactList* contacts) {
  const Vector3d at = BetweenEdges(EdgeBetween(a_in_b.vertices, *edges.edge_a),
                                   EdgeBetween(b.solid->vertices, *edges.edge_b));
  contacts->Add(b.centre + b.R_WB * at, b.R_WB * edges.normal, edges.overlap);
}

/// Overlap of a cylinder and a polytope, seen in the polytope's frame, along a unit direction.
double OverlapAlong(const Vector3d& way, const Vector3d& centre, double reach,
                    const std::vector<Vector3d>& vertices) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Vector3d& vertex : vertices) {
    lowest = std::min(lowest, way.dot(vertex));
    highest = std::max(highest, way.dot(vertex));
  }
  const double at = way.dot(centre);
  return std::min(highest - (at - reach), at + reach - lowest);
}

/// Least overlap along the cylinder's axis and square to it and one of the edges: those ways out
/// that are no face's normal. Negative: apart.
double LeastEdgeOverlap(const Polytope& solid, const Vector3d& centre, const Vector3d& axis,
                        const PlacedCylinder& cylinder) {
  double least = OverlapAlong(axis, centre, cylinder.half_length, solid.vertices);
  for (const Polytope::Edge& edge : solid.edges) {
    const Vector3d along = (solid.vertices[edge.to] - solid.vertices[edge.from]).normalized();
    const Vector3d way = along.cross(axis);
    const double length = way.norm();
    if (length < 1e-6) continue;
    least = std::min(least, OverlapAlong(way / length, centre, cylinder.radius, solid.vertices));
  }
  return least;
}

FlatFace FaceOf(const PlacedPolytope& polytope, const Polytope::Face& face) {
  const std::vector<Vector3d>& vertices = polytope.solid->vertices;
  const Vector3d& first = vertices[face.corners[0]];
  const Vector3d u = (vertices[face.corners[1]] - first).normalized();
  const Vector3d v = face.normal.cross(u);
  FlatFace flat;
  flat.centre = polytope.centre + polytope.R_WB * first;
  flat.u = polytope.R_WB * u;
  flat.v = polytope.R_WB * v;
  flat.normal = polytope.R_WB * face.normal;
  flat.half_u = flat.half_v = 0.0;
  for (const int corner : face.corners) {
    const Vector3d p = vertices[corner] - first;
    flat.corners.emplace_back(u.dot(p), v.dot(p));
  }
  return flat;
}

}  // namespace

QuickLook AddCylinderOnPolytope(const PlacedCylinder& cylinder, const PlacedPolytope& polytope,
                                const Vector3d& lean, ContactList* contacts) {
  const Vector3d centre = polytope.R_WB.transpose() * (cylinder.centre - polytope.centre);
  const Vector3d axis = polytope.R_WB.transpose() * cylinder.axis;
  const Polytope& solid = *polytope.solid;
  double least = std::numeric_limits<double>::infinity();
  const Polytope::Face* nearest = nullptr;
  for (const Polytope::Face& face : solid.faces) {
    const double overlap =
        face.offset + ReachAlong(face.normal.dot(axis), cylinder) - face.normal.dot(centre);
    if (overlap < 0.0) return QuickLook::kApart;
    if (overlap >= least) continue;
    least = overlap;
    nearest = &face;
  }
  const double edges = LeastEdgeOverlap(solid, centre, axis, cylinder);
  if (edges < 0.0) return QuickLook::kApart;
  if (least > edges + kFacePreference) return QuickLook::kUndecided;
  const int before = contacts->size();
  AddCylinderOnFace(cylinder, FaceOf(polytope, *nearest), lean, contacts);
  return contacts->size() > before ? QuickLook::kOnFace : QuickLook::kUndecided;
}

bool AddPolytopeOnPolytope(const PlacedPolytope& a, const PlacedPolytope& b,
                           ContactList* contacts) {
  const Matrix3d R_BA = b.R_WB.transpose() * a.R_WB;
  const Vector3d p_BA = b.R_WB.transpose() * (a.centre - b.centre);
  const Seen a_in_b(*a.solid, R_BA, p_BA);
  const FaceChoice face_b = LeastFace(*b.solid, a_in_b.vertices);
  if (face_b.overlap < 0.0) return false;
  const Seen b_in_a(*b.solid, R_BA.transpose(), -(R_BA.transpose() * p_BA));
  const FaceChoice face_a = LeastFace(*a.solid, b_in_a.vertices);
  if (face_a.overlap < 0.0) return false;
  const EdgeChoice edges = LeastEdges(*a.solid, a_in_b, *b.solid);
  if (edges.overlap < 0.0) return false;
  const int before = contacts->size();
  if (std::min(face_a.overlap, face_b.overlap) <= edges.overlap + kFacePreference) {
    if (face_a.overlap < face_b.overlap - kSameFace) {
      AddFaceContacts(a, face_a.face, *b.solid, b_in_a, -1.0, contacts);
    } else {
      AddFaceContacts(b, face_b.face, *a.solid, a_in_b, 1.0, contacts);
    }
  }
  if (contacts->size() == before && edges.edge_a != nullptr) {
    AddEdgeContact(edges, a_in_b, b, contacts);
  }
  return contacts->size() > before;
}

}  // namespace hires::physics
