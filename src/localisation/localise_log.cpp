#include "hires/localisation/localise_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "hires/base/progress.h"
#include "hires/base/text.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr double kNear = 0.5;       // [s]
constexpr double kRelocated = 1.0;  // [m]
constexpr int kOftenElsewhere = 5;
constexpr double kMostElsewhere = 0.05;  // of the poses
constexpr double kFewPoses = 0.5;        // of the scans
constexpr double kFewExplained = 0.65;   // of the beams

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

class LogLocaliser {
 public:
  LogLocaliser(const RobotLog& log, MonteCarloLocalisation filter)
      : log_(log), filter_(std::move(filter)) {}

  void Take(const RobotLog::Scan& scan);
  LocalisedLog Result();

 private:
  /// From the estimate before to that at `time`.
  void TakeEstimate(double time, ScanOutcome outcome, const Pose2& X_OB);

  double SinceFirst(double time) const { return time - log_.scans.front().time; }

  const RobotLog& log_;
  MonteCarloLocalisation filter_;
  LocalisedLog localised_;
  std::optional<Pose2> X_OB_;  // at the scan before
  int num_judged_{0}, num_judged_since_{0};
};

void LogLocaliser::Take(const RobotLog::Scan& scan) {
  const std::optional<Pose2> X_OB = OdometryOf(log_, scan);
  if (!X_OB) {
    ++localised_.num_without_odometry;
    return;
  }
  const ScanOutcome outcome = filter_.Update(scan.time, *X_OB, scan.reading, scan.X_BL);
  TakeEstimate(scan.time, outcome, *X_OB);
  const PoseEstimate& estimate = localised_.last;
  const bool is_good = estimate.status == LocalisationStatus::kGood;
  if (is_good || localised_.localised_after) ++localised_.num_since;
  ++localised_.outcomes[outcome];
  ++localised_.statuses[estimate.status];
  if (!IsBad(outcome)) {
    ++num_judged_;
    localised_.explained += estimate.explained;
    if (is_good || localised_.localised_after) {
      ++num_judged_since_;
      localised_.explained_since += estimate.explained;
    }
  }
  if (!is_good) return;
  if (!localised_.localised_after) localised_.localised_after = SinceFirst(scan.time);
  localised_.path.push_back({scan.time, estimate.X_MB});
}

void LogLocaliser::TakeEstimate(double time, ScanOutcome outcome, const Pose2& X_OB) {
  const Pose2 step = X_OB_ ? X_OB_->Inverse() * X_OB : Pose2{};
  const Pose2 expected = localised_.last.X_MB * step;
  X_OB_ = X_OB;
  localised_.last = filter_.Estimate(time);
  if (outcome != ScanOutcome::kUpdated || !localised_.localised_after) return;
  if ((localised_.last.X_MB.position() - expected.position()).norm() <= kRelocated) return;
  ++localised_.num_relocations;
  localised_.relocated_after = SinceFirst(time);
}

LocalisedLog LogLocaliser::Result() {
  if (num_judged_ > 0) localised_.explained /= num_judged_;
  if (num_judged_since_ > 0) localised_.explained_since /= num_judged_since_;
  return std::move(localised_);
}

}  // namespace

std::string WhyDoubtful(const LocalisedLog& localised) {
  if (localised.path.empty()) return "";
  const double num_poses = static_cast<double>(localised.path.size());
  std::vector<std::string> against;
  if (localised.num_relocations >= kOftenElsewhere &&
      localised.num_relocations > kMostElsewhere * num_poses)
    against.push_back(fmt::format("it was found elsewhere {} times", localised.num_relocations));
  if (num_poses < kFewPoses * localised.num_since)
    against.push_back(fmt::format("{} of {} scans since the first pose have none",
                                  localised.num_since - localised.path.size(),
                                  localised.num_since));
  if (localised.explained_since < kFewExplained)
    against.push_back(
        fmt::format("{:.0f} % of the beams are explained", 100.0 * localised.explained_since));
  return base::Join(against, ", ");
}

LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter,
                         const std::string& task) {
  LogLocaliser localiser(log, std::move(filter));
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    localiser.Take(log.scans[i]);
    base::ReportProgress(task, static_cast<double>(i) / log.scans.size());
  }
  base::ReportProgress(task, 1.0);
  return localiser.Result();
}

}  // namespace hires::localisation
