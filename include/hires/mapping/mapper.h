#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hires/localisation/robot_log.h"
#include "hires/robot/odometry_jump.h"
#include "hires/world/occupancy_grid.h"

namespace hires::mapping {

/// The defaults serve lasers of 5 to 80 m on robots that drive indoors.
struct MapperParams {
  double resolution{0.05};    ///< [m] cell of the map that is drawn
  double max_range{30.0};     ///< [m] what is farther away is not used
  double keyframe_step{0.3};  ///< [m], [rad] by which keyframes are apart
  int local_keyframes{20};    ///< latest ones that a scan is matched with
  double odometry_sd{0.05};   ///< [m / m], [rad / rad], [rad / m] of a step
  double surface_sd{0.03};    ///< [m] of a measured point about its wall
  double loop_radius{4.0};    ///< [m] around the robot in which places seen before are tried
  double loop_length{10.0};   ///< [m] driven in between that makes a place one seen before
  double min_fit{0.6};        ///< share of a scan's points that a loop must explain
  double max_linear_speed{robot::kFastestDrive};  ///< [m/s] odometry that is faster was reset
  double max_angular_speed{robot::kFastestTurn};  ///< [rad/s]
  geometry::Pose2 X_MBegin;  ///< base at the first scan, in the map that is made
};

struct MapCounts {
  int num_keyframes{0};
  int num_loops{0};       ///< places seen again that tie the map together
  int num_lost{0};        ///< scans that fitted nothing and stand where odometry says
  int odometry_jumps{0};  ///< resets, taken as no motion
  int num_scans{0};       ///< all of them
  int num_searched{0};    ///< scans by which the laser showed the odometry wrong by more than
                          ///< odometry_sd allows; the laser was believed
  int num_breaks{0};      ///< where scans that saw walls fitted what was there badly or not at all,
                          ///< and no place seen before ties both sides together since
  double turns_alike{1.0};  ///< [rad/rad] turns by the laser for turns by odometry: -1 where beams
                            ///< are in reverse order; 1 also where nobody turned
  double ways_alike{1.0};   ///< [m/m] ways likewise, in the median: 3.28 where ranges are in feet;
                            ///< 1 also on less than 5 m
  int num_stretches{0};     ///< of 0.5 m or 0.5 rad, on which laser and odometry were compared
  int num_disagreed{0};     ///< those with a tenth of scans of num_searched
};

/// Whether places to which the robot came back look as before: within 2 m and 1 rad of where it
/// had been MapperParams::loop_length of way before, as far as the map tells.
struct MapReturns {
  int num_judged{0};  ///< 30 at most, evenly over the drive
  int num_apart{0};   ///< where less than half of the scan fits what was seen there before
};

/// How far a finished map explains what it was made of (map_doubt.h).
struct MapEvidence {
  MapReturns returns;
  int num_beams{0};           ///< that were judged
  double explained{1.0};      ///< share that ended within 0.1 m of an occupied cell
  double through_walls{0.0};  ///< share that went on 0.5 m and more behind a wall, and not along it
  /// [rad] Between first and last beam of the first scan that was drawn.
  double field_of_view{0.0};
  /// That this is half a circle, in steps that no such laser has: FLASER, which always means half a
  /// circle, is written of others, too.
  bool is_field_assumed{false};
};

struct MapResult : MapCounts {
  world::OccupancyGrid grid;           ///< free what beams passed, occupied where they ended
  localisation::TimedPath trajectory;  ///< one pose for each scan that was added
  MapEvidence evidence;
};

/// What a map is drawn from, apart from the mapper: another thread may draw it.
struct MapSketch {
  std::vector<std::shared_ptr<const localisation::RobotLog::Scan>> scans;  ///< show something new
  std::vector<geometry::Pose2> X_MBs;                                      ///< one for each
  double resolution{0.05}, max_range{30.0};                                ///< [m]
  std::function<MapReturns()> judge_returns;  ///< fits scans anew: takes time, too
};

/// Takes time in proportion to all beams and their lengths.
/// @throws base::ConfigError if the map would have more than 100 million cells.
world::OccupancyGrid Draw(const MapSketch& sketch);

/// Makes a map of what a laser saw on a drive: scans are matched with the latest keyframes
/// (points to walls, odometry as prior), places seen before are recognised by their scans, and a
/// graph of poses is made to agree with all of it. The base is at MapperParams::X_MBegin of the map
/// at the first scan: in its origin, if not told otherwise. Nothing is drawn by chance: the same
/// log gives the same map.
class Mapper {
 public:
  explicit Mapper(const MapperParams& params = {});
  ~Mapper();
  Mapper(Mapper&&) noexcept;

  /// @pre times do not go back.  A reset, in position or heading (robot::OdometryJumps),
  /// counts as no motion.
  void AddOdometry(const localisation::RobotLog::Odometry& odometry);

  /// A scan without X_OB waits for the odometry after it. One that measured nothing gets the pose
  /// that odometry tells.  @pre times do not go back.
  void AddScan(const localisation::RobotLog::Scan& scan);

  /// Where the last scan was made, of those that wait for no odometry: the end of the trajectory,
  /// without its cost. Nothing before the first one.
  std::optional<localisation::TimedPose> newest() const;
  MapCounts counts() const;
  MapSketch sketch() const;  ///< of the same scans

  /// What is known after the scans so far, those that still waited for odometry included; may be
  /// asked several times.
  /// @throws base::ConfigError  as Draw.
  MapResult Result();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole of a log at once.
/// @param task  what people are told who wait for it (base/progress.h).
/// @throws base::ConfigError if it has no scan that measured anything, if more than nine scans in
/// ten fit nothing, or as Mapper::Result.
MapResult MakeMap(const localisation::RobotLog& log, const MapperParams& params = {},
                  const std::string& task = "mapping");

}  // namespace hires::mapping
