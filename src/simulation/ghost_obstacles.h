#pragma once

#include <deque>

#include "hires/base/rng.h"
#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"

namespace hires::simulation {

/// Obstacles that the robot's laser filter reports where nothing is: small squares in front of the
/// robot, which stay for some seconds. A value; copying it copies what will come.
class GhostObstacles {
 public:
  explicit GhostObstacles(const base::Rng& rng) : rng_(rng) {}

  /// Drops those whose time is over; a new one may come up.
  /// @param X_MB  the robot.  @param rate  [1/s] at which they come up.
  /// @param time  [s] not before the last call's; at first counted from 0.
  void Update(const geometry::Pose2& X_MB, double rate, double time);
  /// Outlines in the map of those that are there.
  std::vector<geometry::Polygon> OutlinesInMap() const;

 private:
  struct Ghost {
    geometry::Polygon outline_M;
    double until;  // [s]
  };
  base::Rng rng_;
  double last_update_{0.0};  // [s]
  std::deque<Ghost> ghosts_;
};

}  // namespace hires::simulation
