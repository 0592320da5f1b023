#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::geometry {

/// A convex outline in the plane [m], counter-clockwise, at least three corners.
using Polygon = std::vector<Eigen::Vector2d>;

/// The smallest convex polygon around the points (Andrew's monotone chain).
/// @pre at least three points that do not lie on one line.
Polygon ConvexHull(std::vector<Eigen::Vector2d> points);

/// A rectangle, by the pose of its middle and its edges along x and y [m].
struct Rectangle {
  Pose2 X_PR;
  Eigen::Vector2d size{0.0, 0.0};
};

/// The rectangle of least area around a convex polygon; one of its edges lies along one of the
/// polygon's [Freeman, Shapira 1975].
Rectangle SmallestRectangle(const Polygon& polygon);

Polygon CornersOf(const Rectangle& rectangle);

Polygon Transformed(const Pose2& X_AB, const Polygon& polygon_B);

/// Moves every corner away from the origin by `padding` in x and y, as costmap_2d pads footprints.
Polygon Padded(const Polygon& polygon, double padding);

bool Contains(const Polygon& polygon, const Eigen::Vector2d& point);  ///< boundary included

/// Distance between convex polygons [m]; 0 if they touch or overlap.
double Distance(const Polygon& a, const Polygon& b);

/// The shortest shift of `a` after which it only touches `b` [m]; zero where they are apart. By the
/// separating axis theorem: along the normal of an edge of one of them.
Eigen::Vector2d PartingShift(const Polygon& a, const Polygon& b);

double InscribedRadius(const Polygon& polygon);      ///< origin to the nearest edge [m]
double CircumscribedRadius(const Polygon& polygon);  ///< origin to the farthest corner [m]

}  // namespace hires::geometry
