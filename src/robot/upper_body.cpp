#include "hires/robot/upper_body.h"

namespace hires::robot {

double AccelerationOf(const UpperBodyProfile& profile, const std::string& joint) {
  const auto found = profile.accelerations.find(joint);
  return found == profile.accelerations.end() ? profile.default_acceleration : found->second;
}

std::vector<std::string> JointsOfGroup(const UpperBodyProfile& profile, const std::string& group) {
  if (group == "torso") return {profile.torso_joint};
  if (group == "head") return {profile.head_pan_joint, profile.head_tilt_joint};
  const auto arm = profile.arms.find(group);
  return arm == profile.arms.end() ? std::vector<std::string>{} : arm->second.joints;
}

}  // namespace hires::robot
