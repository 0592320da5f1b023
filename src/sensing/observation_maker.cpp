#include "hires/sensing/observation_maker.h"

#include <cmath>
#include <limits>
#include <utility>

namespace hires::sensing {
namespace {

constexpr double kLongestWait = 1.0;  // [s] of a scan for the other sensors
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ObservationMaker::ObservationMaker(const RobotStateEstimator* state, ScanObstacles obstacles)
    : state_(state), find_obstacles_(std::move(obstacles)) {}

Receipt ObservationMaker::OnScan(double stamp, const std::string& frame, ScanReading reading) {
  if (!(stamp > 0.0)) return {Reception::kNoStamp, {}};
  if (state_->IsAhead(stamp)) return state_->Ahead("header.stamp");
  const bool is_new = scans_.Insert(stamp, {frame, std::move(reading)});
  scans_.KeepBetween(stamp - kLongestWait, stamp + kLongestWait);
  return {is_new ? Reception::kTaken : Reception::kRepeated, {}};
}

robot::Observation ObservationMaker::Observe(const RobotEstimate& now) {
  FindObstacles(now);
  robot::Observation seen;
  seen.time = now.time;
  seen.X_MB = now.X_WB;
  seen.V_B = now.V_B;
  seen.obstacles_M = obstacles_M_;
  seen.joints = now.joints;
  seen.joint_velocities = now.joint_velocities;
  return seen;
}

void ObservationMaker::FindObstacles(const RobotEstimate& now) {
  const auto* newest = scans_.Before(now.time);
  if (newest == nullptr) return;
  const auto [stamp, scan] = *newest;
  scans_.KeepBetween(std::nextafter(now.time, kInfinity), kInfinity);
  const auto then = state_->At(stamp);
  if (!then) return;
  const FramePose X_BL = state_->InBase(scan.frame, *then);
  scan_receipt_ = ReceiptOf(X_BL.status, scan.frame);
  if (!X_BL.is_found()) return;
  obstacles_M_ = find_obstacles_.Find(scan.reading, then->X_WB, geometry::Flatten(X_BL.X_PC));
}

}  // namespace hires::sensing
