#include "hires/robot/posture.h"

#include <algorithm>
#include <cmath>

#include "hires/robot/gripper.h"

namespace hires::robot {
namespace {

constexpr double kEncoderError = 0.02;  // [rad] or [m] over a limit that counts as the limit

/// The limit where a position lies a little beyond it.
double Clamped(const JointLimits& limits, double position) {
  const double nearest = std::clamp(position, limits.lower, limits.upper);
  return std::abs(position - nearest) <= kEncoderError ? nearest : position;
}

/// Drivers name joints that follow others too, and encoders stray over a limit.
JointPositions Measured(const RobotModel& model, const JointPositions& joints) {
  JointPositions measured = joints;
  for (const Link& link : model.links) {
    if (!link.joint) continue;
    const auto found = measured.find(link.joint->name);
    if (found == measured.end()) continue;
    if (!link.joint->mimics.empty()) {
      measured.erase(found);
    } else if (link.joint->limits && link.joint->type != JointType::kContinuous) {
      found->second = Clamped(*link.joint->limits, found->second);
    }
  }
  return measured;
}

}  // namespace

JointPositions PostureOf(const Robot& robot, const JointPositions& joints) {
  JointPositions posture = Measured(robot.model, joints);
  const auto& upper_body = robot.profile.upper_body;
  // A gap or finger angle that is given leads; the driving posture must not contradict it.
  if (upper_body) CompleteGrippers(*upper_body, &posture);
  posture.insert(robot.profile.joints.begin(), robot.profile.joints.end());
  if (upper_body) CompleteGrippers(*upper_body, &posture);
  return posture;
}

}  // namespace hires::robot
