#include "localisation/localise_log.h"

#include <algorithm>

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr double kNear = 0.5;  // [s]

std::optional<Pose2> OdometryOf(const RobotLog& log, const RobotLog::Scan& scan) {
  if (scan.X_OB) return scan.X_OB;
  const auto after = std::lower_bound(
      log.odometry.begin(), log.odometry.end(), scan.time,
      [](const RobotLog::Odometry& odometry, double t) { return odometry.time < t; });
  const bool has_after = after != log.odometry.end(), has_before = after != log.odometry.begin();
  if (has_after && after->time == scan.time) return after->reading.X_OB;
  if (has_after && has_before) return OdometryBetween(*(after - 1), *after, scan.time);
  if (has_after && after->time - scan.time <= kNear) return after->reading.X_OB;
  if (has_before && scan.time - (after - 1)->time <= kNear) return (after - 1)->reading.X_OB;
  return std::nullopt;
}

bool IsLocalised(LocalisationStatus status) { return status == LocalisationStatus::kGood; }

}  // namespace

LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter) {
  LocalisedLog localised;
  for (const RobotLog::Scan& scan : log.scans) {
    const std::optional<Pose2> X_OB = OdometryOf(log, scan);
    if (!X_OB) {
      ++localised.num_without_odometry;
      continue;
    }
    const ScanOutcome outcome = filter.Update(scan.time, *X_OB, scan.reading, scan.X_BL);
    const PoseEstimate estimate = filter.Estimate(scan.time);
    ++localised.outcomes[outcome];
    ++localised.statuses[estimate.status];
    localised.last = estimate;
    if (!IsLocalised(estimate.status)) continue;
    if (!localised.localised_after) localised.localised_after = scan.time - log.scans.front().time;
    localised.path.push_back({scan.time, estimate.X_MB});
  }
  return localised;
}

}  // namespace hires::localisation
