#include "hires/robot/tray.h"

#include "hires/geometry/bearing_face.h"

namespace hires::robot {

TrayShape LargestFromAbove(const std::vector<geometry::Collision>& shapes_L,
                           const geometry::Pose3& X_WL) {
  TrayShape largest;
  for (const geometry::Collision& shape : shapes_L) {
    const geometry::Aabb bounds = geometry::BearingBounds(shape.shape, X_WL * shape.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    const double area = size.x() * size.y();
    if (largest.shape == nullptr || area > largest.area) largest = {&shape, bounds, area};
  }
  return largest;
}

std::optional<geometry::Aabb> TrayPlateOf(const Robot& robot) {
  const auto link = robot.model.FindLink(robot.profile.tray_link);
  if (!link) return std::nullopt;
  const TrayShape plate = LargestFromAbove(robot.model.links[*link].collisions, {});
  return plate.area > 0.0 ? std::make_optional(plate.bounds) : std::nullopt;
}

bool IsOverPlate(const geometry::Aabb& plate_T, const Eigen::Vector3d& p_T) {
  constexpr double kBeside = 0.02, kBelow = 0.05, kAbove = 0.10;  // [m]
  return p_T.x() >= plate_T.lower.x() - kBeside && p_T.x() <= plate_T.upper.x() + kBeside &&
         p_T.y() >= plate_T.lower.y() - kBeside && p_T.y() <= plate_T.upper.y() + kBeside &&
         p_T.z() >= plate_T.upper.z() - kBelow && p_T.z() <= plate_T.upper.z() + kAbove;
}

}  // namespace hires::robot
