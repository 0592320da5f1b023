#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/simulation/robot_simulator.h"
#include "physics/hazards.h"
#include "robot/urdf/floor_support.h"

namespace hires::simulation {

/// A robot with its payload as one rigid body on its support, joints frozen, that may tip over the
/// edges of that. A value.
struct RobotBalance {
  struct Edge {
    Eigen::Vector2d outward_B;  ///< unit normal
    physics::EdgeRocker rocker;
  };
  robot::FloorSupport support;
  geometry::MassProperties body_B;  ///< robot and payload
  std::vector<Edge> edges;
  double gravity{0.0};                       ///< [m/s^2]
  std::optional<geometry::Twist2> V_B{};     ///< of the base after the last step
  std::optional<std::size_t> tipped_over{};  ///< index of the edge

  bool IsStableAtRest() const;  ///< the center of mass is inside of the support
  /// [m/s^2] From which it begins to tip when its base accelerates along `direction_B` (unit
  /// vector): least g b / (c cos) over the edges behind. 0 where it falls at rest.
  double TippingAcceleration(const Eigen::Vector2d& direction_B) const;
  /// ... of the way that it drives: along its x axis, or in any direction.
  double TippingAcceleration(robot::Drive drive) const;
  double SidewaysTippingAcceleration() const;

  /// Integrates the motion of the base, at the end of a step of `dt` [s], as rotation about each
  /// edge (physics::EdgeRocker). @pre IsStableAtRest()
  void Step(const BaseMotion& motion, double dt);
  /// "tips from 2.00 m/s^2 (12.0 kg, center of mass 0.500 m high)".
  std::string Text(double tipping_acceleration) const;
  /// "over its rear edge: ..." and that.  @pre tipped_over
  std::string TippedText() const;
};

/// @param payload_B  what it carries, in the base frame.
/// @return none: the URDF has no masses.  @throws base::ConfigError as robot::ForwardKinematics.
std::optional<RobotBalance> BalanceOf(const robot::Robot& robot,
                                      const robot::JointPositions& joints,
                                      const std::vector<geometry::MassProperties>& payload_B,
                                      double gravity);
/// As the robot is in a simulator, with what it carries and holds, masses times `mass_factor`.
std::optional<RobotBalance> BalanceOf(const RobotSimulator& simulator, double mass_factor = 1.0);

}  // namespace hires::simulation
