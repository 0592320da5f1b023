#include "hires/simulation/disturbances.h"

#include <cmath>

namespace hires::simulation {

void Disturbances::Note(const BaseMotion& motion, const robot::MotionSet& limits, double time) {
  const double power = motion.A_B.vx * motion.V_B.vx + motion.A_B.vy * motion.V_B.vy;
  if (motion.timed_out) late_command = time;
  if (std::hypot(motion.A_B.vx, motion.A_B.vy) > 0.5 * limits.max_linear_acceleration) {
    (power < 0.0 ? braking : accelerating) = time;
  }
  if (std::abs(motion.A_B.wz) > 0.5 * limits.max_angular_acceleration) turning = time;
}

}  // namespace hires::simulation
