#pragma once

#include <map>
#include <optional>
#include <string>

#include "hires/localisation/monte_carlo.h"
#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// How a log was localised.
struct LocalisedLog {
  /// The robot at each scan from when it first knew where it was. Scans while it did not are left
  /// out, and so are poses that what it believed at last contradicts.
  TimedPath path;
  int num_contradicted{0};  ///< poses that were left out for that
  double way_known{0.0};    ///< share in [0, 1] of the way that ends in poses of the path; what was
                            ///< driven while the laser told nothing does not count
  std::map<ScanOutcome, int> outcomes;         ///< how many scans became what
  std::map<LocalisationStatus, int> statuses;  ///< at the end of how many scans it was what
  int num_without_odometry{0};                 ///< scans that no odometry is near
  /// How often it first knew a place and then found the robot more than 1 m from there.
  int num_relocations{0};
  double explained{0.0};  ///< mean over the scans that were judged: share of beams that end near an
                          ///< obstacle of the map
  int num_since{0};       ///< scans from the first with a pose on, that one included
  double explained_since{0.0};            ///< the mean over those
  PoseEstimate last;                      ///< after the last scan
  std::optional<double> localised_after;  ///< [s] from the first scan; nothing: never
  std::optional<double> relocated_after;  ///< [s] the last time; nothing: never
};

/// What speaks against the map being one of where the drive was: that the robot was found elsewhere
/// again and again (5 times, and more than once in 20 poses), that most scans from the first pose
/// on have none, or that less than 65 % of the beams are explained from there. Empty: nothing does.
std::string WhyDoubtful(const LocalisedLog& localised);

/// What speaks against the path being one of the drive: more than a fifth of the way (metres and,
/// as 0.3 m each, radians) was driven where it was not known, or known wrongly. Empty: nothing.
std::string WhyPartial(const LocalisedLog& localised);

/// Lets a filter hear all scans of a log, each with the odometry of its time: as the log itself
/// says it, else between the readings around it, or the nearest one within 0.5 s.
///
/// A filter that was wrong and finds out goes elsewhere at once, where the odometry did not go. The
/// poses of the path are therefore judged from its end: what the last ones say, carried back by the
/// odometry, is what those before such a leap must agree with (within 1 m and a tenth of the way
/// between, 2 m at most, and 0.5 rad); those that do not are left out.
/// @param task  what is done, for those who wait: "localising drive.log".
LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter,
                         const std::string& task);

}  // namespace hires::localisation
