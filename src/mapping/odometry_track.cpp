#include "mapping/odometry_track.h"

#include "hires/base/check.h"

namespace hires::mapping {

void OdometryTrack::Add(double time, const geometry::Pose2& X_OB) {
  HIRES_CHECK(readings_.empty() || time >= readings_.back().time, "time does not go back");
  readings_.push_back({time, {X_OB, {}}});
}

std::optional<geometry::Pose2> OdometryTrack::At(double time) {
  while (readings_.size() > 1 && readings_[1].time <= time) readings_.pop_front();
  if (readings_.empty()) return std::nullopt;
  const localisation::RobotLog::Odometry& before = readings_.front();
  if (readings_.size() == 1 || time <= before.time) return before.reading.X_OB;
  return localisation::OdometryBetween(before, readings_[1], time);
}

}  // namespace hires::mapping
