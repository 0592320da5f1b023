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
  std::string why;                 ///< "two parallel wheels: left_joint, right_joint; but ..."
  std::string misfit{};            ///< what stands behind that "but": see GuessDrive
};

/// How a robot drives, from its wheels: continuous joints about a horizontal axis. Wheels that turn
/// about a vertical axis, too, are casters; they are steered where the joint that turns them has
/// limits or "steer" in its name. Parallel wheels that keep their direction and one or more that
/// are steered make a car, and so does one wheel that keeps its direction (a bicycle); that of a
/// car's plugin are steered whatever their joints are. No wheel but three casters and more (a PR2)
/// that turn far enough to roll sideways (else they make a car, front against rear), or three
/// wheels of which no two are parallel, drive anywhere; of all else a simulator's plugin may tell;
/// the rest is taken to drive differentially, which a robot that can do more, a car aside, can do
/// as well.
///
/// Where the axle of parallel wheels is not below the origin of base_link, about which a base turns
/// here, or does not lie across its x axis, along which it drives, `misfit` says so.
///
/// A car's least turning radius is that of the steered wheel which allows least: its distance from
/// the axle over the tangent of its largest angle, the smaller one of left and right (for a
/// joint that has no limits those of one beside it, or 0.5 rad), and its distance from the middle,
/// as the inner wheel is turned most.
/// @param base_link  an unknown one counts as the root.
DriveGuess GuessDrive(const RobotModel& model, const std::string& base_link);

}  // namespace hires::robot
