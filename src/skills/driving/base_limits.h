#pragma once

#include <algorithm>

#include "hires/robot/robot_profile.h"

namespace hires::skills {

/// 0 where neither defines one.
inline double LowerDeceleration(double wanted, double limit, double of_wanted, double of_limit) {
  return wanted == 0.0 && limit == 0.0 ? 0.0 : std::min(of_wanted, of_limit);
}

/// What a base does of a motion set: its controller clips velocities and ramps accelerations within
/// limits of its own. Who follows arcs has to know, or steers later than it plans to.
inline robot::MotionSet WithinLimits(const robot::MotionSet& wanted,
                                     const robot::MotionSet& limits) {
  return {std::min(wanted.max_linear_velocity, limits.max_linear_velocity),
          std::min(wanted.max_angular_velocity, limits.max_angular_velocity),
          std::min(wanted.max_linear_acceleration, limits.max_linear_acceleration),
          std::min(wanted.max_angular_acceleration, limits.max_angular_acceleration),
          LowerDeceleration(wanted.max_linear_deceleration, limits.max_linear_deceleration,
                            wanted.linear_deceleration(), limits.linear_deceleration()),
          LowerDeceleration(wanted.max_angular_deceleration, limits.max_angular_deceleration,
                            wanted.angular_deceleration(), limits.angular_deceleration())};
}

}  // namespace hires::skills
