#include "hires/sensing/observation_maker.h"

#include <utility>

#include "hires/geometry/covariance.h"

namespace hires::sensing {

ObservationMaker::ObservationMaker(const RobotStateEstimator* state, ScanObstacles obstacles,
                                   geometry::Polygon base)
    : find_obstacles_(std::move(obstacles)), scans_(state), memory_(std::move(base)) {}

Receipt ObservationMaker::OnScan(double stamp, const std::string& frame,
                                 robot::ScanReading reading) {
  return scans_.OnScan(stamp, frame, std::move(reading));
}

void ObservationMaker::OnLocalised(const Eigen::Matrix3d& covariance) {
  position_sd_ = geometry::LargestSd(covariance(0, 0), covariance(0, 1), covariance(1, 1));
}

robot::Observation ObservationMaker::Observe(const RobotEstimate& now) {
  if (auto scan = scans_.Take(now.time)) {
    obstacles_M_ = find_obstacles_.Find(scan->reading, scan->X_MB, scan->X_BL);
    robot::PlacedScan placed{std::move(scan->reading), scan->X_OB, scan->X_BL, {}};
    memory_.Complete(scan->stamp, &placed);
    scan_ = std::make_shared<const robot::PlacedScan>(std::move(placed));
    scanned_ = scan->stamp;
  }
  robot::Observation seen;
  seen.time = now.time;
  seen.X_MB = now.X_WB;
  seen.position_sd = position_sd_;
  seen.X_OB = now.X_OB;
  seen.V_B = now.V_B;
  seen.scan = scan_;
  seen.scan_age = now.time - scanned_;
  seen.obstacles_M = obstacles_M_;
  seen.joints = now.joints;
  seen.joint_velocities = now.joint_velocities;
  return seen;
}

}  // namespace hires::sensing
