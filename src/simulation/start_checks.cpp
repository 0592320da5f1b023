#include "simulation/start_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>
#include <variant>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/bearing_face.h"
#include "hires/localisation/laser_mount.h"
#include "hires/robot/tray.h"
#include "simulation/start/overlap.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;
using Mesh = std::shared_ptr<const geometry::TriangleMesh>;

constexpr double kFarAway = 1000.0;  // [m]
constexpr double kStiffest = 2.0;    // half of what diverges
constexpr double kUnitSlack = 1e-6;  // how far a quaternion's length may be from 1

/// Loop and leaning are integrated by the semi-implicit Euler method: x'' = -w^2 x - 2 zeta w x'
/// grows without bounds from (w dt)^2 + 4 zeta w dt = 4 on.
void RefuseStiff(const char* what, double frequency, double damping, double time_step) {
  const double h = frequency * time_step;
  if (h * h + 4.0 * damping * h < kStiffest) return;
  throw base::ConfigError(fmt::format(
      "base controller: {0}_frequency {1:g} rad/s with {0}_damping {2:g} is too stiff for a time "
      "step of {3:g} s; (w dt)^2 + 4 zeta w dt is {4:.3g}, wanted below {5:g}: lower one of the "
      "three",
      what, frequency, damping, time_step, h * h + 4.0 * damping * h, kStiffest));
}

/// [m] that the shapes of an upright model reach below its origin.
double HeightBelowOrigin(const world::ObjectModel& model) {
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : model.collisions) {
    bounds.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
  }
  return -bounds.lower.z();
}

/// "'carton' of the world (hall.world:5)", or "object 'carton'".
std::string Described(const world::ObjectState& object, const world::World& world) {
  if (!IsOfWorld(object, world)) return fmt::format("object '{}'", object.name);
  const std::string source = world::SourceOf(object.name, world);
  return fmt::format("object '{}' of the world{}", object.name,
                     source.empty() ? "" : " (" + source + ")");
}

/// " at area 'a'", if the robot stands at one or next to it.
std::string AtArea(const geometry::Pose2& X_MB, const world::World& world) {
  double nearest = 0.25;  // [m] what a drawn start may be off
  std::string text;
  for (const auto& [name, X_MF] : world.frames) {
    const double distance = (X_MF.translation.head<2>() - X_MB.position()).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    const auto spelled = world.frame_names.find(name);
    text =
        fmt::format(" at area '{}'", spelled == world.frame_names.end() ? name : spelled->second);
  }
  return text;
}

std::string WhyBegunInside(const world::ObjectState& object, const world::World& world,
                           const Inside& inside, const geometry::Pose2& X_MB) {
  const Eigen::Vector3d& p = object.X_MO.translation;
  return fmt::format(
      "the robot would begin inside of {0}, which stands at x {1:.3f} m, y {2:.3f} m, z {3:.3f} m "
      "and reaches {4:.3f} m deep into its '{5}': it begins{6} at x {7:.3f} m, y {8:.3f} m, yaw "
      "{9:.3f} rad; begin elsewhere (another --from), or move '{10}' in the file, or for this "
      "request (--put {10}:X,Y,Z)",
      Described(object, world), p.x(), p.y(), p.z(), inside.depth, inside.part, AtArea(X_MB, world),
      X_MB.x, X_MB.y, X_MB.yaw, object.name);
}

/// What helps a thing that stands on the tray; "" for others.
std::string TrayRemedy(const Scene& scene, const Pose3& X_MB, const world::ObjectState& object) {
  const robot::Robot& robot = scene.robot;
  const auto plate = robot::TrayPlateOf(robot);
  if (!plate) return "";
  const auto X_RL = robot::ForwardKinematics(robot.model, robot.profile.joints);
  const Pose3 X_BT = X_RL[*robot.model.FindLink(robot.profile.base_link)].Inverse() *
                     X_RL[*robot.model.FindLink(robot.profile.tray_link)];
  const Eigen::Vector3d p_T = (X_MB * X_BT).Inverse() * object.X_MO.translation;
  if (!robot::IsOverPlate(*plate, p_T)) return "";
  return fmt::format(
      "it would stand at ({:.3f}, {:.3f}, {:.3f}) m of '{}', whose top is at z {:.3f} m: put it on "
      "a free place there, or name one in the robot's profile, object_on_tray: {{xyz: [x, y, z], "
      "rpy: [0, 0, 0]}}",
      p_T.x(), p_T.y(), p_T.z(), robot.profile.tray_link, plate->upper.z());
}

}  // namespace

bool IsOfWorld(const world::ObjectState& object, const world::World& world) {
  const world::ObjectState* known = world.initial.Find(object.name);
  return known != nullptr && known->model == object.model && object.attached_to.empty() &&
         (known->X_MO.translation - object.X_MO.translation).norm() < kStartSlack;
}

std::optional<Inside> FindInside(const std::vector<geometry::Collision>& object, const Pose3& X_MO,
                                 const std::vector<geometry::Collision>& robot_B,
                                 const Pose3& X_MB) {
  std::optional<Inside> deepest;
  for (const geometry::Collision& part : robot_B) {
    const geometry::Aabb around = geometry::BoundsOf(part.shape, X_MB * part.X_BS);
    for (const geometry::Collision& shape : object) {
      if (!Overlap({shape}, X_MO, {part}, X_MB)) continue;
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_MO * shape.X_BS);
      const double depth = std::min(bounds.upper.z(), around.upper.z()) -
                           std::max(bounds.lower.z(), around.lower.z());
      if (!deepest || depth > deepest->depth)
        deepest = {part.name, depth, around.upper.z() - bounds.lower.z()};
    }
  }
  return deepest;
}

std::string WhyInsideRobot(const world::ObjectState& object, const Scene& scene, const Pose3& X_MB,
                           const Inside& inside) {
  if (IsOfWorld(object, scene.world))
    return WhyBegunInside(object, scene.world, inside, geometry::Flatten(X_MB));
  const double below = HeightBelowOrigin(*scene.world.RequireModel(object.model));
  const bool is_origin = below > kStartSlack && std::abs(inside.sunk - below) <= kStartSlack;
  const std::string on_tray = TrayRemedy(scene, X_MB, object);
  const std::string cause =
      is_origin ? fmt::format(
                      "its model '{}' reaches {:.3f} m below its origin, and a pose is that of the "
                      "middle of the underside: raise the shapes in the model by as much",
                      object.model, below)
      : !on_tray.empty()
          ? on_tray
          : fmt::format(
                "its pose has z {:.3f} m: give the height of what it stands on, or put it on "
                "a free place",
                object.X_MO.translation.z());
  return fmt::format("object '{}' starts inside the robot, {:.3f} m deep in '{}'; {}", object.name,
                     inside.depth, inside.part, cause);
}

bool StandsOn(const std::vector<geometry::Collision>& robot_B,
              const std::vector<geometry::Collision>& object, const Pose3& X_BO) {
  geometry::Aabb object_bounds;
  for (const geometry::Collision& shape : object) {
    object_bounds.Include(geometry::BoundsOf(shape.shape, X_BO * shape.X_BS));
  }
  const double bottom = object_bounds.lower.z();
  const Eigen::Vector2d middle = 0.5 * (object_bounds.lower + object_bounds.upper).head<2>();
  return std::any_of(robot_B.begin(), robot_B.end(), [&](const geometry::Collision& part) {
    if (const auto* mesh = std::get_if<Mesh>(&part.shape)) {  // also the floor of a basket
      const Eigen::Vector2d origin = X_BO.translation.head<2>();
      for (const Eigen::Vector2d& p : {origin, middle}) {
        if (geometry::HasFaceAt(**mesh, part.X_BS, {p.x(), p.y(), bottom}, kRestingGap))
          return true;
      }
    }
    const geometry::Aabb bounds = geometry::BoundsOf(part.shape, part.X_BS);
    if (std::abs(bounds.upper.z() - bottom) > kRestingGap) return false;
    const auto outline =
        geometry::OutlineInBand(part.shape, part.X_BS, bounds.lower.z(), bounds.upper.z());
    return outline && (geometry::Contains(*outline, X_BO.translation.head<2>()) ||
                       geometry::Contains(*outline, middle));
  });
}

void RefusePose(const std::string& what, const Pose3& X) {
  if (!X.IsFinite()) {
    throw base::ConfigError(fmt::format("{}: its pose is not finite; give numbers", what));
  }
  if (X.translation.norm() > kFarAway) {
    throw base::ConfigError(fmt::format(
        "{}: stands {:.0f} m from the map's origin, at most {:.0f} m make sense; check its pose",
        what, X.translation.norm(), kFarAway));
  }
}

void RefuseObject(const world::ObjectState& object) {
  const std::string what = fmt::format("object '{}'", object.name);
  RefusePose(what, object.X_MO);
  if (std::abs(object.X_MO.rotation.norm() - 1.0) > kUnitSlack) {
    throw base::ConfigError(
        fmt::format("{}: its quaternion has length {:.6g}, wanted unit length; no turn is (x, y, "
                    "z, w) = (0, 0, 0, 1)",
                    what, object.X_MO.rotation.norm()));
  }
  if (!object.V_MO.linear.allFinite() || !object.V_MO.angular.allFinite()) {
    throw base::ConfigError(
        fmt::format("{}: its velocity is not finite; give numbers, 0 at rest", what));
  }
}

void RefuseUnknownHolder(const world::ObjectState& object, const robot::RobotModel& robot) {
  if (object.attached_to.empty() || robot.FindLink(object.attached_to)) return;
  throw base::ConfigError(
      fmt::format("object '{}' is attached to the robot: {}", object.name,
                  base::UnknownName("link", object.attached_to, robot.LinkNames())));
}

void RefuseUnknownJoints(const robot::JointPositions& joints, const robot::RobotModel& robot) {
  std::vector<std::string> known;
  for (const robot::Link& link : robot.links) {
    if (link.joint) known.push_back(link.joint->name);
  }
  for (const auto& [name, position] : joints) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw base::ConfigError(
          fmt::format("robot '{}': {}", robot.name, base::UnknownName("joint", name, known)));
    }
  }
}

void RefuseStiff(const robot::BaseControllerParams& params, double time_step) {
  RefuseStiff("loop", params.loop_frequency, params.loop_damping, time_step);
  RefuseStiff("sway", params.sway_frequency, params.sway_damping, time_step);
}

void RefuseTiltedLaser(const robot::Robot& robot) {
  const robot::RobotProfile& profile = robot.profile;
  const auto laser = robot.model.FindLink(profile.laser_link);
  const auto base = robot.model.FindLink(profile.base_link);
  if (!laser || !base) return;  // of which others tell
  const auto X_RL = robot::ForwardKinematics(robot.model, profile.joints);
  const Pose3 X_BL = X_RL[*base].Inverse() * X_RL[*laser];
  robot::ScanReading none;
  if (localisation::LevelLaser(X_BL, &none)) return;
  throw base::ConfigError(fmt::format(
      "robot '{}': its base laser '{}' is tilted by {:.2f} rad, wanted a level one, or one upside "
      "down, within {:g} rad; mend its joint in the URDF, or name another laser_link in the "
      "profile",
      robot.model.name, profile.laser_link, geometry::TiltOf(X_BL.rotation),
      localisation::kMostLaserTilt));
}

void RefuseSameNames(const std::vector<world::ObjectState>& objects) {
  std::set<std::string> seen;
  for (const world::ObjectState& object : objects) {
    if (seen.insert(base::ToLower(object.name)).second) continue;
    throw base::ConfigError(
        fmt::format("object '{}' is there twice; name each instance once", object.name));
  }
}

std::string WhyInOther(const world::ObjectState& object, const world::ObjectState& earlier,
                       const world::World& world) {
  const bool is_of_world = IsOfWorld(object, world),
             is_earlier_of_world = IsOfWorld(earlier, world);
  if (is_of_world && is_earlier_of_world) return "";
  const auto model = world.RequireModel(object.model), other = world.RequireModel(earlier.model);
  if (!Overlap(model->collisions, object.X_MO, other->collisions, earlier.X_MO)) return "";
  const auto& [put, around] =
      IsOfWorld(object, world) ? std::tie(earlier, object) : std::tie(object, earlier);
  return fmt::format("{} starts inside '{}'; put it on a free place", Described(put, world),
                     around.name);
}

std::string WhyInStatics(const world::ObjectState& object, const world::World& world) {
  const auto model = world.RequireModel(object.model);
  for (const world::StaticBody& body : world.statics) {
    if (Overlap(model->collisions, object.X_MO, body.collisions, body.X_MB)) {
      return fmt::format("{} starts inside '{}'; put it on a free place", Described(object, world),
                         body.name);
    }
  }
  return "";
}

}  // namespace hires::simulation
