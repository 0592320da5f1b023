#include "physics/box_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hires::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The face of least overlap of one of both boxes.
struct FaceChoice {
  double overlap{std::numeric_limits<double>::infinity()};  ///< [m], negative: apart
  int axis{0};
};

/// @param p  the other box's centre in this one's frame.
/// @param R  the other box's axes in this one's frame.
FaceChoice LeastFace(const PlacedBox& box, const PlacedBox& other, const Vector3d& p,
                     const Matrix3d& R) {
  const Vector3d overlaps = box.half_size + R.cwiseAbs() * other.half_size - p.cwiseAbs();
  FaceChoice least;
  for (int i = 0; i < 3; ++i) {
    if (overlaps[i] < least.overlap) least = {overlaps[i], i};
  }
  return least;
}

/// The pair of edges of least overlap.
struct EdgeChoice {
  double overlap{std::numeric_limits<double>::infinity()};  ///< [m]
  int axis_a{-1}, axis_b{-1};
  Vector3d normal_B{Vector3d::Zero()};  ///< out of B into A
};

EdgeChoice LeastEdges(const PlacedBox& a, const PlacedBox& b, const Vector3d& p_BA,
                      const Matrix3d& R_BA) {
  EdgeChoice least;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Vector3d way = Vector3d::Unit(i).cross(R_BA.col(j));
      const double length = way.norm();
      if (length < kParallel) continue;
      way /= length;
      const double along = p_BA.dot(way);
      const double overlap = b.half_size.dot(way.cwiseAbs()) +
                             a.half_size.dot((R_BA.transpose() * way).cwiseAbs()) - std::abs(along);
      if (overlap >= least.overlap) continue;
      least = {overlap, j, i, along < 0.0 ? Vector3d(-way) : way};
    }
  }
  return least;
}

/// A convex polygon in the frame of a face: origin in its middle, z out of its box.
class Polygon {
 public:
  void Add(const Vector3d& corner) { corners_[size_++] = corner; }

  /// Keeps what has sign * p[axis] <= limit.
  void Clip(int axis, double sign, double limit) {
    const Polygon before = *this;
    size_ = 0;
    for (int i = 0; i < before.size_; ++i) {
      const Vector3d& from = before.corners_[i];
      const Vector3d& to = before.corners_[(i + 1) % before.size_];
      const double beyond_from = sign * from[axis] - limit, beyond_to = sign * to[axis] - limit;
      if (beyond_from <= 0.0) Add(from);
      if ((beyond_from < 0.0 && beyond_to > 0.0) || (beyond_from > 0.0 && beyond_to < 0.0)) {
        Add(from + beyond_from / (beyond_from - beyond_to) * (to - from));
      }
    }
  }

  const Vector3d* begin() const { return corners_.data(); }
  const Vector3d* end() const { return corners_.data() + size_; }

 private:
  std::array<Vector3d, 8> corners_;  // a rectangle clipped by a rectangle has no more
  int size_{0};
};

/// The points of `box` below a face of `reference` and within it.
/// @param sign    which of both faces across `axis`
/// @param normal  of the contacts, out of B into A
void AddFaceContacts(const PlacedBox& reference, int axis, double sign, const PlacedBox& box,
                     const Vector3d& normal, ContactList* contacts) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  Matrix3d R_WF;
  R_WF << reference.R_WB.col(next), sign * reference.R_WB.col(last),
      sign * reference.R_WB.col(axis);
  const Vector3d middle = reference.centre + reference.half_size[axis] * R_WF.col(2);
  const Matrix3d R = R_WF.transpose() * box.R_WB;
  const Vector3d centre = R_WF.transpose() * (box.centre - middle);
  int facing = 0;  // the face of `box` that looks into the reference most squarely
  R.row(2).cwiseAbs().maxCoeff(&facing);
  const double outward = R(2, facing) > 0.0 ? -1.0 : 1.0;
  const int u = (facing + 1) % 3, v = (facing + 2) % 3;
  const Vector3d face = centre + outward * box.half_size[facing] * R.col(facing);
  const Vector3d to_u = box.half_size[u] * R.col(u), to_v = box.half_size[v] * R.col(v);
  Polygon polygon;
  polygon.Add(face + to_u + to_v);
  polygon.Add(face - to_u + to_v);
  polygon.Add(face - to_u - to_v);
  polygon.Add(face + to_u - to_v);
  for (const double side : {-1.0, 1.0}) {
    polygon.Clip(0, side, reference.half_size[next]);
    polygon.Clip(1, side, reference.half_size[last]);
  }
  for (const Vector3d& corner : polygon) {
    if (corner.z() <= 0.0) contacts->Add(middle + R_WF * corner, normal, -corner.z());
  }
}

/// The edge along `axis` that lies farthest in the direction.
PlacedEdge FarthestEdge(const PlacedBox& box, int axis, const Vector3d& direction_W) {
  Vector3d middle = box.centre;
  for (int i = 0; i < 3; ++i) {
    if (i == axis) continue;
    middle += std::copysign(box.half_size[i], box.R_WB.col(i).dot(direction_W)) * box.R_WB.col(i);
  }
  return {middle, box.R_WB.col(axis), box.half_size[axis]};
}

void AddEdgeContact(const PlacedBox& a, const PlacedBox& b, const EdgeChoice& edges,
                    ContactList* contacts) {
  const Vector3d normal = b.R_WB * edges.normal_B;
  contacts->Add(
      BetweenEdges(FarthestEdge(a, edges.axis_a, -normal), FarthestEdge(b, edges.axis_b, normal)),
      normal, edges.overlap);
}

}  // namespace

bool AddBoxOnBox(const PlacedBox& a, const PlacedBox& b, ContactList* contacts) {
  const Matrix3d R_BA = b.R_WB.transpose() * a.R_WB;
  const Vector3d p_BA = b.R_WB.transpose() * (a.centre - b.centre);
  const FaceChoice face_b = LeastFace(b, a, p_BA, R_BA);
  if (face_b.overlap < 0.0) return false;
  const Vector3d p_AB = -(R_BA.transpose() * p_BA);
  const FaceChoice face_a = LeastFace(a, b, p_AB, R_BA.transpose());
  if (face_a.overlap < 0.0) return false;
  const EdgeChoice edges = LeastEdges(a, b, p_BA, R_BA);
  if (edges.overlap < 0.0) return false;
  const int before = contacts->size();
  const bool is_of_a = face_a.overlap < face_b.overlap - kSameFace;
  if (std::min(face_a.overlap, face_b.overlap) <= edges.overlap + kFacePreference) {
    if (is_of_a) {
      const double sign = p_AB[face_a.axis] < 0.0 ? -1.0 : 1.0;
      AddFaceContacts(a, face_a.axis, sign, b, -sign * a.R_WB.col(face_a.axis), contacts);
    } else {
      const double sign = p_BA[face_b.axis] < 0.0 ? -1.0 : 1.0;
      AddFaceContacts(b, face_b.axis, sign, a, sign * b.R_WB.col(face_b.axis), contacts);
    }
  }
  if (contacts->size() == before && edges.axis_a >= 0) AddEdgeContact(a, b, edges, contacts);
  return contacts->size() > before;
}

}  // namespace hires::physics
