#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace hires::geometry {

/// Which share of the way from a to b the point of it has that lies nearest to p; 0 where a is b.
inline double NearestShare(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length_squared = along.squaredNorm();
  return length_squared > 0.0 ? std::clamp((p - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
}

inline Eigen::Vector2d NearestOnSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                        const Eigen::Vector2d& b) {
  return a + NearestShare(p, a, b) * (b - a);
}

}  // namespace hires::geometry
