#include "simulation/floor/robot_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "hires/robot/posture.h"

namespace hires::simulation {

using Eigen::Vector2d;

bool RobotBalance::IsStableAtRest() const {
  return std::all_of(edges.begin(), edges.end(),
                     [](const Edge& edge) { return edge.rocker.support > 0.0; });
}

double RobotBalance::TippingAcceleration(const Vector2d& direction_B) const {
  if (!IsStableAtRest()) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges) {
    const double cosine = -edge.outward_B.dot(direction_B);
    if (cosine > 1e-9) least = std::min(least, edge.rocker.TippingAcceleration(gravity) / cosine);
  }
  return least;
}

double RobotBalance::TippingAcceleration(robot::Drive drive) const {
  double least =
      std::min(TippingAcceleration(Vector2d::UnitX()), TippingAcceleration(-Vector2d::UnitX()));
  if (drive != robot::Drive::kOmnidirectional) return least;
  for (const Edge& edge : edges) least = std::min(least, TippingAcceleration(-edge.outward_B));
  return least;
}

double RobotBalance::SidewaysTippingAcceleration() const {
  return std::min(TippingAcceleration(Vector2d::UnitY()), TippingAcceleration(-Vector2d::UnitY()));
}

void RobotBalance::Step(const BaseMotion& motion, double dt) {
  const geometry::Twist2 now = motion.V_B, before = V_B.value_or(now);
  V_B = now;
  // Of the center of mass, in the base frame, which turns.
  const Vector2d p = body_B.p_BBcm.head<2>();
  const double turn = (now.wz - before.wz) / dt, w2 = now.wz * now.wz;
  const Vector2d acceleration(
      (now.vx - before.vx) / dt - now.wz * now.vy - turn * p.y() - w2 * p.x(),
      (now.vy - before.vy) / dt + now.wz * now.vx + turn * p.x() - w2 * p.y());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges[i].rocker.Step(-edges[i].outward_B.dot(acceleration), gravity, dt);
    if (!tipped_over && edges[i].rocker.is_over()) tipped_over = i;
  }
}

std::string RobotBalance::Text(double tipping_acceleration) const {
  return fmt::format("tips from {:.2f} m/s^2 ({:.1f} kg, center of mass {:.3f} m high)",
                     tipping_acceleration, body_B.mass, body_B.p_BBcm.z());
}

std::string RobotBalance::TippedText() const {
  const Vector2d& n = edges[*tipped_over].outward_B;
  const char* side = std::abs(n.x()) < std::abs(n.y()) ? (n.y() > 0.0 ? "left" : "right")
                                                       : (n.x() > 0.0 ? "front" : "rear");
  return fmt::format("over its {} edge: {}", side, Text(TippingAcceleration(-n)));
}

std::optional<RobotBalance> BalanceOf(const robot::Robot& robot,
                                      const robot::JointPositions& joints,
                                      const std::vector<geometry::MassProperties>& payload_B,
                                      double gravity) {
  RobotBalance balance;
  balance.support = robot::FloorSupportOf(robot, joints);
  if (!balance.support.body) return std::nullopt;
  std::vector<geometry::MassProperties> parts{*balance.support.body};
  parts.insert(parts.end(), payload_B.begin(), payload_B.end());
  const geometry::MassProperties body = balance.body_B = geometry::Together(parts);
  balance.gravity = gravity;
  const geometry::Polygon& polygon = balance.support.polygon;
  const double c =
      std::max(body.p_BBcm.z(), 1e-3);  // all of it on the floor tips at no acceleration
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    const Vector2d outward(along.y(), -along.x());  // corners are counter-clockwise
    const double b = outward.dot(polygon[i] - body.p_BBcm.head<2>());
    const Eigen::Vector3d axis(along.x(), along.y(), 0.0);
    const double inertia = axis.dot(body.I_BBcm * axis) / body.mass + b * b + c * c;
    balance.edges.push_back({outward, {b, c, inertia}});
  }
  return balance;
}

std::optional<RobotBalance> BalanceOf(const RobotSimulator& simulator, double mass_factor) {
  const Scene& scene = simulator.scene();
  std::set<int> payload(simulator.carried().begin(), simulator.carried().end());
  const std::vector<world::ObjectState> objects = simulator.GetWorldState().objects;
  for (int i = 0; i < static_cast<int>(objects.size()); ++i)
    if (!objects[i].attached_to.empty()) payload.insert(i);
  const geometry::Pose3 X_BM = simulator.X_MB().Inverse();
  std::vector<geometry::MassProperties> payload_B;
  for (const int i : payload) {
    geometry::MassProperties body = scene.world.ModelOf(objects[i])->mass_properties;
    body.mass *= mass_factor;
    body.I_BBcm *= mass_factor;
    payload_B.push_back(geometry::InFrame(X_BM * objects[i].X_MO, body));
  }
  const auto joints = robot::PostureOf(scene.robot, simulator.GetRobotState().joints);
  return BalanceOf(scene.robot, joints, payload_B, scene.world.gravity);
}

}  // namespace hires::simulation
