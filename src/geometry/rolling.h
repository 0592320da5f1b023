#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// How a body rolls on level ground from where it lies.
enum class Rolling {
  kNot,         ///< it stands on a face, or would tip
  kAlongALine,  ///< square to a line on which it lies: a cylinder on its side, a log, a pipe
  kAllWays      ///< a ball
};

/// It rolls about an axis if its centre of mass stays as high over its lowest point, within 0.3 %,
/// while it turns by 0.3 rad either way. A mesh of facets so large that it stands on one does not.
/// @param p_BBcm  [m] its centre of mass.
/// @param R_WB    how it lies; z of W points up.
Rolling RollingOf(const std::vector<Collision>& shapes_B, const Eigen::Vector3d& p_BBcm,
                  const Eigen::Quaterniond& R_WB);

}  // namespace hires::geometry
