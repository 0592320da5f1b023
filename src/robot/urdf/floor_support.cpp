#include "robot/urdf/floor_support.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "hires/base/text.h"
#include "robot/base_height.h"

namespace hires::robot {
namespace {

using Eigen::Vector2d;
using geometry::Pose3;

using Poses = std::vector<Pose3>;  // X_BL, in the order of the model's links

constexpr double kLevelAxis = 0.1, kUprightAxis = 0.9;  // upward part of an axis
constexpr double kLargestWheel = 0.4;                   // [m] radius
constexpr double kLongestTrail = 0.2;                   // [m] from a caster's swivel to its wheels

double UpwardPart(const Link& link, const Pose3& X_BL) {
  return std::abs((X_BL.rotation * link.joint->axis).z());
}

bool IsWheel(const Link& link, const Pose3& X_BL) {
  if (!link.joint || link.joint->type != JointType::kContinuous || link.collisions.empty())
    return false;
  const double radius = X_BL.translation.z();
  if (UpwardPart(link, X_BL) > kLevelAxis || radius < kFloorSlack || radius > kLargestWheel)
    return false;
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : link.collisions)
    bounds.Include(geometry::BoundsOf(shape.shape, X_BL * shape.X_BS));
  const double off_axis = std::abs(bounds.lower.z() + bounds.upper.z() - 2.0 * radius);
  return off_axis <= 0.3 * radius && bounds.lower.z() <= 0.4 * radius;
}

bool IsHitch(const RobotModel& model, int link, const Poses& X_B) {
  const auto& joint = model.links[link].joint;
  if (!joint || joint->type == JointType::kFixed || joint->type == JointType::kPrismatic)
    return false;
  Vector2d sum = Vector2d::Zero();
  double num_wheels = 0.0, radius = 0.0;
  for (int i = link + 1; i < static_cast<int>(model.links.size()); ++i) {
    if (!IsBelow(model, i, link) || !IsWheel(model.links[i], X_B[i])) continue;
    sum += X_B[i].translation.head<2>();
    radius = std::max(radius, X_B[i].translation.z());
    num_wheels += 1.0;
  }
  if (num_wheels == 0.0) return false;
  const std::string names = base::ToLower(joint->name + " " + model.links[link].name);
  for (const char* word : {"hitch", "trailer", "drawbar"})
    if (names.find(word) != std::string::npos) return true;
  const double trail = (sum / num_wheels - X_B[link].translation.head<2>()).norm();
  return UpwardPart(model.links[link], X_B[link]) >= kUprightAxis &&
         trail > std::max(kLongestTrail, 2.0 * radius);
}

/// Where a shape that is no wheel touches the floor.
std::vector<Vector2d> ContactsOf(const geometry::Collision& shape, const Pose3& X_BS) {
  constexpr double kFlat = 0.001;  // [m]
  const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_BS);
  const double lowest = bounds.lower.z();
  if (lowest > kFloorSlack) return {};
  const auto face = geometry::OutlineInBand(shape.shape, X_BS, lowest, lowest + kFlat);
  if (face && !std::holds_alternative<geometry::Sphere>(shape.shape)) return *face;
  return {(0.5 * (bounds.lower + bounds.upper)).head<2>()};
}

bool LieInLine(const std::vector<Vector2d>& points) {
  constexpr double kLeastWidth = 0.01;  // [m]
  Vector2d along = Vector2d::Zero();
  for (const Vector2d& p : points)
    if ((p - points.front()).norm() > along.norm()) along = p - points.front();
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  return std::all_of(points.begin(), points.end(), [&](const Vector2d& p) {
    return std::abs(across.dot(p - points.front())) < kLeastWidth;
  });
}

}  // namespace

FloorSupport FloorSupportOf(const Robot& robot, const JointPositions& joints) {
  const RobotModel& model = robot.model;
  const int base = *model.FindLink(robot.profile.base_link);
  Poses X_B = ForwardKinematics(model, joints);
  const Pose3 X_BR = X_B[base].Inverse();
  for (Pose3& X : X_B) X = X_BR * X;

  FloorSupport support;
  std::vector<bool> is_towed(model.links.size(), false);
  std::vector<Vector2d> on_floor;
  std::vector<geometry::MassProperties> parts;
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    const Link& link = model.links[i];
    if (!IsBelow(model, base, i) && IsHitch(model, i, X_B)) support.towed.push_back(link.name);
    is_towed[i] = (link.joint && is_towed[link.joint->parent]) ||
                  (!support.towed.empty() && support.towed.back() == link.name);
    if (is_towed[i]) continue;
    if (link.inertial) parts.push_back(geometry::InFrame(X_B[i], *link.inertial));
    if (IsWheel(link, X_B[i])) {
      const double radius = X_B[i].translation.z();
      support.wheel_radius = std::min(radius, support.wheel_radius.value_or(radius));
      on_floor.push_back(X_B[i].translation.head<2>());
      continue;
    }
    for (const geometry::Collision& shape : link.collisions)
      for (const Vector2d& point : ContactsOf(shape, X_B[i] * shape.X_BS))
        on_floor.push_back(point);
  }
  support.num_contacts = static_cast<int>(on_floor.size());
  support.is_assumed = support.num_contacts < 3 || LieInLine(on_floor);
  support.polygon = support.is_assumed ? robot.profile.footprint : geometry::ConvexHull(on_floor);
  if (!parts.empty()) support.body = geometry::Together(parts);
  return support;
}

}  // namespace hires::robot
