#pragma once

#include <string>

#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Many logs do not say what the laser writes where it meets nothing, which is the most that it
/// measures in its mode: 8.191 m, say. That shows: among the largest ranges of the log, which noise
/// spreads over 15 cm, one stands in it again and again, to the digit (in more than 0.5 % of the
/// beams), in beams beside each other, from places apart, and three times as often as all ranges up
/// to 10 cm from it, over which the noise of a wall would spread (or, in more than 5 % of the
/// beams, ten times as often as any one of them). Where it does, it becomes the `range_max` of all
/// scans.
/// @return what to warn of; empty where it does not, or the log says it itself.
std::string TakeLaserMaximum(RobotLog* log);

}  // namespace hires::localisation
