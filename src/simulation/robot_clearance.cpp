#include "hires/simulation/robot_clearance.h"

#include <algorithm>

namespace hires::simulation {

std::optional<RobotClearance::Prism> RobotClearance::MakePrism(const std::string& name,
                                                               const geometry::Collision& shape,
                                                               const geometry::Pose3& X_WB) {
  const geometry::Pose3 X_WS = X_WB * shape.X_BS;
  const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_WS);
  const auto outline =
      geometry::OutlineInBand(shape.shape, X_WS, bounds.lower.z(), bounds.upper.z());
  if (!outline) return std::nullopt;
  Prism prism{name, *outline, bounds.lower.z(), bounds.upper.z(), {0.0, 0.0}, 0.0};
  for (const Eigen::Vector2d& p : *outline) prism.centre += p / outline->size();
  for (const Eigen::Vector2d& p : *outline) {
    prism.radius = std::max(prism.radius, (p - prism.centre).norm());
  }
  return prism;
}

RobotClearance::RobotClearance(const std::vector<geometry::Collision>& robot_B,
                               const world::World& world) {
  for (const geometry::Collision& part : robot_B) {
    if (auto prism = MakePrism(part.name, part, {})) {
      robot_radius_ = std::max(robot_radius_, geometry::CircumscribedRadius(prism->outline));
      robot_.push_back(*std::move(prism));
    }
  }
  for (const world::StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      if (auto prism = MakePrism(body.name, shape, body.X_MB)) {
        obstacles_.push_back(*std::move(prism));
      }
    }
  }
}

template <typename Visit>
void RobotClearance::ForNearPairs(const geometry::Pose2& X_MB, double limit, Visit visit) const {
  for (const Prism& obstacle : obstacles_) {
    const double reach = robot_radius_ + obstacle.radius + limit;
    if ((obstacle.centre - X_MB.position()).squaredNorm() > reach * reach) continue;
    for (const Prism& part : robot_) {
      if (part.z_min > obstacle.z_max || obstacle.z_min > part.z_max) continue;
      const double near = part.radius + obstacle.radius + limit;
      if ((X_MB * part.centre - obstacle.centre).squaredNorm() > near * near) continue;
      const double distance =
          geometry::Distance(geometry::Transformed(X_MB, part.outline), obstacle.outline);
      if (distance <= limit && !visit(part, obstacle, distance)) return;
    }
  }
}

std::optional<RobotContact> RobotClearance::FindContact(const geometry::Pose2& X_MB) const {
  std::optional<RobotContact> contact;
  ForNearPairs(X_MB, 0.0, [&](const Prism& part, const Prism& obstacle, double) {
    contact = RobotContact{part.name, obstacle.name};
    return false;
  });
  return contact;
}

double RobotClearance::Clearance(const geometry::Pose2& X_MB, double limit) const {
  double nearest = limit;
  ForNearPairs(X_MB, limit, [&](const Prism&, const Prism&, double distance) {
    nearest = std::min(nearest, distance);
    return true;
  });
  return nearest;
}

}  // namespace hires::simulation
