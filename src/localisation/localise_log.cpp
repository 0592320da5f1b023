#include "hires/localisation/localise_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hires/base/progress.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr double kRelocated = 1.0;  // [m]
constexpr int kOftenElsewhere = 5;
constexpr double kMostElsewhere = 0.05;                                       // of the poses
constexpr double kFewPoses = 0.5;                                             // of the scans
constexpr double kFewExplained = 0.65;                                        // of the beams
constexpr double kFewKnown = 0.8;                                             // of the way
constexpr double kAgreeing = 1.0, kAgreeingOfWay = 0.1, kMostAgreeing = 2.0;  // [m]
constexpr double kAgreeingTurn = 0.5;                                         // [rad]
constexpr double kWayOfTurn = 0.3;                                            // [m/rad]
constexpr double kLongestPause = 5.0;                                         // [s] between scans

/// A scan's moment by the odometry alone, less its jumps.
struct Moment {
  Pose2 X_OB;
  double way{0.0};       // [m] until then; a turn counts as kWayOfTurn
  double way_seen{0.0};  // [m] of it, without what was driven while the laser told nothing
  bool is_in_path{false};
};

/// A pose of the path while it is judged.
struct Judged {
  Moment* moment;
  TimedPose pose;
};

/// Whether what is believed at two moments agrees.
bool DoAgree(const Judged& a, const Judged& b) {
  const Pose2 step = b.moment->X_OB.Inverse() * a.moment->X_OB;
  const Pose2 off = (b.pose.X_MB * step).Inverse() * a.pose.X_MB;
  const double way = std::abs(b.moment->way - a.moment->way);
  return off.position().norm() <= std::min(kAgreeing + kAgreeingOfWay * way, kMostAgreeing) &&
         std::abs(geometry::WrapToPi(off.yaw)) <= kAgreeingTurn;
}

/// Whether the laser told something nearly all the way between two moments: after a pause the place
/// is found anew, and that contradicts nobody.
bool IsSeen(const Moment& a, const Moment& b) {
  constexpr double kUnseen = 0.5;  // [m]
  return std::abs(b.way - a.way) - std::abs(b.way_seen - a.way_seen) < kUnseen;
}

/// Whether what was contradicted between two moments was believed for long enough to be more than
/// what the odometry made of the belief before a pause.
bool IsHeld(const Moment& a, const Moment& b) {
  constexpr double kHeld = 1.0;  // [m]
  return std::abs(b.way_seen - a.way_seen) >= kHeld;
}

class LogLocaliser {
 public:
  LogLocaliser(const RobotLog& log, MonteCarloLocalisation filter)
      : log_(log), filter_(std::move(filter)) {}

  void Take(const RobotLog::Scan& scan, bool is_counted);
  LocalisedLog Result(JudgedFrom from);

 private:
  void Count(ScanOutcome outcome, const PoseEstimate& estimate);
  void CountSincePose(ScanOutcome outcome, const PoseEstimate& estimate);
  void TakeMoment(double time, const Pose2& X_OB, ScanOutcome outcome);
  /// Leaves out of the path what its end, or its beginning, contradicts.
  void JudgePath(JudgedFrom from);
  double WayKnown() const;
  /// From the estimate before to that at `time`.
  void TakeEstimate(double time, ScanOutcome outcome, const Pose2& X_OB);

  double SinceFirst(double time) const { return time - log_.scans.front().time; }

  const RobotLog& log_;
  MonteCarloLocalisation filter_;
  LocalisedLog localised_;
  std::optional<Pose2> X_OB_;    // at the scan before
  double time_{0.0};             // [s] of it
  std::vector<Moment> moments_;  // of all scans that have odometry
  int num_judged_{0}, num_judged_since_{0};
};

void LogLocaliser::Take(const RobotLog::Scan& scan, bool is_counted) {
  const std::optional<Pose2> X_OB = OdometryOf(log_, scan);
  if (!X_OB) {
    localised_.num_without_odometry += is_counted;
    return;
  }
  const ScanOutcome outcome = filter_.Update(scan.time, *X_OB, scan.reading, scan.X_BL);
  TakeMoment(scan.time, *X_OB, outcome);
  TakeEstimate(scan.time, outcome, *X_OB);
  const PoseEstimate& estimate = localised_.last;
  const bool is_good = estimate.status == LocalisationStatus::kGood;
  if (is_good && !localised_.localised_after) localised_.localised_after = SinceFirst(scan.time);
  if (is_counted) Count(outcome, estimate);
  if (localised_.localised_after) CountSincePose(outcome, estimate);
  if (!is_good) return;
  localised_.path.push_back({scan.time, estimate.X_MB});
  moments_.back().is_in_path = true;
}

void LogLocaliser::Count(ScanOutcome outcome, const PoseEstimate& estimate) {
  ++localised_.outcomes[outcome];
  ++localised_.statuses[estimate.status];
  if (IsBad(outcome)) return;
  ++num_judged_;
  localised_.explained += estimate.explained;
}

void LogLocaliser::CountSincePose(ScanOutcome outcome, const PoseEstimate& estimate) {
  ++localised_.since_pose.num_scans;
  if (IsBad(outcome)) return;
  ++num_judged_since_;
  localised_.since_pose.explained += estimate.explained;
}

void LogLocaliser::TakeMoment(double time, const Pose2& X_OB, ScanOutcome outcome) {
  Moment moment = moments_.empty() ? Moment{} : moments_.back();
  moment.is_in_path = false;
  if (X_OB_ && outcome != ScanOutcome::kOdometryJumped) {
    const Pose2 step = X_OB_->Inverse() * X_OB;
    moment.X_OB = moment.X_OB * step;
    const double way = step.position().norm() + kWayOfTurn * std::abs(geometry::WrapToPi(step.yaw));
    moment.way += way;
    if (!IsBad(outcome) && time - time_ <= kLongestPause) moment.way_seen += way;
  }
  time_ = time;
  moments_.push_back(moment);
}

void LogLocaliser::JudgePath(JudgedFrom from) {
  std::vector<Judged> poses;
  std::size_t next = 0;
  for (Moment& moment : moments_)
    if (moment.is_in_path) poses.push_back({&moment, localised_.path[next++]});
  if (from == JudgedFrom::kEnd) std::reverse(poses.begin(), poses.end());
  const Judged *before = nullptr, *last_kept = nullptr, *since_leap = nullptr;
  bool is_kept = true;  // the one before
  for (const Judged& pose : poses) {
    if (before) {
      const bool is_seen = IsSeen(*pose.moment, *before->moment), agrees = DoAgree(pose, *before);
      if (is_seen && !agrees) {
        is_kept = DoAgree(pose, *last_kept);
        since_leap = &pose;
      } else if (!is_seen && !is_kept) {
        is_kept = !agrees || !IsHeld(*since_leap->moment, *before->moment);
      }
    }
    before = &pose;
    pose.moment->is_in_path = is_kept;
    if (is_kept) last_kept = &pose;
  }
  TimedPath kept;
  if (from == JudgedFrom::kEnd) std::reverse(poses.begin(), poses.end());
  for (const Judged& pose : poses) {
    if (pose.moment->is_in_path)
      kept.push_back(pose.pose);
    else
      localised_.contradicted.push_back(pose.pose.time);
  }
  localised_.path = std::move(kept);
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

double LogLocaliser::WayKnown() const {
  double known = 0.0;
  for (std::size_t i = 0; i < moments_.size(); ++i)
    if (moments_[i].is_in_path && i > 0) known += moments_[i].way_seen - moments_[i - 1].way_seen;
  if (moments_.empty() || localised_.path.empty()) return 0.0;
  return moments_.back().way_seen > 0.0 ? known / moments_.back().way_seen : 1.0;
}

LocalisedLog LogLocaliser::Result(JudgedFrom from) {
  localised_.since_pose.num_poses = static_cast<int>(localised_.path.size());
  localised_.since_pose.num_relocations = localised_.num_relocations;
  JudgePath(from);
  if (!moments_.empty()) localised_.way = moments_.back().way_seen;
  localised_.way_known = WayKnown();
  if (num_judged_ > 0) localised_.explained /= num_judged_;
  if (num_judged_since_ > 0) localised_.since_pose.explained /= num_judged_since_;
  return std::move(localised_);
}

}  // namespace

std::string WhyDoubtful(const LocalisedLog& localised) {
  if (localised.path.empty()) return "";
  const SincePose& since = localised.since_pose;
  std::vector<std::string> against;
  if (since.num_relocations >= kOftenElsewhere &&
      since.num_relocations > kMostElsewhere * since.num_poses)
    against.push_back(fmt::format("it was found elsewhere {} times", since.num_relocations));
  if (since.num_poses < kFewPoses * since.num_scans)
    against.push_back(fmt::format("{} of {} scans since the first pose have none",
                                  since.num_scans - since.num_poses, since.num_scans));
  if (since.explained < kFewExplained)
    against.push_back(fmt::format("{:.0f} % of the beams are explained", 100.0 * since.explained));
  return base::Join(against, ", ");
}

std::string WhyPartial(const LocalisedLog& localised) {
  if (localised.path.empty() || localised.way_known >= kFewKnown) return "";
  std::string text = fmt::format("where the robot was is known for {:.0f} % of its way",
                                 100.0 * localised.way_known);
  if (!localised.contradicted.empty()) {
    text +=
        fmt::format(", as {} poses before contradict those at last", localised.contradicted.size());
  }
  return text;
}

LocalisedLog LocaliseLog(const RobotLog& log, MonteCarloLocalisation filter,
                         const std::string& task, std::size_t first_scan, JudgedFrom from,
                         std::size_t first_counted) {
  LogLocaliser localiser(log, std::move(filter));
  for (std::size_t i = first_scan; i < log.scans.size(); ++i) {
    localiser.Take(log.scans[i], i >= first_counted);
    base::ReportProgress(task, static_cast<double>(i) / log.scans.size());
  }
  base::ReportProgress(task, 1.0);
  return localiser.Result(from);
}

}  // namespace hires::localisation
