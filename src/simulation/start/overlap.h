#pragma once

#include <vector>

#include "hires/geometry/shape.h"

namespace hires::simulation {

constexpr double kStartSlack = 0.005;  ///< [m] bodies may overlap this much at the start

/// Does a shape of `a` reach more than the slack into a shape of `b`? Shapes count as upright
/// prisms, as in RobotClearance; meshes as their triangles and what closed surfaces
/// hold, as what they go round is free.
bool Overlap(const std::vector<geometry::Collision>& a, const geometry::Pose3& X_MA,
             const std::vector<geometry::Collision>& b, const geometry::Pose3& X_MB);

}  // namespace hires::simulation
