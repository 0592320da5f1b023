#include "hires/skills/scan_watch.h"

#include "hires/robot/odometry_jump.h"

namespace hires::skills {

ScanWatch::News ScanWatch::Look(const robot::Observation& observation) {
  News news;
  news.is_reset = before_ && robot::IsOdometryJump(before_->X_OB.Inverse() * observation.X_OB,
                                                   observation.time - before_->time,
                                                   robot::kFastestDrive, robot::kFastestTurn);
  before_ = Odometry{observation.time, observation.X_OB};
  // The scan at hand was taken before a reset, or who knows.
  const bool is_of_now = observation.scan_age <= kScanPatience;
  if (!news.is_reset && is_of_now && observation.scan != scan_) news.scan = observation.scan;
  scan_ = observation.scan;
  return news;
}

}  // namespace hires::skills
