#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/perception/camera_view.h"
#include "hires/world/unknown_box.h"
#include "sensing/memory/memory_parts.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;
using geometry::Pose3;

constexpr double kHighest = 0.3;     // [m] over the tray that its laser may be
constexpr double kBesideTray = 0.1;  // [m] where the robot's own parts matter
constexpr double kOwnBand = 0.02;    // [m] of the robot's parts, whose heights err
constexpr double kSamePlace = 0.03;  // [m] that a thing may seem to move between scans
constexpr double kAround = 0.01;     // [m] of the box about what nobody knows: edges are seen badly
constexpr double kNarrowest = 0.02;  // [m] of what nobody knows

Polygon OutlineOf(const geometry::Aabb& box) {
  const Eigen::Vector3d &a = box.lower, &b = box.upper;
  return {{a.x(), a.y()}, {b.x(), a.y()}, {b.x(), b.y()}, {a.x(), b.y()}};
}

/// Whether a part may be met by beams over the tray.
bool IsInScan(const geometry::Collision& part, const Pose3& X_TL, const geometry::Aabb& tray_T,
              double height) {
  const geometry::Aabb bounds = geometry::BoundsOf(part.shape, X_TL * part.X_BS);
  const auto overlaps = [&](int axis, double lower, double upper) {
    return bounds.lower[axis] <= upper && bounds.upper[axis] >= lower;
  };
  return overlaps(2, height - kOwnBand / 2, height + kOwnBand / 2) &&
         overlaps(0, tray_T.lower.x() - kBesideTray, tray_T.upper.x() + kBesideTray) &&
         overlaps(1, tray_T.lower.y() - kBesideTray, tray_T.upper.y() + kBesideTray);
}

/// The box about what is seen of a thing: deeper, away from the laser, where it shows one side.
struct SeenBox {
  geometry::Pose2 X_TB;
  Vector2d size;  // [m]
};
SeenBox BoxOn(const TrayThing& thing, const Vector2d& p_TL) {
  const double width = std::max(thing.size.x(), kNarrowest);
  const double least = std::max(std::min(width, ObjectMemory::kDepthOnTray), kNarrowest);
  const double depth = std::max(thing.size.y(), least);
  const Vector2d across(-std::sin(thing.X_TB.yaw), std::cos(thing.X_TB.yaw));
  const double side = across.dot(thing.X_TB.position() - p_TL) >= 0.0 ? 1.0 : -1.0;
  const Vector2d p_T = thing.X_TB.position() + side * 0.5 * (depth - thing.size.y()) * across;
  return {{p_T.x(), p_T.y(), thing.X_TB.yaw}, {width + 2 * kAround, depth + 2 * kAround}};
}

}  // namespace

std::string ObjectMemory::ScanTray(const BodyReading& body, const robot::ScanReading& scan,
                                   const Pose3& X_BL) {
  if (!tray_T_) return fmt::format("robot '{}' has no tray (tray_link)", robot_->model.name);
  const Links links(*robot_, body);
  const Pose3 X_MT = links.X_ML(robot_->profile.tray_link);
  const Pose3 X_BT = links.X_ML(robot_->profile.base_link).Inverse() * X_MT;
  const Pose3 X_TL = X_BT.Inverse() * X_BL;
  const double height = X_TL.translation.z(), lean = geometry::TiltOf(X_TL.rotation);
  if (!(lean <= kLevelLaser)) {
    return fmt::format("its laser leans by {:.3f} rad over the tray, wanted at most {:g}", lean,
                       kLevelLaser);
  }
  const double above = height - tray_T_->upper.z();
  if (!(above > 0.0 && above <= kHighest)) {
    return fmt::format("its laser is {:.3f} m above the tray, wanted more than 0 and at most {:g}",
                       above, kHighest);
  }
  TrayView view{body.time, X_BT, height, {}};
  view.reading = ReadTray(scan, X_TL, OutlineOf(*tray_T_), BelievedOn(links, X_MT), TrayParams(),
                          OwnOutlines(links, X_MT, height));
  Agree(links, view, X_MT);
  AppearOnTray(links, view, X_TL);
  tray_ = std::move(view);
  return "";
}

/// What moves with the base and stands over the tray, by name.
std::vector<BelievedOnTray> ObjectMemory::BelievedOn(const Links& links, const Pose3& X_MT) const {
  const robot::RobotProfile& profile = robot_->profile;
  std::vector<BelievedOnTray> believed;
  for (const auto& [name, object] : objects_) {
    if (object.is_held) continue;
    if (object.link != profile.base_link && object.link != profile.tray_link) continue;
    const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
    if (!IsOverTray(links, X_MO)) continue;
    believed.push_back({name, X_MT.Inverse() * X_MO, surroundings_->Model(object.model).collisions,
                        world::SaysUnknownBox(object.model)});
  }
  return believed;
}

/// Of the robot's parts and of what it holds, in the height of the scan.
std::vector<Polygon> ObjectMemory::OwnOutlines(const Links& links, const Pose3& X_MT,
                                               double height) const {
  const robot::RobotProfile& profile = robot_->profile;
  const Pose3 X_TM = X_MT.Inverse();
  std::vector<Polygon> outlines;
  const auto add = [&](const std::vector<geometry::Collision>& parts, const Pose3& X_TL) {
    for (const geometry::Collision& part : parts) {
      if (!IsInScan(part, X_TL, *tray_T_, height)) continue;
      const auto slice = SliceAt(height, kOwnBand, {part}, X_TL);
      outlines.insert(outlines.end(), slice.begin(), slice.end());
    }
  };
  for (const robot::Link& link : robot_->model.links) {
    const bool is_of_tray =
        link.name == profile.tray_link || link.name == profile.sensors.tray_laser_link;
    if (link.collisions.empty() || is_of_tray) continue;
    add(link.collisions, X_TM * links.X_ML(link.name));
  }
  for (const auto& [name, object] : objects_) {
    if (!object.is_held) continue;
    add(surroundings_->Model(object.model).collisions,
        X_TM * links.X_ML(object.link) * object.X_LO);
  }
  return outlines;
}

/// Believes what the scan says of the objects that were believed on the tray.
void ObjectMemory::Agree(const Links& links, const TrayView& view, const Pose3& X_MT) {
  std::vector<std::string> gone;
  for (const TrayObject& seen : view.reading.objects) {
    RememberedObject& object = objects_.at(seen.name);
    if (seen.state == TrayState::kUnknown) continue;
    if (seen.state == TrayState::kMissing) {
      if (++object.num_looked_through >= params_.scans_to_vanish) gone.push_back(seen.name);
      continue;
    }
    object.is_observed = true;
    object.num_looked_through = object.num_missed = 0;
    if (world::SaysUnknownBox(object.model)) continue;
    const Pose3 X_LO = links.X_ML(object.link).Inverse() * X_MT * seen.X_TO;
    const double weight = seen.state == TrayState::kMoved ? 1.0 : params_.blending;
    object.X_LO.translation += weight * (X_LO.translation - object.X_LO.translation);
  }
  for (const std::string& name : gone) Lose(links, name);
}

/// Counts for how long things have stood there that nobody knows.
void ObjectMemory::AppearOnTray(const Links& links, const TrayView& view, const Pose3& X_TL) {
  std::vector<NewOnTray> seen;
  for (const TrayThing& thing : view.reading.surplus) {
    // What stands beside the tray may reach over it.
    if (!geometry::Contains(OutlineOf(*tray_T_), thing.X_TB.position())) continue;
    NewOnTray one{thing.X_TB.position(), 1};
    for (const NewOnTray& before : new_on_tray_) {
      if ((before.p_T - one.p_T).norm() > kSamePlace) continue;
      one.num_scans = std::max(one.num_scans, before.num_scans + 1);
    }
    if (one.num_scans < params_.scans_to_appear) {
      seen.push_back(one);
      continue;
    }
    const SeenBox box = BoxOn(thing, X_TL.translation.head<2>());
    const std::string& base = robot_->profile.base_link;
    const Pose3 X_BO = view.X_BT * geometry::Lift(box.X_TB, tray_T_->upper.z());
    const std::string name =
        NewName(perception::kUnknownLabel, (links.X_ML(base) * X_BO).translation);
    vanished_.erase(name);
    RememberedObject& object = objects_[name];
    object.name = name;
    object.model = world::UnknownBoxModel({box.size.x(), box.size.y(), kHeightOnTray});
    object.link = base;
    object.X_LO = X_BO;
    object.is_observed = true;
    object.time = view.time;
  }
  new_on_tray_ = std::move(seen);
}

}  // namespace hires::sensing
