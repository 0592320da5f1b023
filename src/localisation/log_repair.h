#pragma once

#include <string>
#include <vector>

#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// The lines of a log's file from which its readings came: as many as there are, and in order.
struct LogLines {
  std::vector<int> odometry, scans;
};

/// Times that do not advance over a drive (all equal, or rounded to steps far longer than from
/// reading to reading) say nothing of speed. Where more than half of the readings of a kind have
/// the time of the one before, readings of one time follow each other in the order of lines, as
/// fast as the odometry drives 0.5 m/s and turns 0.5 rad/s, but not beyond the next time.
/// @return what to warn of; empty where times advance, and nothing was done.
std::string SpreadEqualTimes(const LogLines& lines, RobotLog* log);

/// Leaves out the poses of scans where they contradict the odometry: more than 1 m or 1 rad from
/// that of the readings before and behind them in time, for more than a tenth of them.
/// @pre readings are in the order of time, as far as that is known (SpreadEqualTimes).
/// @return what to warn of; empty where they agree.
std::string LeaveOutContradicting(RobotLog* log);

}  // namespace hires::localisation
