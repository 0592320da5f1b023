#include "hires/simulation/scene.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"

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

}  // namespace

std::shared_ptr<const Scene> MakeScene(world::World world, robot::Robot robot) {
  const robot::RobotProfile& profile = robot.profile;
  const auto X_RL = robot::ForwardKinematics(robot.model, profile.joints);
  const geometry::Pose3 X_BR = PoseOfLink(robot.model, X_RL, profile.base_link).Inverse();
  std::vector<geometry::Collision> shapes_B = robot::FrozenCollisions(robot.model, profile.joints);
  for (geometry::Collision& shape : shapes_B) shape.X_BS = X_BR * shape.X_BS;
  geometry::Pose3 X_BO;
  if (!profile.tray_link.empty()) {
    X_BO = X_BR * PoseOfLink(robot.model, X_RL, profile.tray_link) * profile.X_TO;
  }
  RobotClearance clearance(shapes_B, world);
  return std::make_shared<const Scene>(
      Scene{std::move(world), std::move(robot), std::move(shapes_B), std::move(clearance), X_BO});
}

}  // namespace hires::simulation
