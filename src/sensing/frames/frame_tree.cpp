#include "hires/sensing/frame_tree.h"

#include <cmath>

namespace hires::sensing {

std::string BareFrame(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

geometry::Twist2 MovedTo(const geometry::Pose2& X_CB, const geometry::Twist2& V_C) {
  const double vx = V_C.vx - V_C.wz * X_CB.y, vy = V_C.vy + V_C.wz * X_CB.x;
  const double c = std::cos(X_CB.yaw), s = std::sin(X_CB.yaw);
  return {c * vx + s * vy, -s * vx + c * vy, V_C.wz};
}

}  // namespace hires::sensing
