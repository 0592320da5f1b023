#pragma once

#include <string>
#include <vector>

namespace hires::robot {

/// Where joints shall be at a moment of a trajectory.
struct TrajectoryPoint {
  double time{0.0};                ///< [s] from the trajectory's start
  std::vector<double> positions;   ///< [rad] or [m], one per joint of the trajectory
  std::vector<double> velocities;  ///< [rad/s] or [m/s], likewise; empty: the controller's choice
};

/// A motion of some joints; between two points positions follow the cubic through both points'
/// positions and velocities (a straight line where there are no velocities), as the PR2's joint
/// trajectory controllers do. Without points: the joints brake and stand.
struct JointTrajectory {
  std::vector<std::string> joints;
  std::vector<TrajectoryPoint> points;  ///< times ascending

  double duration() const { return points.empty() ? 0.0 : points.back().time; }
};

}  // namespace hires::robot
