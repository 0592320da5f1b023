#include "robot/urdf/seen_beyond.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "hires/base/short_text.h"
#include "hires/geometry/segment.h"
#include "hires/robot/link_bounds.h"
#include "robot/urdf/seen_shapes.h"

namespace hires::robot {
namespace {

using Bounds = std::vector<geometry::Aabb>;  // LinkBounds

constexpr std::size_t kMostSeenNames = 6;
constexpr double kSeenBeyond = 0.05;  // [m] that what is only seen may reach beyond what collides

/// [m] 0 inside.
double DistanceTo(const geometry::Polygon& outline, const Eigen::Vector2d& p) {
  if (geometry::Contains(outline, p)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& next = outline[i + 1 == outline.size() ? 0 : i + 1];
    nearest = std::min(nearest, (p - geometry::NearestOnSegment(p, outline[i], next)).norm());
  }
  return nearest;
}

/// [m] beyond the footprint, below its top, or above `top`, whichever is more.
double ReachBeyond(const Robot& robot, const SeenShape& seen, const geometry::Pose3& X_BL,
                   double top) {
  const geometry::Pose3 X_BS = X_BL * seen.X_LS;
  geometry::Polygon corners;
  double upper = X_BS.translation.z();
  if (seen.shape) {
    corners = geometry::OutlineInBand(*seen.shape, X_BS, 0.0, kFootprintTop)
                  .value_or(geometry::Polygon());
    upper = geometry::BoundsOf(*seen.shape, X_BS).upper.z();
  } else if (upper >= 0.0 && upper <= kFootprintTop) {
    corners = {X_BS.translation.head<2>()};
  }
  double farthest = upper - top;
  for (const Eigen::Vector2d& p : corners)
    farthest = std::max(farthest, DistanceTo(robot.profile.footprint, p));
  return farthest;
}

/// [m^2] Of what collides of a link, seen from above.
double AreaOf(const geometry::Aabb& box) {
  const Eigen::Vector3d size =
      (box.upper - box.lower).cwiseMax(0.0);  // 0 of one with nothing in it
  return size.x() * size.y();
}

/// Whether a link is fixed to the base, and so is nothing that collides, or no more than a sensor
/// or a token: less than a quarter of what collides of the whole robot, seen from above. A share of
/// it, as the laser of a car is no token by its size, and yet hides nothing of the car's body.
std::vector<bool> OfAnUncoveredBase(const RobotModel& model, const Bounds& bounds, int base) {
  constexpr double kCovering = 0.25;
  std::vector<int> group(model.links.size(), 0);  // link that all links fixed to it share
  for (std::size_t i = 1; i < group.size(); ++i) {
    const Joint& joint = *model.links[i].joint;
    group[i] = joint.type == JointType::kFixed ? group[joint.parent] : static_cast<int>(i);
  }
  std::vector<bool> uncovered(group.size(), false);
  geometry::Aabb all;
  double area = 0.0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    all.Include(bounds[i]);
    if (group[i] == group[base]) area += AreaOf(bounds[i]);
  }
  if (area > kCovering * AreaOf(all)) return uncovered;
  for (std::size_t i = 0; i < group.size(); ++i) uncovered[i] = group[i] == group[base];
  return uncovered;
}

/// Whether nothing of a link collides, or only a token that keeps a simulator quiet. By its size
/// and not by a share: a wheel or a laser is a small share of its robot, and its shape is that of
/// all of it.
bool HasTokenAtMost(const geometry::Aabb& box) {
  constexpr double kToken = 0.1;  // [m] in all directions
  return (box.upper - box.lower).maxCoeff() < kToken;
}

}  // namespace

std::string SeenText(const Robot& robot, const Bounds& bounds, const std::string& urdf_xml,
                     const std::string& urdf_path) {
  const RobotModel& model = robot.model;
  const auto X_R = ForwardKinematics(model, robot.profile.joints);
  const int base = *model.FindLink(robot.profile.base_link);
  geometry::Aabb all;
  for (const geometry::Aabb& of_one : bounds) all.Include(of_one);
  const double top = HasShapes(model) ? all.upper.z() : kFootprintTop;
  const std::vector<bool> is_of_base = OfAnUncoveredBase(model, bounds, base);
  const auto seen = ShapesSeen(urdf_xml);
  LookMeshes meshes(std::filesystem::path(urdf_path).parent_path());
  std::vector<std::string> names;
  const std::string unread = "as their meshes cannot be read or are large";
  std::string farthest = "how far is not known, " + unread;
  bool is_any_unread = false;
  double most = 0.0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto shapes = seen.find(model.links[i].name);
    if (shapes == seen.end()) continue;
    bool counts = false;
    for (SeenShape shape : shapes->second) {
      if (!shape.shape && !HasTokenAtMost(bounds[i])) continue;
      if (!shape.shape) shape.shape = meshes.Read(shape);
      const double beyond = ReachBeyond(robot, shape, X_R[base].Inverse() * X_R[i], top);
      const bool is_unread = !shape.shape && (beyond > kSeenBeyond || is_of_base[i]);
      counts = counts || beyond > kSeenBeyond || is_unread;
      is_any_unread = is_any_unread || is_unread;
      if (beyond <= std::max(most, kSeenBeyond)) continue;
      most = beyond;
      farthest = fmt::format("'{}' reaches {:.2f} m beyond its footprint or above its shapes",
                             model.links[i].name, beyond);
    }
    if (counts) names.push_back(model.links[i].name);
  }
  if (names.empty()) return "";
  if (is_any_unread && most > 0.0) farthest += ", and some may reach farther, " + unread;
  return fmt::format(
      "shapes: seen, but with no <collision> there, so that nothing touches them, are {}; {}; add "
      "<collision> shapes to the URDF, or a `footprint` in a profile that has room for them",
      base::FirstNames(names, kMostSeenNames), farthest);
}

}  // namespace hires::robot
