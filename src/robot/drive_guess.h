#pragma once

#include <string>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// As profiles spell it, and back. @pre one of the three.
std::string ToString(Drive drive);
Drive DriveOf(const std::string& name);

struct DriveGuess {
  Drive drive{Drive::kDifferential};
  double min_turning_radius{0.0};  ///< [m] > 0 where the drive is kCarLike
  std::string why;                 ///< "two parallel wheels: left_joint, right_joint"
};

/// How a robot drives, from its wheels: continuous joints about a horizontal axis. Wheels that turn
/// about a vertical axis, too, are casters; they are steered where the joint that turns them has
/// limits or "steer" in its name. Parallel wheels that keep their direction and one or more that
/// are steered make a car. No wheel but three casters and more (a PR2), or three wheels of which no
/// two are parallel, drive anywhere; all else is taken to drive differentially, which a robot that
/// can do more, a car aside, can do as well.
///
/// A car's least turning radius is that of the steered wheel which allows least: its distance from
/// the axle over the tangent of its largest angle, the smaller one of left and right (0.5 rad for a
/// joint that has no limits), and its distance from the middle, as the inner wheel is turned most.
DriveGuess GuessDrive(const RobotModel& model);

}  // namespace hires::robot
