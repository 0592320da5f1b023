#include "hires/robot/tray.h"

#include "hires/geometry/bearing_face.h"

namespace hires::robot {

std::optional<geometry::Aabb> TrayPlateOf(const Robot& robot) {
  const auto link = robot.model.FindLink(robot.profile.tray_link);
  if (!link) return std::nullopt;
  std::optional<geometry::Aabb> plate;
  double largest = 0.0;
  for (const geometry::Collision& collision : robot.model.links[*link].collisions) {
    const geometry::Aabb bounds = geometry::BearingBounds(collision.shape, collision.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    if (size.x() * size.y() <= largest) continue;
    largest = size.x() * size.y();
    plate = bounds;
  }
  return plate;
}

bool IsOverPlate(const geometry::Aabb& plate_T, const Eigen::Vector3d& p_T) {
  constexpr double kBeside = 0.02, kBelow = 0.05, kAbove = 0.10;  // [m]
  return p_T.x() >= plate_T.lower.x() - kBeside && p_T.x() <= plate_T.upper.x() + kBeside &&
         p_T.y() >= plate_T.lower.y() - kBeside && p_T.y() <= plate_T.upper.y() + kBeside &&
         p_T.z() >= plate_T.upper.z() - kBelow && p_T.z() <= plate_T.upper.z() + kAbove;
}

}  // namespace hires::robot
