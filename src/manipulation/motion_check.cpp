#include "manipulation/motion_check.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::manipulation {

ArmJoints Between(const ArmJoints& from, const ArmJoints& to, double share) {
  ArmJoints between(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) between[i] = from[i] + share * (to[i] - from[i]);
  return between;
}

double LargestDifference(const ArmJoints& a, const ArmJoints& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

MotionCheck::MotionCheck(const ArmScene& arm, const ArmPathParams& params)
    : arm_(arm),
      links_(arm.scene->MovedBy(arm.kinematics->joint_names())),
      resolution_(params.resolution),
      max_held_tilt_(params.max_held_tilt),
      posture_(arm.posture) {
  HIRES_CHECK(params.resolution > 0.0, "resolution > 0");
}

bool MotionCheck::IsWithinLimits(const ArmJoints& joints) const {
  const ArmJoints &lower = arm_.kinematics->lower(), &upper = arm_.kinematics->upper();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!(joints[i] >= lower[i] && joints[i] <= upper[i])) return false;
  }
  return true;
}

bool MotionCheck::IsTilted(const ArmJoints& joints) const {
  if (!arm_.upright_T) return false;
  const Eigen::Vector3d up_B =
      arm_.kinematics->ToolPose(arm_.posture, joints).rotation * arm_.upright_T->normalized();
  return up_B.z() < std::cos(max_held_tilt_);
}

Obstruction MotionCheck::WhyBlocked(const ArmJoints& joints) const {
  if (IsTilted(joints)) return {{}, "held object tilts"};
  arm_.kinematics->SetJoints(joints, &posture_);
  const auto touch = arm_.scene->FindTouch(arm_.X_MB, posture_, links_);
  return touch ? Obstruction{{touch->a, touch->b}, ToString(*touch)} : Obstruction{};
}

Obstruction MotionCheck::WhyBlocked(const ArmJoints& from, const ArmJoints& to) const {
  const int steps = static_cast<int>(std::ceil(LargestDifference(from, to) / resolution_));
  // Coarse points first, then those between: what is in the way is met early.
  int stride = 1;
  while (stride < steps) stride *= 2;
  for (; stride >= 1; stride /= 2) {
    for (int i = stride; i < steps; i += 2 * stride) {
      Obstruction why = WhyBlocked(Between(from, to, static_cast<double>(i) / steps));
      if (why) return why;
    }
  }
  return {};
}

}  // namespace hires::manipulation
