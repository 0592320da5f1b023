#include "hires/robot/posture.h"

#include <algorithm>
#include <cmath>

#include "hires/robot/gripper.h"

namespace hires::robot {
namespace {

constexpr double kEncoderError = 0.02;  // [rad] or [m] over a limit that counts as the limit

/// Drivers name joints that follow others too, and encoders stray over a limit.
JointPositions Measured(const RobotModel& model, const JointPositions& joints) {
  JointPositions measured;
  for (const auto& [name, position] : joints) {
    const Joint* joint = FindJoint(model, name);
    if (joint != nullptr && !joint->mimics.empty()) continue;
    measured[name] = position;
    if (joint == nullptr || !joint->limits || joint->type == JointType::kContinuous) continue;
    const double nearest = std::clamp(position, joint->limits->lower, joint->limits->upper);
    if (std::abs(position - nearest) <= kEncoderError) measured[name] = nearest;
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
