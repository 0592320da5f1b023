#include "hires/simulation/free_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "hires/base/error.h"
#include "hires/robot/posture.h"
#include "hires/robot/tray.h"
#include "simulation/start/overlap.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose3;

/// Of the robot with these joints; nothing where that is the scene's own clearance.
std::optional<RobotClearance> ClearanceFor(const Scene& scene,
                                           const robot::JointPositions& joints) {
  const robot::JointPositions posture = robot::PostureOf(scene.robot, joints);
  if (posture == robot::PostureOf(scene.robot, {})) return std::nullopt;
  return RobotClearance(FrozenShapes(scene.robot, posture), scene.world);
}

constexpr double kLevel = 0.02;  // [rad] a plate that is tilted by less counts as level

/// The largest shape from above of the link that carries things.
struct TrayPlate {
  const geometry::Collision* shape{nullptr};  // in the link's frame
  Pose3 X_BL, X_BS;
  geometry::Aabb bounds_B;
};

std::optional<TrayPlate> PlateOf(const robot::Robot& robot, const robot::JointPositions& posture) {
  const auto link = robot.model.FindLink(robot.profile.tray_link);
  if (!link) return std::nullopt;
  const auto X_RL = robot::ForwardKinematics(robot.model, posture);
  const Pose3 X_BL = X_RL[*robot.model.FindLink(robot.profile.base_link)].Inverse() * X_RL[*link];
  const auto [shape, bounds_B, area] =
      robot::LargestFromAbove(robot.model.links[*link].collisions, X_BL);
  if (!(area > 0.0)) return std::nullopt;
  return TrayPlate{shape, X_BL, X_BL * shape->X_BS, bounds_B};
}

/// Out of the face that shows most of itself from above, in the base frame.
Vector3d UpOf(const TrayPlate& plate) {
  const Eigen::Matrix3d R = plate.X_BS.rotation.toRotationMatrix();
  const geometry::Aabb bounds_S = geometry::BoundsOf(plate.shape->shape, {});
  const Vector3d size = bounds_S.upper - bounds_S.lower;
  int upper = 0;
  Vector3d(R.row(2).transpose().cwiseAbs().cwiseQuotient(size)).maxCoeff(&upper);
  return R.col(upper) * (R(2, upper) < 0.0 ? -1.0 : 1.0);
}

/// [m] from the surface of a tilted plate up to p_B; of the plane through its middle.
double HeightAbove(const TrayPlate& plate, const Vector3d& p_B) {
  const Vector3d up = UpOf(plate);
  const Vector3d up_S = plate.X_BS.rotation.inverse() * up;
  const geometry::Aabb bounds_S = geometry::BoundsOf(plate.shape->shape, {});
  const Vector3d top_S = 0.5 * (bounds_S.lower + bounds_S.upper) +
                         0.5 * up_S.cwiseAbs().dot(bounds_S.upper - bounds_S.lower) * up_S;
  return up.dot(p_B - plate.X_BS * top_S) / up.z();
}

std::string Text(const Vector3d& p) {
  const auto told = [](double value) { return std::abs(value) < 5e-4 ? 0.0 : value; };
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", told(p.x()), told(p.y()), told(p.z()));
}

/// "object_on_tray in the profile of 'cart' is (0.000, 0.300, 0.020) m, the plate of its
/// 'load_deck' reaches from ... to ...; ..."
std::string PlateText(const robot::Robot& robot, const TrayPlate& plate, const Vector3d& p_BO) {
  const Vector3d p_LO = plate.X_BL.Inverse() * p_BO, p_LTray = robot.profile.X_TO.translation;
  const geometry::Aabb bounds = geometry::BoundsOf(plate.shape->shape, plate.shape->X_BS);
  const std::string moved = (p_LO - p_LTray).norm() < 1e-6
                                ? ""
                                : fmt::format(", the place of this one of several {}", Text(p_LO));
  return fmt::format(
      "object_on_tray of robot '{}' is {} m{}, the plate of its '{}' reaches from {} to {} m",
      robot.model.name, Text(p_LTray), moved, robot.profile.tray_link, Text(bounds.lower),
      Text(bounds.upper));
}

/// [m] from above; 0 over the plate.
double Beside(const TrayPlate& plate, const Vector2d& p_B) {
  const auto outline = geometry::OutlineInBand(plate.shape->shape, plate.X_BS,
                                               plate.bounds_B.lower.z(), plate.bounds_B.upper.z());
  return outline ? geometry::Distance(*outline, geometry::Polygon{p_B}) : 0.0;
}

[[noreturn]] void FailTilted(const robot::Robot& robot, const TrayPlate& plate,
                             const world::ObjectState& object, double tilt) {
  throw base::ConfigError(fmt::format(
      "object '{}' cannot begin on the tray: the plate of '{}' of robot '{}' is tilted by {:.2f} "
      "rad, wanted a level one ({:g} rad at most); level the joint in its URDF (or in 'joints' of "
      "its profile), or have object_on_tray and tray_link name another place",
      object.name, robot.profile.tray_link, robot.model.name, tilt, kLevel));
}

geometry::Aabb BoundsAt(const world::ObjectModel& model, const Pose3& X_BO) {
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : model.collisions)
    bounds.Include(geometry::BoundsOf(shape.shape, X_BO * shape.X_BS));
  return bounds;
}

/// What is asked of places on the tray, in the base frame.
class TrayRoom {
 public:
  TrayRoom(const Scene& scene, const robot::RobotState& start, const world::ObjectState& object,
           const std::vector<world::ObjectState>& others)
      : shapes_B_(FrozenShapes(scene.robot, robot::PostureOf(scene.robot, start.joints))),
        model_(scene.world.ModelOf(object)) {
    for (const world::ObjectState& other : others) {
      const auto model = scene.world.ModelOf(other);
      others_.push_back({model, geometry::Lift(start.X_MB).Inverse() * other.X_MO});
    }
  }

  bool IsFree(const Pose3& X_BO) const {
    return std::none_of(others_.begin(), others_.end(),
                        [&](const Placed& other) {
                          return Overlap(model_->collisions, X_BO, other.model->collisions,
                                         other.X_BO);
                        }) &&
           StandsOn(shapes_B_, model_->collisions, X_BO) &&
           !FindInside(model_->collisions, X_BO, shapes_B_, {});
  }

  /// Whether the robot carries this share of its half widths to all sides of its middle.
  bool IsCarried(const Pose3& X_BO, double share) const {
    const geometry::Aabb bounds = BoundsAt(*model_, X_BO);
    const Vector2d half = 0.5 * (bounds.upper - bounds.lower).head<2>();
    for (int i = 0; i < kSides; ++i) {
      if (!StandsOn(shapes_B_, model_->collisions,
                    Shifted(X_BO, share * half.cwiseProduct(Side(i)))))
        return false;
    }
    return true;
  }

  /// It is all over the plate, and free also if it stood 1 cm farther to any side.
  bool IsRoomy(const Pose3& X_BO, const geometry::Aabb& plate_B) const {
    const geometry::Aabb bounds = BoundsAt(*model_, X_BO);
    if ((bounds.lower - plate_B.lower).head<2>().minCoeff() < 0.0) return false;
    if ((plate_B.upper - bounds.upper).head<2>().minCoeff() < 0.0) return false;
    if (!IsFree(X_BO) || !IsCarried(X_BO, kWhole)) return false;
    for (int i = 0; i < kSides; ++i) {
      if (!IsFree(Shifted(X_BO, kTried * Side(i)))) return false;
    }
    return true;
  }

  static Vector2d Side(int i) {
    return {std::cos(2.0 * M_PI * i / kSides), std::sin(2.0 * M_PI * i / kSides)};
  }

  static Pose3 Shifted(Pose3 X_BO, const Vector2d& way_B) {
    X_BO.translation.head<2>() += way_B;
    return X_BO;
  }

 private:
  static constexpr int kSides = 8;
  static constexpr double kWhole = 1.09;  // of its half widths: between two sides, too
  // [m] 1 cm of room to all sides, as tried at so many, and what counts as no overlap yet.
  static constexpr double kTried = 0.0115 + kStartSlack;
  struct Placed {
    std::shared_ptr<const world::ObjectModel> model;
    Pose3 X_BO;
  };
  std::vector<geometry::Collision> shapes_B_;
  std::shared_ptr<const world::ObjectModel> model_;
  std::vector<Placed> others_;
};

/// Ways from a place to others, all over a plate, the nearest first.
std::vector<Vector2d> WaysOver(const geometry::Aabb& plate_B, const Vector2d& p_B) {
  constexpr double kStep = 0.01;  // [m]
  constexpr int kMost = 40;       // to a side
  const Vector2d size = (plate_B.upper - plate_B.lower).head<2>();
  const double step = std::max(kStep, size.maxCoeff() / kMost);
  const Eigen::AlignedBox2d box(plate_B.lower.head<2>().eval(), plate_B.upper.head<2>().eval());
  std::vector<Vector2d> ways;
  for (int i = -kMost; i <= kMost; ++i) {
    for (int j = -kMost; j <= kMost; ++j) {
      const Vector2d way(i * step, j * step);
      if (box.contains((p_B + way).eval())) ways.push_back(way);
    }
  }
  std::stable_sort(ways.begin(), ways.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.squaredNorm() < b.squaredNorm() - 1e-12;
  });
  return ways;
}

}  // namespace

std::optional<TrayPlace> FreeOnTray(const Scene& scene, const robot::RobotState& start,
                                    const world::ObjectState& object,
                                    const std::vector<world::ObjectState>& others) {
  constexpr double kEnoughCarried = 0.5;  // of its half widths, so that it does not tip by itself
  const auto plate = PlateOf(scene.robot, robot::PostureOf(scene.robot, start.joints));
  if (!plate) return std::nullopt;
  const Pose3 X_MB = geometry::Lift(start.X_MB);
  const Pose3 X_BO = X_MB.Inverse() * object.X_MO;
  const TrayRoom room(scene, start, object, others);
  const bool is_free = room.IsFree(X_BO);
  if (is_free && room.IsCarried(X_BO, kEnoughCarried)) return TrayPlace{object.X_MO};
  Pose3 X_BMiddle = X_BO;
  X_BMiddle.translation.head<2>() = scene.X_BO.translation.head<2>();
  for (const Vector2d& way : WaysOver(plate->bounds_B, X_BMiddle.translation.head<2>())) {
    const Pose3 X_BPlace = TrayRoom::Shifted(X_BMiddle, way);
    if (room.IsRoomy(X_BPlace, plate->bounds_B)) return TrayPlace{X_MB * X_BPlace};
  }
  return is_free ? std::make_optional(TrayPlace{object.X_MO, false}) : std::nullopt;
}

void RefuseOffTray(const Scene& scene, const robot::RobotState& start,
                   const world::ObjectState& object) {
  const robot::Robot& robot = scene.robot;
  const robot::JointPositions posture = robot::PostureOf(robot, start.joints);
  const auto plate = PlateOf(robot, posture);
  if (!plate) return;
  const auto model = scene.world.ModelOf(object);
  const Pose3 X_BO = geometry::Lift(start.X_MB).Inverse() * object.X_MO;
  const geometry::Aabb bounds = BoundsAt(*model, X_BO);
  const Vector2d centre = 0.5 * (bounds.lower + bounds.upper).head<2>();
  const double beside =
      std::min(Beside(*plate, centre), Beside(*plate, X_BO.translation.head<2>()));
  const double tilt = std::acos(std::min(1.0, UpOf(*plate).z()));
  const std::vector<geometry::Collision> shapes_B = FrozenShapes(robot, posture);
  if (tilt > kLevel && beside == 0.0) {
    const bool is_inside = FindInside(model->collisions, X_BO, shapes_B, {}).has_value();
    const double gap = HeightAbove(*plate, {centre.x(), centre.y(), bounds.lower.z()});
    if (is_inside || gap > kStartSlack) FailTilted(robot, *plate, object, tilt);
  }
  if (StandsOn(shapes_B, model->collisions, X_BO)) return;
  const double above = bounds.lower.z() - plate->bounds_B.upper.z();
  const std::string where = beside > 0.0
                                ? fmt::format("{:.3f} m beside the tray's plate", beside)
                                : fmt::format("{:.3f} m {} the top of the tray's plate",
                                              std::abs(above), above > 0.0 ? "above" : "below");
  const bool is_beside_others = (X_BO.translation - scene.X_BO.translation).head<2>().norm() > 1e-6;
  const char* remedy = is_beside_others
                           ? "beside the others is no room for it, name fewer or smaller things"
                           : "give a place in the middle of its top, or leave object_on_tray out, "
                             "which is that";
  throw base::ConfigError(fmt::format("object '{}' would begin {}: {}; {}", object.name, where,
                                      PlateText(robot, *plate, X_BO.translation), remedy));
}

Variation WithFreeStart(Variation variation, const Scene& scene, const robot::RobotState& start) {
  const auto own = ClearanceFor(scene, start.joints);
  const RobotClearance& clearance = own ? *own : scene.clearance;
  geometry::Pose2& offset = variation.start_offset;
  for (int halving = 0; halving < 8; ++halving) {
    if (!clearance.FindContact(start.X_MB * offset)) return variation;
    offset = {offset.x / 2, offset.y / 2, offset.yaw / 2};
  }
  offset = {};
  return variation;
}

}  // namespace hires::simulation
