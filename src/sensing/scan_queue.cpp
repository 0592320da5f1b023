#include "hires/sensing/scan_queue.h"

#include <cmath>
#include <limits>
#include <utility>

#include "hires/localisation/laser_mount.h"

namespace hires::sensing {
namespace {

constexpr double kLongestWait = 1.0;  // [s] of a scan for the other sensors
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Receipt ScanQueue::OnScan(double stamp, const std::string& frame, robot::ScanReading reading) {
  if (!(stamp > 0.0)) return {Reception::kNoStamp, {}};
  if (state_->IsAhead(stamp)) return state_->Ahead("header.stamp");
  const bool is_new = scans_.Insert(stamp, {frame, std::move(reading)});
  scans_.KeepBetween(stamp - kLongestWait, stamp + kLongestWait);
  return {is_new ? Reception::kTaken : Reception::kRepeated, {}};
}

std::optional<ScanQueue::Placed> ScanQueue::Take(double time) {
  const auto* newest = scans_.Before(time);
  if (newest == nullptr) return std::nullopt;
  auto [stamp, scan] = *newest;
  scans_.KeepBetween(std::nextafter(time, kInfinity), kInfinity);
  const auto then = state_->At(stamp);
  if (!then) return std::nullopt;
  const FramePose X_BL = state_->InBase(scan.frame, *then);
  receipt_ = ReceiptOf(X_BL.status, scan.frame);
  if (!X_BL.is_found()) return std::nullopt;
  const auto level = localisation::LevelLaser(X_BL.X_PC, &scan.reading);
  if (!level) {
    receipt_ = {Reception::kTilted, scan.frame, localisation::kMostLaserTilt};
    return std::nullopt;
  }
  return Placed{stamp, std::move(scan.reading), then->X_WB, then->X_OB, *level};
}

}  // namespace hires::sensing
