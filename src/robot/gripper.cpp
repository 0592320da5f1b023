#include "hires/robot/gripper.h"

#include <algorithm>
#include <cmath>

namespace hires::robot {
namespace {

/// Sideways way of a finger tip per length of the finger.
double SwingAt(const GripperProfile& gripper, double angle) {
  return std::sin(gripper.finger_slant + angle) - std::sin(gripper.finger_slant);
}

}  // namespace

double GapOf(const GripperProfile& gripper, double finger_position) {
  if (gripper.fingers == FingerMotion::kSliding) {
    return std::clamp(2.0 * finger_position, 0.0, gripper.max_gap);
  }
  const double angle = std::clamp(finger_position, 0.0, gripper.max_finger_angle);
  if (angle == gripper.max_finger_angle) return gripper.max_gap;  // not a rounding error beside it
  return gripper.max_gap * SwingAt(gripper, angle) / SwingAt(gripper, gripper.max_finger_angle);
}

double FingerPositionOf(const GripperProfile& gripper, double gap) {
  if (gripper.fingers == FingerMotion::kSliding) return 0.5 * std::clamp(gap, 0.0, gripper.max_gap);
  const double share = std::clamp(gap / gripper.max_gap, 0.0, 1.0);
  const double swing = share * SwingAt(gripper, gripper.max_finger_angle);
  const double angle = std::asin(swing + std::sin(gripper.finger_slant)) - gripper.finger_slant;
  return std::clamp(angle, 0.0, gripper.max_finger_angle);
}

void SetGap(const GripperProfile& gripper, const ArmProfile& arm, double gap,
            JointPositions* joints) {
  (*joints)[arm.gripper_joint] = std::clamp(gap, 0.0, gripper.max_gap);
  (*joints)[arm.finger_joint] = FingerPositionOf(gripper, gap);
}

void CompleteGrippers(const UpperBodyProfile& profile, JointPositions* joints) {
  for (const auto& [name, arm] : profile.arms) {
    const auto gap = joints->find(arm.gripper_joint);
    const auto angle = joints->find(arm.finger_joint);
    if (gap != joints->end()) {
      SetGap(profile.gripper, arm, gap->second, joints);
    } else if (angle != joints->end()) {
      (*joints)[arm.gripper_joint] = GapOf(profile.gripper, angle->second);
    }
  }
}

}  // namespace hires::robot
