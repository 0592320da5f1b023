#include "hires/localisation/laser_mount.h"

#include "hires/geometry/angles.h"

namespace hires::localisation {

std::optional<geometry::Pose2> LevelLaser(const geometry::Pose3& X_BL, robot::ScanReading* scan) {
  const double tilt = geometry::TiltOf(X_BL.rotation);
  if (tilt > geometry::kPi - kMostLaserTilt) {
    scan->angle_min = -scan->angle_min;
    scan->angle_increment = -scan->angle_increment;
  } else if (!(tilt <= kMostLaserTilt)) {
    return std::nullopt;
  }
  return geometry::Pose2{X_BL.translation.x(), X_BL.translation.y(),
                         geometry::YawOf(X_BL.rotation)};
}

}  // namespace hires::localisation
