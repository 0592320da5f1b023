#include "localisation/log_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr double kUsualSpeed = 0.5;          // [m/s], [rad/s] of times that are made up
constexpr double kShortest = 0.01;           // [s] between two of them
constexpr double kLongest = 1.0;             // [s]; a reset of the odometry stays one
constexpr std::size_t kFewReadings = 5;      // that tell nothing
constexpr double kContradiction = 1.0;       // [m], [rad]
constexpr double kContradictingShare = 0.1;  // of the scans
constexpr double kNoMotion = 0.01;           // of the odometry's way

template <typename Readings>
std::size_t NumOfSameTime(const Readings& readings) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < readings.size(); ++i)
    if (readings[i].time <= readings[i - 1].time) ++count;
  return count;
}

template <typename Readings>
bool DoTimesStand(const Readings& readings) {
  return readings.size() > kFewReadings && 2 * NumOfSameTime(readings) > readings.size();
}

/// A reading of either kind.
struct Reading {
  int line;
  double* time;
  const Pose2* X_OB;  // null: its motion is not looked at
};

std::vector<Reading> InOrderOfLines(const LogLines& lines, RobotLog* log) {
  std::vector<Reading> readings;
  const bool has_odometry = !log->odometry.empty();
  for (std::size_t i = 0; i < log->odometry.size(); ++i) {
    RobotLog::Odometry& odometry = log->odometry[i];
    readings.push_back({lines.odometry[i], &odometry.time, &odometry.reading.X_OB});
  }
  for (std::size_t i = 0; i < log->scans.size(); ++i) {
    RobotLog::Scan& scan = log->scans[i];
    readings.push_back(
        {lines.scans[i], &scan.time, has_odometry || !scan.X_OB ? nullptr : &*scan.X_OB});
  }
  std::sort(readings.begin(), readings.end(),
            [](const Reading& a, const Reading& b) { return a.line < b.line; });
  return readings;
}

double TurnOf(const Pose2& step) { return std::abs(geometry::WrapToPi(step.yaw)); }

/// [s] that pass before each reading at the usual speed.
std::vector<double> MadeUpDurations(const std::vector<Reading>& readings) {
  std::vector<double> durations;
  const Pose2* last = nullptr;
  for (const Reading& reading : readings) {
    double duration = kShortest;
    if (reading.X_OB && last) {
      const Pose2 step = last->Inverse() * *reading.X_OB;
      duration = std::max(step.position().norm(), TurnOf(step)) / kUsualSpeed;
    }
    if (reading.X_OB) last = reading.X_OB;
    durations.push_back(std::clamp(duration, kShortest, kLongest));
  }
  return durations;
}

/// Where odometry is in the frame of a scan's own pose, by the first scan that has both, and how
/// far scans are from there.
class Agreement {
 public:
  /// @param before, behind  odometry of the lines around the scan's; null: there is none.
  void Take(const Pose2& X_SB, const Pose2* before, const Pose2* behind) {
    if (!before) return;
    if (!X_SO_) X_SO_ = X_SB * before->Inverse();
    double error = ErrorOf(X_SB, *before);
    if (behind) error = std::min(error, ErrorOf(X_SB, *behind));
    ++num_compared_;
    if (error > kContradiction) ++num_contradicting_;
    if (last_) way_ += (X_SB.position() - last_->position()).norm();
    if (last_before_) way_of_odometry_ += (before->position() - last_before_->position()).norm();
    last_ = X_SB;
    last_before_ = *before;
  }
  bool is_contradicted() const { return num_contradicting_ > kContradictingShare * num_compared_; }
  std::string Text() const {
    if (way_ < kNoMotion * way_of_odometry_) {
      return fmt::format("the scans' own poses move by {:.2f} m, the lines ODOM by {:.1f} m", way_,
                         way_of_odometry_);
    }
    return fmt::format(
        "the own poses of {} of {} scans are more than {:g} m or {:g} rad from the "
        "lines ODOM around them",
        num_contradicting_, num_compared_, kContradiction, kContradiction);
  }

 private:
  double ErrorOf(const Pose2& X_SB, const Pose2& X_OB) const {
    const Pose2 step = (*X_SO_ * X_OB).Inverse() * X_SB;
    return std::max(step.position().norm(), TurnOf(step));
  }

  std::optional<Pose2> X_SO_, last_, last_before_;
  int num_compared_{0}, num_contradicting_{0};
  double way_{0.0}, way_of_odometry_{0.0};  // [m]
};

}  // namespace

std::string SpreadEqualTimes(const LogLines& lines, RobotLog* log) {
  HIRES_CHECK(
      lines.odometry.size() == log->odometry.size() && lines.scans.size() == log->scans.size(),
      "each reading has its line");
  const std::size_t num_same = NumOfSameTime(log->odometry) + NumOfSameTime(log->scans);
  if (!DoTimesStand(log->odometry) && !DoTimesStand(log->scans)) return "";
  const std::vector<Reading> readings = InOrderOfLines(lines, log);
  const std::vector<double> durations = MadeUpDurations(readings);
  for (std::size_t begin = 0; begin < readings.size();) {
    const double time = *readings[begin].time;
    std::size_t end = begin + 1;
    while (end < readings.size() && *readings[end].time <= time) ++end;
    double passed = 0.0;
    for (std::size_t i = begin + 1; i < std::min(end + 1, readings.size()); ++i)
      passed += durations[i];
    const bool is_last = end == readings.size();
    const double share = is_last ? 1.0 : std::min(1.0, (*readings[end].time - time) / passed);
    double since = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (i > begin) since += share * durations[i];
      *readings[i].time = time + since;
    }
    begin = end;
  }
  return fmt::format(
      "times do not advance: {} of {} readings have the time of the one before. They are taken in "
      "the order of their lines, as if driven at {:g} m/s and turned at {:g} rad/s: write times "
      "with all their digits",
      num_same, readings.size(), kUsualSpeed, kUsualSpeed);
}

std::string LeaveOutContradicting(RobotLog* log) {
  Agreement agreement;
  std::size_t next = 0;  // odometry behind the scan
  for (std::size_t i = 0; i < log->scans.size(); ++i) {
    while (next < log->odometry.size() && log->odometry[next].time <= log->scans[i].time) ++next;
    const auto pose = [&](std::size_t k) {
      return k < log->odometry.size() ? &log->odometry[k].reading.X_OB : nullptr;
    };
    if (log->scans[i].X_OB)
      agreement.Take(*log->scans[i].X_OB, next > 0 ? pose(next - 1) : nullptr, pose(next));
  }
  if (!agreement.is_contradicted()) return "";
  for (RobotLog::Scan& scan : log->scans) scan.X_OB.reset();
  return agreement.Text() + ": odometry is that of the lines ODOM";
}

}  // namespace hires::localisation
