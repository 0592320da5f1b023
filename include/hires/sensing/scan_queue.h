#pragma once

#include <optional>
#include <string>

#include "hires/sensing/history.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/sensing/scan_obstacles.h"

namespace hires::sensing {

/// Scans that wait until the robot's state at their time is known.
class ScanQueue {
 public:
  /// A scan in the plane of the base, and where the robot and its laser were when it was taken. One
  /// of a laser that hangs upside down is turned over.
  struct Placed {
    double stamp{0.0};  ///< [s]
    robot::ScanReading reading;
    geometry::Pose2 X_MB, X_OB, X_BL;
  };

  /// @param state  outlives this.
  explicit ScanQueue(const RobotStateEstimator* state) : state_(state) {}

  /// @param frame  of the laser.
  Receipt OnScan(double stamp, const std::string& frame, robot::ScanReading reading);
  /// The newest scan up to a time [s], once; older ones are dropped with it. Nothing where nobody
  /// knows where it was taken, or where its laser is tilted.
  std::optional<Placed> Take(double time);
  /// What became of the last scan that was taken.
  const Receipt& receipt() const { return receipt_; }

 private:
  struct Scan {
    std::string frame;
    robot::ScanReading reading;
  };

  const RobotStateEstimator* state_;
  History<Scan> scans_;
  Receipt receipt_;
};

}  // namespace hires::sensing
