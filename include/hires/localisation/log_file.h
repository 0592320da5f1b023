#pragma once

#include <string>

#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Reads a log of the CARMEN toolkit, as most public logs of lasers and odometry are:
///   ODOM x y theta tv rv accel                                              ipc host logger
///   FLASER n r_1 .. r_n  x y theta (laser)  x y theta (odometry)            ipc host logger
///   ROBOTLASER1 type start_angle fov resolution max_range accuracy mode
///     n r_1 .. r_n  m remissions  x y theta (laser)  x y theta (robot)
///     tv rv forward side turn_axis                                          ipc host logger
///   RAWLASER1 as ROBOTLASER1 up to the remissions                           ipc host logger
/// A log may lack `ipc host logger`, or accel, in all its lines. `#` begins a comment; lines of
/// other kinds (RLASER, SYNC, truepos, ...) are passed over, whatever the case of their letters.
///
/// Lines that cannot be read (words missing or too many, no number, a time more than 1 s before an
/// earlier one of its kind, no name of a message) are passed over, with a warning that counts them
/// and tells of the first where, what came and what was wanted, as long as they are at most 1 % of
/// those and the lines ODOM, FLASER and ROBOTLASER1 that can be read. Lines of these kinds that are
/// equal to the one before are passed over, with a warning. A number may begin with a plus, and
/// lines may end as on an old Mac. A last line that is cut off
/// (without an end of line, or with words missing) is passed over with a warning of its own.
///
/// Times are those of `ipc` [s], when a reading was made, on one clock for all kinds; `logger`
/// tells when the line was written. Readings whose time steps back by up to 1 s are kept and put in
/// the order of their times, with a warning.
///
/// FLASER does not tell its angles. As CARMEN's own reader (readlog.c) takes it, the first beam
/// points to -90 degrees, and the others follow in whole shares of the half circle; where n is
/// even, the last beam, at +90 degrees, is missing: 1 degree for n = 180 and 181, 0.5 for 360 and
/// 361. GMapping takes the same steps but sets the middle one of n = 180 straight ahead.
/// Its `range_max` is PARAM robot_front_laser_max, else 80 m, as CARMEN assumes. Where the largest
/// range of a log stands in it again and again, as what the laser says where it meets nothing, that
/// is the `range_max` of its scans of either kind, with a warning.
///
/// A warning says where n is of no usual laser. ROBOTLASER1 tells its angles; where fov, resolution
/// and n disagree by more than a step, that one of fov and resolution counts by which the laser
/// looks as far to the left as to the right, with a warning, and fov where the resolution is 0.
///
/// Where the laser sits on the robot follows from the two poses of its line. If that changes
/// between few places that stay the same, several lasers have written lines of one name, and all
/// are taken; else a mapper has corrected the log: then PARAM robot_frontlaser_offset says it (0
/// where it is missing, CARMEN's default). There is a warning of either.
///
/// Where times do not advance over the drive (all equal, or rounded to steps far longer than a
/// scan), readings are taken in the order of their lines at times that are made up, with a warning.
///
/// Odometry is that of the lines ODOM; without any, that of the scans, with velocities from
/// differences. Scans keep their own where it agrees with the lines ODOM; else it is left out, with
/// a warning. Where most moves or turns are faster than any robot a warning asks whether odometry
/// is in millimetres, centimetres or degrees. Lines ODOM of time 0 that repeat the pose of the scan
/// before them, as mappers write them into logs that they correct, are passed over, with a warning.
/// A log that has FLASER and ROBOTLASER1 gives the scans of what comes first; one that has neither
/// those of RAWLASER1, without odometry of their own and robot_frontlaser_offset before the base,
/// with a warning. What is no number, negative or below range_min is kept in a scan as NaN.
///
/// @throws base::ConfigError naming file and line, what came and what was wanted: no such file,
/// more lines that cannot be read than 1 %, one of those two parameters that is no number, absurd
/// sizes, angles of ROBOTLASER1 or times that are in another unit, no scan and no odometry at all,
/// a file of another kind (packed, UTF-16, a bag of ROS 2).
RobotLog ReadCarmenLog(const std::string& path);

/// Writes lines ODOM and ROBOTLASER1, which ReadCarmenLog reads again, up to the digits that are
/// written: 1 us, 1 um and 1 urad of poses, 0.1 mm of ranges. What is no number is 0, and what met
/// nothing `range_max`. A file of that name is replaced only when the new one is whole.
/// @pre scans have odometry (X_OB) and a range_max.  @throws base::ConfigError if the file cannot
/// be written.
void WriteCarmenLog(const RobotLog& log, const std::string& file);

/// Writes lines `t x y z qx qy qz qw` (TUM format); a file of that name is replaced only when the
/// new one is whole.
/// @throws base::ConfigError if the file cannot be written.
void WriteTumTrajectory(const TimedPath& path, const std::string& file);

}  // namespace hires::localisation
