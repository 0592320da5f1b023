#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/physics/physics_world.h"
#include "hires/simulation/robot_clearance.h"
#include "hires/simulation/scene.h"

namespace hires::simulation {

/// A robot whose joints stay as they are. All of it can be one driven body in a PhysicsWorld.
class FrozenRobot {
 public:
  /// @param joints  as robot::PostureOf takes them.
  FrozenRobot(std::shared_ptr<const Scene> scene, const robot::JointPositions& joints);

  const robot::JointPositions& joints() const { return joints_; }
  const std::vector<geometry::Collision>& shapes_B() const;
  /// @throws base::ConfigError if there is no such link.
  geometry::Pose3 X_MLink(const geometry::Pose3& X_MB, const std::string& link) const;

  /// Becomes one body of `physics`, which outlives this, with the shapes of what it holds.
  void AddBody(const geometry::Pose3& X_MB, const std::vector<geometry::Collision>& held_B,
               physics::PhysicsWorld* physics);
  /// Before a step of physics. @pre it has a body
  void Move(const geometry::Pose3& X_MB, const geometry::Pose3& X_MBnext);
  /// With a static body. @pre it has a body
  std::optional<RobotContact> FindContact(const geometry::Pose2& X_MB) const;

 private:
  std::shared_ptr<const Scene> scene_;
  robot::JointPositions joints_;
  // Where the posture is not the driving one, whose shapes and clearance the scene has:
  std::optional<std::vector<geometry::Collision>> shapes_B_;
  std::optional<RobotClearance> clearance_;
  physics::PhysicsWorld* physics_{nullptr};
  physics::BodyId body_{0};
};

}  // namespace hires::simulation
