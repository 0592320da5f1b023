#pragma once

#include <string>

#include "hires/robot/readings.h"

namespace hires::localisation {

/// What became of a scan.
enum class ScanOutcome {
  kUpdated,          ///< the belief stands on it
  kNotMoved,         ///< the robot has hardly moved since the last scan that was used
  kNoRanges,         ///< the scan is empty
  kBadAngles,        ///< no increment, no number, or more than one turn
  kNothingMeasured,  ///< no range is a number between the shortest and the longest
  kNothingMet,       ///< all ranges are as long as can be: free space, or a laser that sees nothing
  kNotFinite,        ///< time, odometry or the laser's place is no number
  kLate,             ///< older than the one before by less than robot::kClockReset: left out
  kTimeWentBack,     ///< a clock began again: goes on from this odometry, the belief stays
  kOdometryJumped    ///< faster than a robot drives: goes on from this odometry, the belief stays
};

/// What a scan measured between two ranges [m]: kUpdated where there is any, kNoRanges, kBadAngles,
/// kNothingMeasured or kNothingMet.
ScanOutcome Examine(const robot::ScanReading& scan, double shortest, double longest);

/// For people.
std::string ToString(ScanOutcome outcome);

/// Whether something is wrong with the scan or its odometry.
bool IsBad(ScanOutcome outcome);

}  // namespace hires::localisation
