#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/localisation/monte_carlo.h"
#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Which poses of a path are believed where others contradict them.
enum class JudgedFrom {
  kEnd,   ///< the last ones: a filter finds out that it was wrong
  kStart  ///< the first ones, as where it began is known
};

/// Another place in the map that explains a drive nearly as well.
struct Rival {
  geometry::Pose2 X_MB;        ///< where the robot was at the path's last scan, if it was there
  double explained{0.0};       ///< share in [0, 1] of the beams of some scans, if it was there
  double explained_here{0.0};  ///< of the same beams as the path says
};

/// What a log, played forwards, tells of the map from the first scan with a pose on.
struct SincePose {
  int num_scans{0};        ///< that one included
  int num_poses{0};        ///< of them, also those that others contradict
  int num_relocations{0};  ///< as LocalisedLog::num_relocations
  double explained{0.0};   ///< as LocalisedLog::explained
};

/// How a log was localised.
struct LocalisedLog {
  /// The robot at each scan from when it first knew where it was. Scans while it did not are left
  /// out, and so are poses that what it believed at last contradicts.
  TimedPath path;
  std::vector<double> contradicted;  ///< [s] times of poses that were left out for that, and have
                                     ///< no others instead
  double way{0.0};  ///< [m] and, as 0.3 m each, radians, less what was driven while the laser told
                    ///< nothing
  double way_known{0.0};                ///< share in [0, 1] of it that ends in poses of the path
  std::map<ScanOutcome, int> outcomes;  ///< how many scans became what
  std::map<LocalisationStatus, int> statuses;  ///< at the end of how many scans it was what
  int num_without_odometry{0};                 ///< scans that no odometry is near
  /// How often it first knew a place and then found the robot more than 1 m from there.
  int num_relocations{0};
  double explained{0.0};  ///< mean over the scans that were judged: share of beams that end near an
                          ///< obstacle of the map
  PoseEstimate last;      ///< after the last scan
  std::optional<double> localised_after;  ///< [s] from the first scan; nothing: never
  std::optional<double> relocated_after;  ///< [s] the last time; nothing: never
  SincePose since_pose;                   ///< what WhyDoubtful looks at
  std::optional<Rival> rival;             ///< what LocaliseAnywhere found besides
};

/// Of up to 200 scans of a path, the share of beams in [0, 1] that go through an obstacle of the
/// map, 0.4 m (twice explained_distance) or more before their ends, or from a laser that the base's
/// middle has an obstacle before. What was put up since the map was made shortens beams, and lets
/// none go through a wall.
double ShareThroughObstacles(const RobotLog& log, const TimedPath& path,
                             const world::OccupancyGrid& map, const MonteCarloParams& params);

/// What speaks against the map being one of where the drive was: that the robot was found elsewhere
/// again and again (5 times, and more than once in 20 poses), that most scans from the first pose
/// on have none, or that less than 65 % of the beams are explained from there. What was played
/// backwards to the first pose does not count. Empty: nothing does.
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
/// between, 2 m at most, and 0.5 rad); those that do not are left out. Or from its start. Where
/// 0.5 m or more were driven while the laser told nothing, a place is found anew, which contradicts
/// nobody: poses beyond such a pause are left out only where they agree with what was contradicted
/// over 1 m or more on this side of it.
/// @param task           what is done, for those who wait: "localising drive.log".
/// @param first_scan     those before are passed over.  @pre less than the log's scans
/// @param first_counted  those before are in no count but may have poses: another play counts them.
LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter,
                         const std::string& task, std::size_t first_scan = 0,
                         JudgedFrom from = JudgedFrom::kEnd, std::size_t first_counted = 0);

/// The same for a robot that may begin anywhere on the map. A filter that once believes in a place
/// stays there for as long as that explains enough: in a plan that is nearly the same turned by
/// half, or from room to room, perhaps in the wrong one. So when the drive is over, what was driven
/// before its first pose is played backwards from there, and all other places where echoes and way
/// of the whole drive fit (FindOtherPlaces) are played likewise, forwards and backwards. Where the
/// drive explains more beams is the answer; what does not explain significantly fewer (0.5 % and 3
/// standard errors of the mean, over scans that are 0.5 m or 0.5 rad apart and for which both have
/// poses) is its rival, unless it has poses for less than half as many scans. A beam is explained
/// that ends near an obstacle and passes none.
/// @throws base::ConfigError as MonteCarloLocalisation does.
LocalisedLog LocaliseAnywhere(const RobotLog& log, const world::OccupancyGrid& map,
                              const MonteCarloParams& params, const base::Rng& rng,
                              const std::string& task);

}  // namespace hires::localisation
