#include "hires/control/tray_load.h"

#include "hires/base/error.h"
#include "hires/geometry/shape.h"
#include "hires/navigation/standing_load.h"
#include "hires/robot/posture.h"
#include "hires/skills/manipulation_context.h"

namespace hires::control {
namespace {

using geometry::Aabb;
using navigation::BrakingLimits;
using robot::Robot;

constexpr double kBeside = 0.03;       // [m] over the plate's edge: seen with an error
constexpr double kBelow = 0.10;        // [m] below and above its top, likewise, and models whose
constexpr double kOriginAbove = 0.25;  // [m] origin is not at their foot

/// The largest of the tray's shapes, in the tray link's frame; rims and walls are smaller.
Aabb PlateOf(const robot::Link& tray) {
  Aabb plate{};
  double largest = -1.0;
  for (const geometry::Collision& collision : tray.collisions) {
    const Aabb bounds = geometry::BoundsOf(collision.shape, collision.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    if (size.x() * size.y() <= largest) continue;
    largest = size.x() * size.y();
    plate = bounds;
  }
  return plate;
}

bool IsOver(const Aabb& plate, const Eigen::Vector3d& p_TO) {
  const double top = plate.upper.z();
  return p_TO.x() > plate.lower.x() - kBeside && p_TO.x() < plate.upper.x() + kBeside &&
         p_TO.y() > plate.lower.y() - kBeside && p_TO.y() < plate.upper.y() + kBeside &&
         p_TO.z() > top - kBelow && p_TO.z() < top + kOriginAbove;
}

geometry::Pose3 TrayPose(const Robot& robot, const geometry::Pose2& X_MB,
                         const robot::JointPositions& joints) {
  return skills::LinkPose(robot, X_MB, joints, robot.profile.tray_link);
}

}  // namespace

std::vector<robot::SeenObject> OnTray(const Robot& robot, const robot::Observation& seen) {
  std::vector<robot::SeenObject> objects;
  const auto tray = robot.model.FindLink(robot.profile.tray_link);
  if (robot.profile.tray_link.empty() || !tray) return objects;
  const Aabb plate = PlateOf(robot.model.links[*tray]);
  const auto X_MT = TrayPose(robot, seen.X_MB, robot::PostureOf(robot, seen.joints));
  for (const robot::SeenObject& object : seen.objects) {
    const bool is_loose = object.attached_to.empty();
    if (is_loose && IsOver(plate, X_MT.Inverse() * object.X_MO.translation)) {
      objects.push_back(object);
    }
  }
  return objects;
}

std::optional<BrakingLimits> BrakingFor(const Robot& robot, const world::World& world,
                                        const robot::Observation& seen, bool has_eyes,
                                        const navigation::BrakingParams& params) {
  if (!has_eyes) return std::nullopt;
  std::vector<navigation::StandingLoad> loads;
  for (const robot::SeenObject& object : OnTray(robot, seen)) {
    const auto model = world.FindModel(object.model);
    if (!model) return std::nullopt;
    try {
      loads.push_back(navigation::LoadOf(*model));
    } catch (const base::ConfigError&) {
      return std::nullopt;
    }
  }
  navigation::CarryingBase base;
  base.controller = robot.profile.base_controller;
  base.gravity = world.gravity;
  if (const auto tray = robot.model.FindLink(robot.profile.tray_link)) {
    base.tray_height = TrayPose(robot, {}, robot.profile.joints).translation.z() +
                       PlateOf(robot.model.links[*tray]).upper.z();
  }
  return navigation::LimitsFor(loads, base, params);
}

}  // namespace hires::control
