#include "hires/simulation/free_start.h"

#include <optional>

#include "hires/robot/posture.h"

namespace hires::simulation {
namespace {

/// Of the robot with these joints; nothing where that is the scene's own clearance.
std::optional<RobotClearance> ClearanceFor(const Scene& scene,
                                           const robot::JointPositions& joints) {
  const robot::JointPositions posture = robot::PostureOf(scene.robot, joints);
  if (posture == robot::PostureOf(scene.robot, {})) return std::nullopt;
  return RobotClearance(FrozenShapes(scene.robot, posture), scene.world);
}

}  // namespace

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
