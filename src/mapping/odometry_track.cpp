#include "mapping/odometry_track.h"

#include "hires/base/check.h"

namespace hires::mapping {

void OdometryTrack::Add(double time, const geometry::Pose2& X_OB) {
  HIRES_CHECK(readings_.empty() || time >= readings_.back().time, "time does not go back");
  Reading reading;
  reading.time = time;
  if (!readings_.empty()) {
    const Reading& last = readings_.back();
    reading.num_resets = last.num_resets;
    if (jumps_.IsJump(X_OB_.Inverse() * X_OB, time - last.time)) {
      ++reading.num_resets;
      X_FO_ = last.reading.X_OB * X_OB.Inverse();
    }
  }
  X_OB_ = X_OB;
  reading.reading.X_OB = X_FO_ ? *X_FO_ * X_OB : X_OB;
  readings_.push_back(reading);
}

std::optional<geometry::Pose2> OdometryTrack::At(double time) {
  while (readings_.size() > 1 && readings_[1].time <= time) readings_.pop_front();
  if (readings_.empty()) return std::nullopt;
  const Reading& before = readings_.front();
  if (readings_.size() == 1 || time <= before.time) return before.reading.X_OB;
  return localisation::OdometryBetween(before, readings_[1], time);
}

}  // namespace hires::mapping
