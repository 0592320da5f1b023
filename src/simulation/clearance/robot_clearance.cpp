#include "hires/simulation/robot_clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/clearance/touch_shape.h"
#include "world/floor_level.h"

namespace hires::simulation {
namespace {

constexpr double kRounding = 1e-9;  // [m] by which a distance may be told wrongly

/// Whether an edge of the outline has the whole ball, and `gap` beside it, on its far side. Costs a
/// hundredth of the exact distance, and answers for nearly all pairs that do not touch.
bool IsOutside(const geometry::Polygon& outline, const Eigen::Vector2d& centre, double radius,
               double gap) {
  const double apart = radius + gap + kRounding;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d along = outline[i + 1 == outline.size() ? 0 : i + 1] - from;
    const Eigen::Vector2d to = centre - from;
    const double outwards = along.y() * to.x() - along.x() * to.y();  // times the edge's length
    if (outwards > 0.0 && outwards * outwards > apart * apart * along.squaredNorm()) return true;
  }
  return false;
}

/// The middle of what two convex outlines share, corners and crossings of edges taken together;
/// nothing where they share nothing.
std::optional<Eigen::Vector2d> MiddleOfBoth(const geometry::Polygon& a,
                                            const geometry::Polygon& b) {
  std::vector<Eigen::Vector2d> shared;
  for (const Eigen::Vector2d& p : a)
    if (geometry::Contains(b, p)) shared.push_back(p);
  for (const Eigen::Vector2d& p : b)
    if (geometry::Contains(a, p)) shared.push_back(p);
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
    return u.x() * v.y() - u.y() * v.x();
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d along_a = a[(i + 1) % a.size()] - a[i];
    for (std::size_t k = 0; k < b.size(); ++k) {
      const Eigen::Vector2d along_b = b[(k + 1) % b.size()] - b[k];
      const double turn = cross(along_a, along_b);
      if (turn == 0.0) continue;
      const double s = cross(b[k] - a[i], along_b) / turn;
      const double t = cross(b[k] - a[i], along_a) / turn;
      if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) shared.push_back(a[i] + s * along_a);
    }
  }
  if (shared.empty()) return std::nullopt;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : shared) middle += p / static_cast<double>(shared.size());
  return middle;
}

/// What of a shape is higher than what a robot stands on; nothing where all of it is floor.
std::optional<geometry::Collision> AboveFloor(geometry::Collision shape,
                                              const geometry::Pose3& X_MB, double floor_top) {
  using Mesh = std::shared_ptr<const geometry::TriangleMesh>;
  const geometry::Pose3 X_MS = X_MB * shape.X_BS;
  if (const auto* mesh = std::get_if<Mesh>(&shape.shape)) {
    const Mesh left = world::WithoutFloor(*mesh, X_MS, floor_top);
    if (left == nullptr) return std::nullopt;
    shape.shape = left;
    return shape;
  }
  if (geometry::BoundsOf(shape.shape, X_MS).upper.z() <= floor_top) return std::nullopt;
  return shape;
}

}  // namespace

std::string ToString(const RobotContact& contact) {
  return contact.robot_part + " touches " + contact.obstacle + PlaceText(contact);
}

std::string PlaceText(const RobotContact& contact) {
  std::string text;
  if (contact.p_M)
    text = fmt::format(" at x {:.2f} m, y {:.2f} m", contact.p_M->x(), contact.p_M->y());
  if (!contact.source.empty()) text += fmt::format(" ({})", contact.source);
  return text;
}

RobotContact ContactWith(const geometry::Collision& part_M, const world::StaticBody& body,
                         const world::World& world) {
  const TouchShape part(part_M.shape);
  for (const geometry::Collision& shape : body.collisions) {
    const TouchShape obstacle(shape.shape);
    const geometry::Pose3 X_MS = body.X_MB * shape.X_BS;
    if (!part.Touches(part_M.X_BS, obstacle, X_MS)) continue;
    const std::string name = world::NameOf(body, shape);
    return {part_M.name, name, part.MeetingPoint(part_M.X_BS, obstacle, X_MS).head<2>(),
            world::SourceOf(name, world)};
  }
  return {part_M.name, body.name};  // which touch by a hair, as others count
}

std::optional<RobotClearance::Prism> RobotClearance::MakePrism(const std::string& name,
                                                               const std::string& source,
                                                               const geometry::Collision& shape,
                                                               const geometry::Pose3& X_WB) {
  const geometry::Pose3 X_WS = X_WB * shape.X_BS;
  const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_WS);
  const auto outline =
      geometry::OutlineInBand(shape.shape, X_WS, bounds.lower.z(), bounds.upper.z());
  if (!outline) return std::nullopt;
  Prism prism{name,
              source,
              *outline,
              bounds.lower.z(),
              bounds.upper.z(),
              {0.0, 0.0},
              0.0,
              std::make_shared<const TouchShape>(shape.shape),
              X_WS};
  for (const Eigen::Vector2d& p : *outline) prism.centre += p / outline->size();
  for (const Eigen::Vector2d& p : *outline) {
    prism.radius = std::max(prism.radius, (p - prism.centre).norm());
  }
  return prism;
}

RobotClearance::RobotClearance(const std::vector<geometry::Collision>& robot_B,
                               const world::World& world) {
  for (const geometry::Collision& part : robot_B) {
    if (auto prism = MakePrism(part.name, "", part, {})) {
      robot_radius_ = std::max(robot_radius_, geometry::CircumscribedRadius(prism->outline));
      robot_.push_back(*std::move(prism));
    }
  }
  double lowest = 0.0;
  for (const Prism& part : robot_) lowest = std::min(lowest, part.z_min);
  const double floor_top = lowest + world::kFloorStep;
  for (const world::StaticBody& body : world.statics) {
    for (const geometry::Collision& whole : body.collisions) {
      const std::string name = world::NameOf(body, whole);
      const auto shape = AboveFloor(whole, body.X_MB, floor_top);
      if (!shape) continue;
      if (auto prism = MakePrism(name, world::SourceOf(name, world), *shape, body.X_MB)) {
        obstacles_.push_back(*std::move(prism));
      }
    }
  }
}

bool RobotClearance::IsExact(const Prism& part, const Prism& obstacle) {
  return !part.shape->is_mesh() && !obstacle.shape->is_mesh();
}

template <typename Visit>
void RobotClearance::ForNearPairs(const geometry::Pose2& X_MB, double limit, Visit visit) const {
  const double c = std::cos(X_MB.yaw), s = std::sin(X_MB.yaw);
  const auto in_map = [&](const Eigen::Vector2d& p_B) {
    return Eigen::Vector2d(X_MB.x + c * p_B.x() - s * p_B.y(), X_MB.y + s * p_B.x() + c * p_B.y());
  };
  for (const Prism& obstacle : obstacles_) {
    const double reach = robot_radius_ + obstacle.radius + limit;
    if ((obstacle.centre - X_MB.position()).squaredNorm() > reach * reach) continue;
    for (const Prism& part : robot_) {
      if (part.z_min > obstacle.z_max || obstacle.z_min > part.z_max) continue;
      const double near = part.radius + obstacle.radius + limit;
      const Eigen::Vector2d centre = in_map(part.centre);
      if ((centre - obstacle.centre).squaredNorm() > near * near) continue;
      if (IsOutside(obstacle.outline, centre, part.radius, limit)) continue;
      const double distance =
          geometry::Distance(geometry::Transformed(X_MB, part.outline), obstacle.outline);
      if (distance <= limit && !visit(part, obstacle, distance)) return;
    }
  }
}

std::optional<RobotContact> RobotClearance::FindContact(const geometry::Pose2& X_MB) const {
  return ContactAt(X_MB, false);
}

std::optional<RobotContact> RobotClearance::FindExactContact(const geometry::Pose2& X_MB) const {
  return ContactAt(X_MB, true);
}

std::optional<RobotContact> RobotClearance::ContactAt(const geometry::Pose2& X_MB,
                                                      bool exactly) const {
  std::optional<RobotContact> contact;
  const geometry::Pose3 X_MF = geometry::Lift(X_MB);
  ForNearPairs(X_MB, 0.0, [&](const Prism& part, const Prism& obstacle, double) {
    const bool by_outline = !exactly && IsExact(part, obstacle);
    if (!by_outline && !part.shape->Touches(X_MF * part.X_FS, *obstacle.shape, obstacle.X_FS)) {
      return true;
    }
    contact = RobotContact{part.name, obstacle.name, {}, obstacle.source};
    if (by_outline) {
      contact->p_M = MiddleOfBoth(geometry::Transformed(X_MB, part.outline), obstacle.outline);
    } else {
      contact->p_M = part.shape->MeetingPoint(X_MF * part.X_FS, *obstacle.shape, obstacle.X_FS)
                         .template head<2>();
    }
    return false;
  });
  return contact;
}

double RobotClearance::Clearance(const geometry::Pose2& X_MB, double limit) const {
  double nearest = limit;
  const geometry::Pose3 X_MF = geometry::Lift(X_MB);
  ForNearPairs(X_MB, limit, [&](const Prism& part, const Prism& obstacle, double distance) {
    if (!IsExact(part, obstacle)) {
      distance = part.shape->Distance(X_MF * part.X_FS, *obstacle.shape, obstacle.X_FS);
    }
    nearest = std::min(nearest, distance);
    return true;
  });
  return nearest;
}

}  // namespace hires::simulation
