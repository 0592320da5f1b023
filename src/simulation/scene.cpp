#include "hires/simulation/scene.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "simulation/joint_drives.h"
#include "simulation/link_bodies.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

geometry::Pose3 PoseOfLink(const robot::RobotModel& model, const std::vector<geometry::Pose3>& X_RL,
                           const std::string& name) {
  const auto link = model.FindLink(name);
  if (!link) {
    throw base::ConfigError(fmt::format("robot '{}': {}", model.name,
                                        base::UnknownName("link", name, model.LinkNames())));
  }
  return X_RL[*link];
}

std::vector<geometry::Collision> ShapesOfTheBase(const robot::Robot& robot,
                                                 const std::vector<geometry::Collision>& all) {
  if (!robot.profile.upper_body) return all;
  const robot::JointPositions posture = PostureOf(robot, {});
  const JointDrives drives(robot, posture);
  return LinkBodies(robot, MovingJoints(robot, drives), posture).bodies().front().collisions;
}

}  // namespace

std::vector<geometry::Collision> FrozenShapes(const robot::Robot& robot,
                                              const robot::JointPositions& posture) {
  const auto X_RL = robot::ForwardKinematics(robot.model, posture);
  const geometry::Pose3 X_BR = PoseOfLink(robot.model, X_RL, robot.profile.base_link).Inverse();
  std::vector<geometry::Collision> shapes_B = robot::FrozenCollisions(robot.model, posture);
  for (geometry::Collision& shape : shapes_B) shape.X_BS = X_BR * shape.X_BS;
  return shapes_B;
}

std::shared_ptr<const Scene> MakeScene(world::World world, robot::Robot robot,
                                       const sensing::MemoryParams& memory, const Sight& sight) {
  if (sight.scans) RefuseTiltedLaser(robot);
  const robot::RobotProfile& profile = robot.profile;
  const auto X_RL = robot::ForwardKinematics(robot.model, profile.joints);
  const geometry::Pose3 X_BR = PoseOfLink(robot.model, X_RL, profile.base_link).Inverse();
  std::vector<geometry::Collision> shapes_B = FrozenShapes(robot, profile.joints);
  geometry::Pose3 X_BO;
  if (!profile.tray_link.empty()) {
    X_BO = X_BR * PoseOfLink(robot.model, X_RL, profile.tray_link) * profile.X_TO;
  }
  const std::optional<double> laser_height = robot::LaserHeight(robot);
  RobotClearance clearance(shapes_B, world);
  std::vector<geometry::Collision> base_B = ShapesOfTheBase(robot, shapes_B);
  RobotClearance base_clearance(base_B, world);
  std::shared_ptr<const perception::Surroundings> surroundings;
  if (profile.upper_body || laser_height)
    surroundings = std::make_shared<const perception::Surroundings>(world);
  return std::make_shared<const Scene>(Scene{std::move(world),
                                             std::move(robot),
                                             std::move(shapes_B),
                                             std::move(clearance),
                                             X_BO,
                                             std::move(base_B),
                                             std::move(base_clearance),
                                             std::move(surroundings),
                                             memory,
                                             sight,
                                             laser_height,
                                             nullptr,
                                             nullptr,
                                             {}});
}

}  // namespace hires::simulation
