#include "hires/localisation/robot_log.h"

#include <algorithm>

#include "hires/base/check.h"

namespace hires::localisation {

using geometry::Pose2;

Pose2 OdometryBetween(const RobotLog::Odometry& before, const RobotLog::Odometry& after,
                      double time) {
  HIRES_CHECK(before.time < after.time, "two readings are of different times");
  const double share = (time - before.time) / (after.time - before.time);
  const Pose2 step = before.reading.X_OB.Inverse() * after.reading.X_OB;
  return before.reading.X_OB * Pose2{share * step.x, share * step.y, share * step.yaw};
}

std::optional<Pose2> OdometryOf(const RobotLog& log, const RobotLog::Scan& scan) {
  constexpr double kNear = 0.5;  // [s]
  if (scan.X_OB) return scan.X_OB;
  const auto after = std::lower_bound(
      log.odometry.begin(), log.odometry.end(), scan.time,
      [](const RobotLog::Odometry& odometry, double t) { return odometry.time < t; });
  const bool has_after = after != log.odometry.end(), has_before = after != log.odometry.begin();
  if (has_after && after->time == scan.time) return after->reading.X_OB;
  if (has_after && has_before) return OdometryBetween(*(after - 1), *after, scan.time);
  if (has_after && after->time - scan.time <= kNear) return after->reading.X_OB;
  if (has_before && scan.time - (after - 1)->time <= kNear) return (after - 1)->reading.X_OB;
  return std::nullopt;
}

double LengthOf(const TimedPath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].X_MB.position() - path[i - 1].X_MB.position()).norm();
  return length;
}

}  // namespace hires::localisation
