#pragma once

#include "hires/robot/robot_profile.h"
#include "hires/simulation/base_drive.h"

namespace hires::simulation {

/// What happened to the robot that may disturb its load; the latest time of each [s].
struct Disturbances {
  double late_command{-1e9};  ///< the base braked because no command came in time
  double braking{-1e9};       ///< more than half of the largest acceleration, against the motion
  double accelerating{-1e9};  ///< ... with the motion
  double turning{-1e9};       ///< angular acceleration above half of the largest

  /// How the base moves at `time`. @param limits  of its controller.
  void Note(const BaseMotion& motion, const robot::MotionSet& limits, double time);
};

}  // namespace hires::simulation
