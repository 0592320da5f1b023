#include "hires/robot/link_bounds.h"

#include <algorithm>

namespace hires::robot {

using geometry::Pose3;

std::vector<geometry::Aabb> LinkBounds(const Robot& robot) {
  const std::vector<Pose3> X_R = ForwardKinematics(robot.model, robot.profile.joints);
  const Pose3 X_BR = X_R[*robot.model.FindLink(robot.profile.base_link)].Inverse();
  std::vector<geometry::Aabb> bounds(robot.model.links.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (const geometry::Collision& shape : robot.model.links[i].collisions)
      bounds[i].Include(geometry::BoundsOf(shape.shape, X_BR * (X_R[i] * shape.X_BS)));
  }
  return bounds;
}

std::string WidestLink(const Robot& robot, const std::vector<geometry::Aabb>& bounds) {
  double widest = 0.0;
  std::string link;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (robot.model.links[i].collisions.empty() || bounds[i].lower.z() > kFootprintTop) continue;
    const double side = std::max(-bounds[i].lower.y(), bounds[i].upper.y());
    if (side <= widest + 1e-6) continue;  // of equal ones the first
    widest = side;
    link = robot.model.links[i].name;
  }
  return link;
}

}  // namespace hires::robot
