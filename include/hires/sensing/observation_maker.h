#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "hires/robot/observation.h"
#include "hires/robot/scan_memory.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/sensing/scan_obstacles.h"
#include "hires/sensing/scan_queue.h"

namespace hires::sensing {

/// Makes of the robot's state and its laser what skills get to see. Objects are added by who
/// remembers them.
class ObservationMaker {
 public:
  /// @param state  outlives this.
  /// @param base   outline of what drives, in the base: what a scan shows within is the robot.
  ObservationMaker(const RobotStateEstimator* state, ScanObstacles obstacles,
                   geometry::Polygon base);

  /// @param frame  of the laser.
  Receipt OnScan(double stamp, const std::string& frame, robot::ScanReading reading);

  /// How sure localisation is of its place from now on.
  /// @param covariance  [m^2, m rad, rad^2] of x, y, yaw
  void OnLocalised(const Eigen::Matrix3d& covariance);

  /// What is seen at that moment; `time` is its stamp. Obstacles are those of the last scan up to
  /// now, where the robot was when it was taken.
  robot::Observation Observe(const RobotEstimate& now);
  /// What became of the last scan that was looked at.
  const Receipt& scan_receipt() const { return scans_.receipt(); }

 private:
  ScanObstacles find_obstacles_;
  ScanQueue scans_;
  std::vector<geometry::Polygon> obstacles_M_;
  robot::ScanMemory memory_;
  std::shared_ptr<const robot::PlacedScan> scan_;
  double scanned_{0.0};      // [s] when that was taken
  double position_sd_{0.0};  // [m]
};

}  // namespace hires::sensing
