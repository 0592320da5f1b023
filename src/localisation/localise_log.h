#pragma once

#include <map>
#include <optional>

#include "hires/localisation/robot_log.h"
#include "localisation/monte_carlo.h"

namespace hires::localisation {

/// How a log was localised.
struct LocalisedLog {
  TimedPath path;  ///< the robot at each scan from when it first knew where it was; scans while it
                   ///< did not are left out
  std::map<ScanOutcome, int> outcomes;         ///< how many scans became what
  std::map<LocalisationStatus, int> statuses;  ///< at the end of how many scans it was what
  int num_without_odometry{0};                 ///< scans that no odometry is near
  PoseEstimate last;                           ///< after the last scan
  std::optional<double> localised_after;       ///< [s] from the first scan; nothing: never
};

/// Lets a filter hear all scans of a log, each with the odometry of its time: as the log itself
/// says it, else between the readings around it, or the nearest one within 0.5 s.
LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter);

}  // namespace hires::localisation
