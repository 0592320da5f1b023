#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// A shape of a tray from above.
struct TrayShape {
  const geometry::Collision* shape{nullptr};
  geometry::Aabb bounds;  ///< geometry::BearingBounds
  double area{0.0};       ///< [m^2] of these from above
};
/// The largest of them, as rims are smaller; the first of equal ones. Its shape is null where there
/// is none.
TrayShape LargestFromAbove(const std::vector<geometry::Collision>& shapes_L,
                           const geometry::Pose3& X_WL);

/// The plate that things stand on, in the tray link's frame: the largest of its collision shapes
/// from above, as rims are smaller. Nothing where the robot has no tray, or one without shapes.
std::optional<geometry::Aabb> TrayPlateOf(const Robot& robot);

/// Whether a thing's origin is where it would be, were it standing on the plate; a little beside
/// and above it included.  @param p_T  [m] in the tray link's frame.
bool IsOverPlate(const geometry::Aabb& plate_T, const Eigen::Vector3d& p_T);

}  // namespace hires::robot
