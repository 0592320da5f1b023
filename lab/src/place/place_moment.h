#pragma once

#include <vector>

#include "hires/geometry/pose.h"

namespace hires::lab {

/// Where a robot is that finds its place by itself, and where it takes itself to be, at one moment.
struct PlaceMoment {
  geometry::Pose2 X_MB;         ///< really
  geometry::Pose2 X_MBelieved;  ///< as it believes
  geometry::Pose2 X_OB;         ///< as its odometry says
  /// The truth lies in the ellipse of x and y that holds 95 % by the filter's covariance.
  bool is_inside{false};
  bool is_lost{false};  ///< it is not sure enough to drive

  /// [m] from where it is to where it takes itself to be, in the map.
  Eigen::Vector2d off() const { return X_MBelieved.position() - X_MB.position(); }
  geometry::Pose2 error() const { return X_MB.Inverse() * X_MBelieved; }
  /// Of the odometry in the map; another one than before means that the laser corrected.
  geometry::Pose2 X_MO() const { return X_MBelieved * X_OB.Inverse(); }
};

/// One drive, moment by moment.
using PlaceTrail = std::vector<PlaceMoment>;

}  // namespace hires::lab
