#include "hires/robot/observation.h"

namespace hires::robot {

bool RobotState::operator==(const RobotState& other) const {
  return X_MB.x == other.X_MB.x && X_MB.y == other.X_MB.y && X_MB.yaw == other.X_MB.yaw &&
         V_B.vx == other.V_B.vx && V_B.vy == other.V_B.vy && V_B.wz == other.V_B.wz &&
         joints == other.joints;
}

}  // namespace hires::robot
