#include "hires/localisation/filtered_log.h"

#include "hires/localisation/heading_feed.h"

namespace hires::localisation {

int FilterOdometry(const OdometryFilterParams& params, RobotLog* log) {
  OdometryFilter filter(params);
  HeadingFeed unit(&filter);
  int num_resets = 0;
  auto next = log->inertia.begin();
  for (RobotLog::Odometry& odometry : log->odometry) {
    for (; next != log->inertia.end() && next->time <= odometry.time; ++next) unit.Take(*next);
    const FilterOutcome outcome = filter.OnOdometry(odometry.time, {odometry.reading.X_OB, {}});
    if (outcome == FilterOutcome::kJumped) ++num_resets;
    odometry.reading.X_OB = filter.X_FB();
  }
  return num_resets;
}

}  // namespace hires::localisation
