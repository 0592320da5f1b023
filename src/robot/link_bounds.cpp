#include "hires/robot/link_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/text.h"

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

std::vector<std::string> LinksOpenAbove(const Robot& robot) {
  constexpr double kLeast = 0.1 - 1e-9, kLevel = 1e-6;  // [m]
  const std::vector<geometry::Aabb> bounds = LinkBounds(robot);
  const auto is_covered = [&](const geometry::Aabb& box) {
    const Eigen::Vector3d middle = 0.5 * (box.lower + box.upper);
    return std::any_of(bounds.begin(), bounds.end(), [&](const geometry::Aabb& other) {
      return other.upper.z() > box.upper.z() + kLevel && other.lower.x() <= middle.x() &&
             middle.x() <= other.upper.x() && other.lower.y() <= middle.y() &&
             middle.y() <= other.upper.y();
    });
  };
  std::vector<std::pair<double, std::string>> open;  // by area
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (robot.model.links[i].collisions.empty() || is_covered(bounds[i])) continue;
    const Eigen::Vector3d size = bounds[i].upper - bounds[i].lower;
    if (std::min(size.x(), size.y()) < kLeast) continue;
    open.emplace_back(size.x() * size.y(), robot.model.links[i].name);
  }
  std::stable_sort(open.begin(), open.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (auto& [area, name] : open) names.push_back(std::move(name));
  return names;
}

std::string NoTrayText(const Robot& robot) {
  constexpr std::size_t kMostNamed = 4;
  std::vector<std::string> open = LinksOpenAbove(robot);
  if (open.size() > kMostNamed) open.resize(kMostNamed);
  return fmt::format(
      "robot '{}' has no tray; name a tray_link in its profile, which "
      "`hires new robot` begins{}{}",
      robot.model.name, open.empty() ? "" : "; nothing is over the middle of ",
      base::Join(open, ", "));
}

}  // namespace hires::robot
