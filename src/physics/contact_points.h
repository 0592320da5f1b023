#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::physics {

/// One point at which shape A touches shape B. World frame.
struct ContactPoint {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit, out of B into A
  double depth;              ///< [m] how far A would have to move along the normal to be free; >= 0
};

/// The contact points of one pair of shapes, in an order that depends on the pair's geometry only.
class ContactList {
 public:
  static constexpr int kCapacity = 32;
  static constexpr int kAtMost = 8;  ///< what Reduce() leaves

  void Add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double depth);
  /// Keeps the deepest point and those that spread farthest around it, at most kAtMost.
  void Reduce();
  void FlipNormals();  ///< as if A and B were swapped
  void Clear() { size_ = 0; }

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const ContactPoint& operator[](int index) const { return points_[index]; }
  const ContactPoint* begin() const { return points_.data(); }
  const ContactPoint* end() const { return points_.data() + size_; }

 private:
  std::array<ContactPoint, kCapacity> points_;
  int size_{0};
};

/// A solid cylinder somewhere in the world.
struct PlacedCylinder {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d axis;    ///< unit
  double radius;           ///< [m]
  double half_length;      ///< [m]
};

/// A solid box somewhere in the world.
struct PlacedBox {
  Eigen::Vector3d centre;     ///< [m]
  Eigen::Matrix3d R_WB;       ///< its columns are the edges' directions
  Eigen::Vector3d half_size;  ///< [m]
};

/// A flat face with solid matter behind it. It reaches `half_u` and `half_v` along its own axes,
/// or, where `disc_radius` is positive, that far all around, or, where there are corners, it is the
/// convex polygon between them. Infinite extents make a half space.
struct FlatFace {
  Eigen::Vector3d centre;                  ///< [m]
  Eigen::Vector3d u;                       ///< unit, in the face
  Eigen::Vector3d v;                       ///< unit, in the face; u x v = normal
  Eigen::Vector3d normal;                  ///< unit, out of the solid
  double half_u;                           ///< [m]
  double half_v;                           ///< [m]
  double disc_radius{0.0};                 ///< [m]
  std::vector<Eigen::Vector2d> corners{};  ///< [m] along u and v, counter-clockwise
};

/// The half space z <= 0 of the world.
FlatFace FloorFace();

/// Adds the points at which a cylinder (A) stands, leans, or lies on a face (B): points of the
/// lower rim of which one is the lowest and, where `lean` is not zero, one lies in that direction;
/// the upper rim's lowest point; and where the cylinder reaches beyond the face, the points at
/// which the face's border cuts it. Only points with depth >= 0.
/// @param lean  Direction in which the cylinder is about to tip, world axes; any length.
void AddCylinderOnFace(const PlacedCylinder& cylinder, const FlatFace& face,
                       const Eigen::Vector3d& lean, ContactList* contacts);

/// A face is preferred to an edge by this much [m], so that a body standing near the border of a
/// plate stands on the plate.
inline constexpr double kFacePreference = 1e-3;

/// A face of A takes the place of B's only if its way out is shorter by this much [m]: rounding
/// does not choose.
inline constexpr double kSameFace = 1e-6;
/// Edges whose directions differ by a sine below this are parallel: between such, faces decide.
inline constexpr double kParallel = 1e-5;

/// An edge somewhere in the world, or in a frame that both edges share.
struct PlacedEdge {
  Eigen::Vector3d middle;  ///< [m]
  Eigen::Vector3d along;   ///< unit
  double half_length;      ///< [m]
};

/// Halfway between the points at which two edges are nearest to each other. @pre not parallel
Eigen::Vector3d BetweenEdges(const PlacedEdge& a, const PlacedEdge& b);

/// What the quick look at two shapes says.
enum class QuickLook {
  kApart,      ///< they do not touch
  kOnFace,     ///< a cylinder on a flat face: the contact points were added
  kUndecided,  ///< an edge or a corner may be involved: somebody else must look
};

/// How far a cylinder reaches along a direction from its centre [m].
/// @param axis_component  of the direction (a unit) along the cylinder's axis
double ReachAlong(double axis_component, const PlacedCylinder& cylinder);

/// A is the cylinder, B the box.
QuickLook AddCylinderOnBox(const PlacedCylinder& cylinder, const PlacedBox& box,
                           const Eigen::Vector3d& lean, ContactList* contacts);

/// A and B are cylinders; decided only where they stand on each other or are clearly apart.
QuickLook AddCylinderOnCylinder(const PlacedCylinder& a, const PlacedCylinder& b,
                                const Eigen::Vector3d& lean, ContactList* contacts);

}  // namespace hires::physics
