#include "hires/geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"
#include "hires/geometry/segment.h"

namespace hires::geometry {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double DistanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b) {
  return (p - a - NearestShare(p, a, b) * (b - a)).norm();
}

/// Is there a line along an edge of `a` with all of `b` on its far side?
bool SomeEdgeSeparates(const Polygon& a, const Polygon& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d& from = a[i];
    const Eigen::Vector2d along = a[(i + 1) % a.size()] - from;
    if (std::all_of(b.begin(), b.end(),
                    [&](const Eigen::Vector2d& p) { return Cross(along, p - from) < 0.0; })) {
      return true;
    }
  }
  return false;
}

/// The shortest shift of `other` out of `polygon` along the normal of one of its edges; zero where
/// an edge parts them already.
Eigen::Vector2d ShiftOutOf(const Polygon& polygon, const Polygon& other) {
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Eigen::Vector2d outwards = Eigen::Vector2d(along.y(), -along.x()).normalized();
    double depth = 0.0;
    for (const Eigen::Vector2d& p : other) depth = std::max(depth, outwards.dot(polygon[i] - p));
    if (depth >= least) continue;
    least = depth;
    shift = depth * outwards;
  }
  return shift;
}

double CornersToEdges(const Polygon& corners, const Polygon& edges) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : corners) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      nearest = std::min(nearest, DistanceToSegment(p, edges[i], edges[(i + 1) % edges.size()]));
    }
  }
  return nearest;
}

}  // namespace

Polygon ConvexHull(std::vector<Eigen::Vector2d> points) {
  HIRES_CHECK(points.size() >= 3, "a hull needs at least three points");
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Polygon hull;
  const auto extend = [&hull](const Eigen::Vector2d& p, std::size_t keep) {
    while (hull.size() >= keep + 2 &&
           Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Eigen::Vector2d& p : points) extend(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) extend(*p, lower);
  hull.pop_back();
  HIRES_CHECK(hull.size() >= 3, "the points of a hull lie on one line");
  return hull;
}

Rectangle SmallestRectangle(const Polygon& polygon) {
  HIRES_CHECK(polygon.size() >= 3, "a polygon has three corners");
  Rectangle best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Pose2 X_PE{0.0, 0.0, std::atan2(along.y(), along.x())};
    const Polygon turned = Transformed(X_PE.Inverse(), polygon);
    Eigen::Vector2d lower = turned[0], upper = turned[0];
    for (const Eigen::Vector2d& p : turned) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    const Eigen::Vector2d size = upper - lower, middle = 0.5 * (lower + upper);
    if (size.prod() >= least) continue;
    least = size.prod();
    best = {X_PE * Pose2{middle.x(), middle.y(), 0.0}, size};
  }
  return best;
}

Polygon CornersOf(const Rectangle& rectangle) {
  const Eigen::Vector2d h = 0.5 * rectangle.size;
  return Transformed(rectangle.X_PR, {-h, {h.x(), -h.y()}, h, {-h.x(), h.y()}});
}

Polygon Transformed(const Pose2& X_AB, const Polygon& polygon_B) {
  const double c = std::cos(X_AB.yaw), s = std::sin(X_AB.yaw);
  Polygon polygon_A;
  polygon_A.reserve(polygon_B.size());
  for (const Eigen::Vector2d& p : polygon_B) {
    polygon_A.emplace_back(X_AB.x + c * p.x() - s * p.y(), X_AB.y + s * p.x() + c * p.y());
  }
  return polygon_A;
}

Polygon Padded(const Polygon& polygon, double padding) {
  Polygon padded = polygon;
  for (Eigen::Vector2d& p : padded) {
    for (int axis = 0; axis < 2; ++axis) {
      if (p[axis] != 0.0) p[axis] += std::copysign(padding, p[axis]);
    }
  }
  return padded;
}

bool Contains(const Polygon& polygon, const Eigen::Vector2d& point) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& from = polygon[i];
    if (Cross(polygon[(i + 1) % polygon.size()] - from, point - from) < 0.0) return false;
  }
  return true;
}

double Distance(const Polygon& a, const Polygon& b) {
  if (!SomeEdgeSeparates(a, b) && !SomeEdgeSeparates(b, a)) return 0.0;
  return std::min(CornersToEdges(a, b), CornersToEdges(b, a));
}

Eigen::Vector2d PartingShift(const Polygon& a, const Polygon& b) {
  const Eigen::Vector2d out_of_b = ShiftOutOf(b, a);
  const Eigen::Vector2d out_of_a = ShiftOutOf(a, b);
  if (out_of_a.squaredNorm() < out_of_b.squaredNorm()) return -out_of_a;
  return out_of_b;
}

double InscribedRadius(const Polygon& polygon) {
  return CornersToEdges({Eigen::Vector2d::Zero()}, polygon);
}

double CircumscribedRadius(const Polygon& polygon) {
  double farthest = 0.0;
  for (const Eigen::Vector2d& p : polygon) farthest = std::max(farthest, p.norm());
  return farthest;
}

}  // namespace hires::geometry
