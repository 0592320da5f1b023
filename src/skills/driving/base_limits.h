#pragma once

#include <algorithm>

#include "hires/robot/robot_profile.h"

namespace hires::skills {

/// What a base does of a motion set: its controller clips velocities and ramps accelerations within
/// limits of its own. Who follows arcs has to know, or steers later than it plans to.
inline robot::MotionSet WithinLimits(const robot::MotionSet& wanted,
                                     const robot::MotionSet& limits) {
  return {std::min(wanted.max_linear_velocity, limits.max_linear_velocity),
          std::min(wanted.max_angular_velocity, limits.max_angular_velocity),
          std::min(wanted.max_linear_acceleration, limits.max_linear_acceleration),
          std::min(wanted.max_angular_acceleration, limits.max_angular_acceleration)};
}

}  // namespace hires::skills
