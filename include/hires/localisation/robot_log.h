#pragma once

#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"

namespace hires::localisation {

/// What a robot recorded while it drove, each kind in the order of time. Times [s] share one clock.
struct RobotLog {
  struct Odometry {
    double time{0.0};
    robot::OdometryReading reading;
  };
  struct Inertia {
    double time{0.0};
    std::optional<double> yaw;  ///< [rad] of the base, from the unit's zero; not all units tell it
    double yaw_rate{0.0};       ///< [rad/s] of the base; what counts where there is no yaw
  };
  struct Scan {
    double time{0.0};
    geometry::Pose2 X_BL;  ///< laser in base
    robot::ScanReading reading;
    std::optional<geometry::Pose2> X_OB;  ///< odometry at that time, where the log says so itself
    bool is_field_assumed{false};  ///< the log says no angles, and its number of beams none either
  };

  std::vector<Odometry> odometry;
  std::vector<Inertia> inertia;
  std::vector<Scan> scans;
};

/// Where odometry saw the base between two readings: straight and turning evenly, in proportion to
/// time.  @pre before.time < after.time
geometry::Pose2 OdometryBetween(const RobotLog::Odometry& before, const RobotLog::Odometry& after,
                                double time);

/// Odometry at a scan: as the log itself says it, else between the readings around it, or the
/// nearest one within 0.5 s.
std::optional<geometry::Pose2> OdometryOf(const RobotLog& log, const RobotLog::Scan& scan);

/// A pose at a time [s].
struct TimedPose {
  double time{0.0};
  geometry::Pose2 X_MB;
};
using TimedPath = std::vector<TimedPose>;

double LengthOf(const TimedPath& path);  ///< [m]

}  // namespace hires::localisation
