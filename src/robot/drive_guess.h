#pragma once

#include <string>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// As profiles spell it.
std::string ToString(Drive drive);

struct DriveGuess {
  Drive drive{Drive::kDifferential};
  std::string why;  ///< "two parallel wheels: left_joint, right_joint"
};

/// How a robot drives, from its wheels: continuous joints about a horizontal axis. Wheels that turn
/// about a vertical axis, too, are casters. No wheel but three casters and more (a PR2), or three
/// wheels of which no two are parallel, drive anywhere; all else is taken to drive differentially,
/// which a robot that can do more can do as well.
DriveGuess GuessDrive(const RobotModel& model);

}  // namespace hires::robot
