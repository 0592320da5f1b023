#include "hires/simulation/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/gripper.h"
#include "hires/simulation/joint_drives.h"
#include "hires/simulation/link_bodies.h"

namespace hires::simulation {
namespace {

constexpr double kEncoderError = 0.02;  // [rad] or [m] over a limit that counts as the limit

geometry::Pose3 PoseOfLink(const robot::RobotModel& model, const std::vector<geometry::Pose3>& X_RL,
                           const std::string& name) {
  const auto link = model.FindLink(name);
  if (!link) {
    throw base::ConfigError(fmt::format("robot '{}': {}", model.name,
                                        base::UnknownName("link", name, model.LinkNames())));
  }
  return X_RL[*link];
}

/// Drivers name joints that follow others too, and encoders stray over a limit.
robot::JointPositions Measured(const robot::RobotModel& model,
                               const robot::JointPositions& joints) {
  robot::JointPositions measured;
  for (const auto& [name, position] : joints) {
    const robot::Joint* joint = robot::FindJoint(model, name);
    if (joint != nullptr && !joint->mimics.empty()) continue;
    measured[name] = position;
    if (joint == nullptr || !joint->limits || joint->type == robot::JointType::kContinuous)
      continue;
    const double nearest = std::clamp(position, joint->limits->lower, joint->limits->upper);
    if (std::abs(position - nearest) <= kEncoderError) measured[name] = nearest;
  }
  return measured;
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

robot::JointPositions PostureOf(const robot::Robot& robot, const robot::JointPositions& joints) {
  robot::JointPositions posture = Measured(robot.model, joints);
  const robot::UpperBodyProfile* upper_body =
      robot.profile.upper_body ? &*robot.profile.upper_body : nullptr;
  // A gap or finger angle that is given leads; the driving posture must not contradict it.
  if (upper_body) robot::CompleteGrippers(*upper_body, &posture);
  posture.insert(robot.profile.joints.begin(), robot.profile.joints.end());
  if (upper_body) robot::CompleteGrippers(*upper_body, &posture);
  return posture;
}

std::shared_ptr<const Scene> MakeScene(world::World world, robot::Robot robot,
                                       const sensing::MemoryParams& memory) {
  const robot::RobotProfile& profile = robot.profile;
  const auto X_RL = robot::ForwardKinematics(robot.model, profile.joints);
  const geometry::Pose3 X_BR = PoseOfLink(robot.model, X_RL, profile.base_link).Inverse();
  std::vector<geometry::Collision> shapes_B = FrozenShapes(robot, profile.joints);
  geometry::Pose3 X_BO;
  if (!profile.tray_link.empty()) {
    X_BO = X_BR * PoseOfLink(robot.model, X_RL, profile.tray_link) * profile.X_TO;
  }
  RobotClearance clearance(shapes_B, world);
  std::vector<geometry::Collision> base_B = ShapesOfTheBase(robot, shapes_B);
  RobotClearance base_clearance(base_B, world);
  std::shared_ptr<const perception::Surroundings> surroundings;
  if (profile.upper_body) surroundings = std::make_shared<const perception::Surroundings>(world);
  return std::make_shared<const Scene>(
      Scene{std::move(world), std::move(robot), std::move(shapes_B), std::move(clearance), X_BO,
            std::move(base_B), std::move(base_clearance), std::move(surroundings), memory});
}

}  // namespace hires::simulation
