#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hires/geometry/polygon.h"

namespace hires::test_support {

/// Distance [m] along a ray to the nearest outline; infinite where it passes all of them.
inline double RangeTo(const std::vector<geometry::Polygon>& outlines, const Eigen::Vector2d& from,
                      double angle) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const geometry::Polygon& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d a = outline[i], edge = outline[(i + 1) % outline.size()] - a;
      const double across = direction.x() * edge.y() - direction.y() * edge.x();
      if (std::abs(across) < 1e-12) continue;
      const Eigen::Vector2d to = a - from;
      const double range = (to.x() * edge.y() - to.y() * edge.x()) / across;
      const double share = (to.x() * direction.y() - to.y() * direction.x()) / across;
      if (range >= 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
    }
  }
  return nearest;
}

}  // namespace hires::test_support
