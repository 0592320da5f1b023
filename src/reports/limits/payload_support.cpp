#include "reports/limits/payload_support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/bearing_face.h"
#include "hires/geometry/polygon.h"
#include "hires/imagination/start_state.h"
#include "hires/navigation/standing_load.h"
#include "hires/physics/closed_forms.h"
#include "hires/robot/tray.h"
#include "simulation/start/overlap.h"

namespace hires::reports {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kContactBand = 0.001;  // [m] unevenness of a base, as in navigation::LoadOf
constexpr double kSameLevel = 0.006;    // [m] surfaces that differ by less carry together

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double AreaOf(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

/// The part of a convex polygon within another one [Sutherland, Hodgman 1974, Comm. ACM 17:32-42];
/// empty where they share no area.
Polygon Clipped(Polygon polygon, const Polygon& by) {
  for (std::size_t i = 0; i < by.size() && !polygon.empty(); ++i) {
    const Vector2d a = by[i], edge = by[(i + 1) % by.size()] - a;
    Polygon within;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector2d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double p_side = Cross(edge, p - a), q_side = Cross(edge, q - a);
      if (p_side >= 0.0) within.push_back(p);
      if (p_side * q_side < 0.0) within.push_back(p + p_side / (p_side - q_side) * (q - p));
    }
    polygon = std::move(within);
  }
  return AreaOf(polygon) > 1e-10 ? polygon : Polygon();
}

double LowestOf(const world::ObjectModel& model) {
  double lowest = kUnlimited;
  for (const geometry::Collision& part : model.collisions) {
    lowest = std::min(lowest, geometry::BoundsOf(part.shape, part.X_BS).lower.z());
  }
  return lowest;
}

/// What it stands on, in its own frame: convex parts, of a mesh its triangles.
std::vector<Polygon> ContactParts(const world::ObjectModel& model) {
  const double lowest = LowestOf(model);
  std::vector<Polygon> parts;
  const auto add = [&](const geometry::Shape& shape, const geometry::Pose3& X_BS) {
    const auto outline =
        geometry::OutlineInBand(shape, X_BS, lowest - kContactBand, lowest + kContactBand);
    if (outline) parts.push_back(*outline);
    return outline.has_value();
  };
  for (const geometry::Collision& part : model.collisions) {
    const auto* mesh = std::get_if<std::shared_ptr<const geometry::TriangleMesh>>(&part.shape);
    bool has_area = false;
    for (const auto& corners : mesh ? (*mesh)->triangles : std::vector<std::array<int, 3>>()) {
      const auto& all = (*mesh)->vertices;
      geometry::TriangleMesh one{{all[corners[0]], all[corners[1]], all[corners[2]]}, {{0, 1, 2}}};
      has_area |= add(std::make_shared<const geometry::TriangleMesh>(std::move(one)), part.X_BS);
    }
    if (!has_area) add(part.shape, part.X_BS);
  }
  return parts;
}

/// Whether it stands on one round shape alone, a ball or a can that lies: no acceleration is so
/// small that it stays.
bool Rolls(const world::ObjectModel& model) {
  constexpr double kLies = 0.1;  // of the axis' height
  const double lowest = LowestOf(model);
  std::vector<const geometry::Collision*> touching;
  for (const geometry::Collision& part : model.collisions) {
    const double bottom = geometry::BoundsOf(part.shape, part.X_BS).lower.z();
    if (bottom <= lowest + kContactBand) touching.push_back(&part);
  }
  if (touching.size() != 1) return false;
  const geometry::Collision& round = *touching.front();
  const Eigen::Vector3d axis = round.X_BS.rotation * Eigen::Vector3d::UnitZ();
  return std::holds_alternative<geometry::Sphere>(round.shape) ||
         (std::holds_alternative<geometry::Cylinder>(round.shape) && std::abs(axis.z()) < kLies);
}

/// Level surfaces of the robot at the height of its tray's plate, in the base frame.
struct TraySurface {
  std::vector<Polygon> outlines;  // none: the tray has no shape
  double friction{kUnlimited};
};

TraySurface SurfaceOf(const simulation::Scene& scene) {
  TraySurface surface;
  const robot::RobotProfile& profile = scene.robot.profile;
  const auto link = scene.robot.model.FindLink(profile.tray_link);
  if (!link) return surface;
  const auto plate = robot::LargestFromAbove(scene.robot.model.links[*link].collisions,
                                             scene.X_BO * profile.X_TO.Inverse());
  if (!(plate.area > 0.0)) return surface;
  surface.friction = plate.shape->friction;
  for (const geometry::Collision& shape : scene.robot_shapes_B) {
    const geometry::Aabb bounds = geometry::BearingBounds(shape.shape, shape.X_BS);
    if (std::abs(bounds.upper.z() - plate.bounds.upper.z()) > kSameLevel) continue;
    if (std::holds_alternative<std::shared_ptr<const geometry::TriangleMesh>>(shape.shape)) {
      const Vector2d lower = bounds.lower.head<2>(), upper = bounds.upper.head<2>();
      surface.outlines.push_back({lower, {upper.x(), lower.y()}, upper, {lower.x(), upper.y()}});
    } else if (const auto outline = geometry::OutlineInBand(shape.shape, shape.X_BS,
                                                            bounds.lower.z(), bounds.upper.z())) {
      surface.outlines.push_back(*outline);
    }
  }
  return surface;
}

/// By how much a body extends beyond the surfaces, along the axis nearest to each edge's normal.
Vector2d OverhangOf(const world::ObjectModel& model, const geometry::Pose2& X_BO,
                    const TraySurface& surface) {
  Polygon corners;
  for (const Polygon& outline : surface.outlines) {
    corners.insert(corners.end(), outline.begin(), outline.end());
  }
  const Polygon plate = geometry::ConvexHull(std::move(corners));
  Vector2d overhang(0.0, 0.0);
  for (const geometry::Collision& part : model.collisions) {
    const geometry::Aabb bounds = geometry::BoundsOf(part.shape, part.X_BS);
    const auto outline =
        geometry::OutlineInBand(part.shape, part.X_BS, bounds.lower.z(), bounds.upper.z());
    for (const Vector2d& p_B : outline ? geometry::Transformed(X_BO, *outline) : Polygon()) {
      for (std::size_t i = 0; i < plate.size(); ++i) {
        const Vector2d edge = (plate[(i + 1) % plate.size()] - plate[i]).normalized();
        double& along = overhang[std::abs(edge.y()) < std::abs(edge.x()) ? 1 : 0];
        along = std::max(along, -Cross(edge, p_B - plate[i]));
      }
    }
  }
  return overhang;
}

[[noreturn]] void FailUnsupported(const robot::Robot& robot, const std::string& object,
                                  const char* why) {
  throw base::ConfigError(fmt::format(
      "object '{}' cannot stand on the tray '{}' of '{}': {}; expected a center of mass over the "
      "part of its base that the plate carries; put it elsewhere (object_on_tray in the profile) "
      "or use a model whose base fits the plate",
      object, robot.profile.tray_link, robot.model.name, why));
}

PayloadSupport SupportOf(const simulation::Scene& scene, const world::ObjectState& object,
                         const TraySurface& surface) {
  const world::ObjectModel& model = *scene.world.ModelOf(object);
  const navigation::StandingLoad load = navigation::LoadOf(model);
  const geometry::Pose2 X_BO = geometry::Flatten(object.X_MO);  // the base is at the map's origin
  Polygon corners;
  for (const Polygon& part : ContactParts(model)) {
    const Polygon part_B = geometry::Transformed(X_BO, part);
    if (surface.outlines.empty()) corners.insert(corners.end(), part_B.begin(), part_B.end());
    for (const Polygon& plate : surface.outlines) {
      const Polygon carried = Clipped(part_B, plate);
      corners.insert(corners.end(), carried.begin(), carried.end());
    }
  }
  if (corners.empty()) {
    FailUnsupported(scene.robot, object.name,
                    "its lowest points, on which it is put, have no plate below them");
  }
  PayloadSupport support;
  const Eigen::Vector3d& p_OCom = model.mass_properties.p_BBcm;
  support.name = object.name;
  support.p_BO = {X_BO.x, X_BO.y};
  support.p_BCom = geometry::Transformed(X_BO, Polygon{p_OCom.head<2>()}).front();
  const Polygon base = geometry::ConvexHull(std::move(corners));
  if (!geometry::Contains(base, support.p_BCom)) {
    FailUnsupported(scene.robot, object.name,
                    "its center of mass is not over the part of its base that has a plate below");
  }
  support.support = geometry::Transformed({-support.p_BCom.x(), -support.p_BCom.y(), 0.0}, base);
  support.com_height = load.com_height;
  support.friction = std::min(load.friction, surface.friction);
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(X_BO.yaw).toRotationMatrix();
  support.gyration =
      R * (model.mass_properties.I_BBcm.topLeftCorner<2, 2>() / model.mass_properties.mass) *
      R.transpose();
  support.rolls = Rolls(model);
  if (!surface.outlines.empty()) support.overhang = OverhangOf(model, X_BO, surface);
  return support;
}

/// The least over the edges towards `direction` of what an edge bears of a motion across it.
/// A round base is a polygon of 24 corners: edges within half of 15 degrees count as square to the
/// direction, so that its radius counts in all directions.
template <typename Bears>
double LeastOverEdges(const PayloadSupport& payload, const Vector2d& direction, Bears bears) {
  constexpr double kSquare = 0.9912;  // cos(7.6 deg)
  double least = kUnlimited;
  const std::vector<Vector2d> normals = payload.Normals();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double across = normals[i].dot(direction);
    if (across < 1e-9) continue;
    const double reach = std::max(0.0, normals[i].dot(payload.support[i]));
    least = std::min(least, bears(normals[i], reach) / (across > kSquare ? 1.0 : across));
  }
  return least;
}

}  // namespace

std::vector<Vector2d> PayloadSupport::Normals() const {
  std::vector<Vector2d> normals;
  for (std::size_t i = 0; i < support.size(); ++i) {
    const Vector2d edge = (support[(i + 1) % support.size()] - support[i]).normalized();
    normals.emplace_back(edge.y(), -edge.x());
  }
  return normals;
}

double PayloadSupport::TippingAcceleration(const Vector2d& direction, double gravity) const {
  return LeastOverEdges(*this, direction, [&](const Vector2d&, double reach) {
    return gravity * reach / com_height;
  });
}

double PayloadSupport::TopplingSpeed(const Vector2d& direction, double gravity) const {
  return LeastOverEdges(*this, direction, [&](const Vector2d& normal, double reach) {
    const Vector2d axis(-normal.y(), normal.x());
    return physics::SuddenStopTopplingSpeed(reach, com_height, axis.dot(gyration * axis), gravity);
  });
}

std::vector<PayloadSupport> SupportsOnTray(const imagination::ImaginationSetup& setup,
                                           const std::vector<std::string>& objects) {
  const std::vector<world::ObjectState> placed =
      imagination::StartOnTray(setup, {}, objects).world.objects;
  const simulation::Scene& scene = *setup.scene;
  const TraySurface surface = SurfaceOf(scene);
  std::vector<PayloadSupport> supports;
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    try {
      supports.push_back(SupportOf(scene, placed[i], surface));
    } catch (const base::ConfigError& error) {
      errors.push_back(error.what());
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!simulation::Overlap(scene.world.ModelOf(placed[i])->collisions, placed[i].X_MO,
                               scene.world.ModelOf(placed[k])->collisions, placed[k].X_MO)) {
        continue;
      }
      errors.push_back(fmt::format(
          "objects '{}' and '{}' overlap on the tray of '{}'; expected room for both; name fewer "
          "or smaller objects, or change slot_distance of the scene",
          placed[k].name, placed[i].name, scene.robot.model.name));
    }
  }
  if (!errors.empty()) throw base::ConfigError(base::Join(errors, "\n"));
  return supports;
}

}  // namespace hires::reports
