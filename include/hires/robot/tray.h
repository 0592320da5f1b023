#pragma once

#include <Eigen/Core>
#include <optional>

#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// The plate that things stand on, in the tray link's frame: the largest of its collision shapes
/// from above, as rims are smaller. Nothing where the robot has no tray, or one without shapes.
std::optional<geometry::Aabb> TrayPlateOf(const Robot& robot);

/// Whether a thing's origin is where it would be, were it standing on the plate; a little beside
/// and above it included.  @param p_T  [m] in the tray link's frame.
bool IsOverPlate(const geometry::Aabb& plate_T, const Eigen::Vector3d& p_T);

}  // namespace hires::robot
