#include "hires/localisation/robot_log.h"

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

double LengthOf(const TimedPath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].X_MB.position() - path[i - 1].X_MB.position()).norm();
  return length;
}

}  // namespace hires::localisation
