#pragma once

#include "hires/manipulation/arm_path.h"

namespace hires::manipulation {

/// Tells whether one arm may be somewhere, or move straight in joint space. One per planning call.
class MotionCheck {
 public:
  MotionCheck(const ArmScene& arm, const ArmPathParams& params);

  /// What is in the way at these joint positions; nothing if they are free.
  Obstruction WhyBlocked(const ArmJoints& joints) const;
  bool IsFree(const ArmJoints& joints) const { return !WhyBlocked(joints); }
  bool IsWithinLimits(const ArmJoints& joints) const;

  /// What is in the way between two free positions, both ends left out; nothing if the way is free.
  Obstruction WhyBlocked(const ArmJoints& from, const ArmJoints& to) const;
  bool IsFree(const ArmJoints& from, const ArmJoints& to) const { return !WhyBlocked(from, to); }

  double resolution() const { return resolution_; }

 private:
  bool IsTilted(const ArmJoints& joints) const;

  const ArmScene& arm_;
  LinkMask links_;
  double resolution_, max_held_tilt_;
  mutable robot::JointPositions posture_;  // scratch
};

ArmJoints Between(const ArmJoints& from, const ArmJoints& to, double share);
double LargestDifference(const ArmJoints& a, const ArmJoints& b);  ///< [rad]

}  // namespace hires::manipulation
