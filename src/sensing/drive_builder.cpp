#include "hires/sensing/drive_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/localisation/laser_mount.h"
#include "hires/localisation/scan_outcome.h"
#include "localisation/laser_maximum.h"

namespace hires::sensing {
namespace {

using geometry::Pose3;
using localisation::RobotLog;
using localisation::ScanOutcome;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kLongAgo = -kUnbounded;
constexpr double kLatest = 1.0;          // [s] by which a reading may come too late
constexpr double kLongestGap = 2.0;      // [s] of the odometry that is bridged
constexpr double kMostCoordinate = 1e6;  // [m]
constexpr double kMostRate = 100.0;      // [rad/s]
constexpr std::size_t kMostRanges = 200'000'000;
constexpr char kUnplaced[] = "scans of a laser whose place in the base is not known then";

/// Of those that many robots have.
constexpr const char* kOdometryFrames[] = {"odom", "odom_combined"};
constexpr const char* kBaseFrames[] = {"base_footprint", "base_link"};

bool HasMoment(double stamp) { return std::isfinite(stamp) && stamp > 0.0; }

bool IsPose(const geometry::Pose2& X) {
  return X.IsFinite() && std::abs(X.x) < kMostCoordinate && std::abs(X.y) < kMostCoordinate;
}

double OrZero(double number) { return std::isnan(number) ? 0.0 : number; }

/// In the order of time, each time once.  @return how many were left out.
template <typename Reading>
int PutInOrder(std::vector<Reading>* readings) {
  std::stable_sort(readings->begin(), readings->end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  const auto end = std::unique(readings->begin(), readings->end(),
                               [](const auto& a, const auto& b) { return a.time == b.time; });
  const int left_out = static_cast<int>(readings->end() - end);
  readings->erase(end, readings->end());
  return left_out;
}

}  // namespace

DriveBuilder::DriveBuilder(std::string recording, DriveSource source, bool is_from_tf,
                           const FrameTree& tree)
    : recording_(std::move(recording)),
      source_(std::move(source)),
      is_from_tf_(is_from_tf),
      tree_(tree),
      odometry_frame_(BareFrame(source_.odometry_frame)),
      base_frame_(BareFrame(source_.base_frame)),
      last_odometry_(kLongAgo),
      last_scan_(kLongAgo),
      last_inertia_(kLongAgo) {}

void DriveBuilder::InOrder(double time, const std::string& what, double* last) {
  const double late = *last - time;
  if (late > kLatest) {
    throw base::ConfigError(fmt::format(
        "{}: header.stamp {:.6f} of {} is {:.3f} s before that of an earlier one; wanted times "
        "that grow: if the recording is of several drives, cut it there (`rosbag filter`)",
        recording_, time, what, late));
  }
  if (late > 0.0) ++num_late_;
  *last = std::max(*last, time);
}

void DriveBuilder::OnScan(double stamp, const std::string& frame, robot::ScanReading reading) {
  ++num_scans_;
  if (!HasMoment(stamp)) return LeaveOut("scans whose header.stamp is zero");
  InOrder(stamp, "a scan", &last_scan_);
  num_ranges_ += reading.ranges.size();
  if (num_ranges_ > kMostRanges) {
    throw base::ConfigError(
        fmt::format("{}: its scans have more than {} ranges; cut the recording (`rosbag filter`)",
                    recording_, kMostRanges));
  }
  reading.range_min = OrZero(reading.range_min);
  reading.range_max = OrZero(reading.range_max);
  if (localisation::Examine(reading, reading.range_min, kUnbounded) == ScanOutcome::kBadAngles)
    return LeaveOut("scans whose angles are no numbers, or more than a turn");
  RobotLog::Scan scan;
  scan.time = stamp;
  scan.reading = std::move(reading);
  waiting_.push_back({BareFrame(frame), std::move(scan)});
  PlaceWaiting();
}

void DriveBuilder::OnOdometry(double stamp, const std::string& base_frame,
                              const robot::OdometryReading& reading) {
  if (!HasMoment(stamp)) return LeaveOut("readings of the odometry whose header.stamp is zero");
  if (!IsPose(reading.X_OB))
    return LeaveOut("readings of the odometry that are no numbers within 1e6 m");
  const std::string base = BareFrame(base_frame);
  const std::string wanted = BareFrame(source_.base_frame);
  if (!base.empty() && !wanted.empty() && base != wanted) {
    throw base::ConfigError(fmt::format(
        "--base-frame {}: the odometry of {} is of frame '{}'; leave the option out, or take the "
        "odometry of transforms (--odometry /tf)",
        wanted, recording_, base));
  }
  if (base_frame_.empty()) base_frame_ = base;
  if (!base.empty() && base != base_frame_)
    return LeaveOut("readings of the odometry with another child_frame_id than the first");
  InOrder(stamp, "odometry", &last_odometry_);
  log_.odometry.push_back({stamp, reading});
}

void DriveBuilder::OnInertia(double stamp, const std::string& frame, const UnitReading& reading) {
  if (!HasMoment(stamp))
    return LeaveOut("readings of the inertial unit whose header.stamp is zero");
  const bool is_usable =
      reading.R_WI ? reading.R_WI->coeffs().allFinite() : reading.w_I.norm() < kMostRate;
  if (!is_usable) {
    return LeaveOut(fmt::format(
        "readings of the inertial unit that are no numbers within {:g} rad/s", kMostRate));
  }
  InOrder(stamp, "the inertial unit", &last_inertia_);
  waiting_inertia_.push_back({stamp, BareFrame(frame), reading});
}

void DriveBuilder::OnTransforms() {
  if (is_from_tf_) TakeOdometryOfTransforms();
  PlaceWaiting();
}

void DriveBuilder::ChooseFrames() {
  std::vector<std::string> frames(std::begin(kOdometryFrames), std::end(kOdometryFrames));
  std::vector<std::string> bases(std::begin(kBaseFrames), std::end(kBaseFrames));
  if (!odometry_frame_.empty()) frames = {odometry_frame_};
  if (!base_frame_.empty()) bases = {base_frame_};
  for (const std::string& frame : frames) {
    for (const std::string& base : bases) {
      if (!tree_.NewestOf(frame, base)) continue;
      odometry_frame_ = frame;
      base_frame_ = base;
      return;
    }
  }
}

/// One reading for each moment that is the newest known of all links between.
void DriveBuilder::TakeOdometryOfTransforms() {
  if (odometry_frame_.empty() || base_frame_.empty()) ChooseFrames();
  const std::optional<double> newest = tree_.NewestOf(odometry_frame_, base_frame_);
  if (!newest || !HasMoment(*newest) || *newest <= last_odometry_) return;
  const FramePose found = tree_.Find(odometry_frame_, base_frame_, *newest);
  if (!found.is_found()) return;
  const geometry::Pose2 X_OB = geometry::Flatten(found.X_PC);
  if (!IsPose(X_OB)) return LeaveOut("transforms of the base that are no numbers within 1e6 m");
  last_odometry_ = *newest;
  log_.odometry.push_back({*newest, {X_OB, {}}});
}

void DriveBuilder::PlaceWaiting() {
  while (!waiting_.empty() && Place(&waiting_.front())) waiting_.pop_front();
}

bool DriveBuilder::Place(WaitingScan* waiting) {
  if (source_.X_BL) {
    waiting->scan.X_BL = *source_.X_BL;
    log_.scans.push_back(std::move(waiting->scan));
    return true;
  }
  if (base_frame_.empty() || waiting->frame.empty()) return false;
  const double time = waiting->scan.time;
  const bool is_base = waiting->frame == base_frame_;
  const FramePose found =
      is_base ? FramePose{FrameStatus::kFound, {}} : tree_.Find(base_frame_, waiting->frame, time);
  if (found.is_found()) {
    PlaceAt(found.X_PC, std::move(waiting->scan));
    return true;
  }
  if (found.status != FrameStatus::kNotThen) return false;
  const std::optional<double> newest = tree_.NewestOf(base_frame_, waiting->frame);
  if (!newest || *newest <= time) return false;
  LeaveOut(kUnplaced);
  return true;
}

void DriveBuilder::PlaceAt(const Pose3& X_BL, RobotLog::Scan scan) {
  const auto level = X_BL.IsFinite() ? localisation::LevelLaser(X_BL, &scan.reading) : std::nullopt;
  if (!level) {
    return LeaveOut(fmt::format("scans of a laser that is tilted by more than {:g} rad",
                                localisation::kMostLaserTilt));
  }
  scan.X_BL = *level;
  log_.scans.push_back(std::move(scan));
}

void DriveBuilder::PlaceRest() {
  for (WaitingScan& waiting : waiting_) {
    if (Place(&waiting)) continue;  // it stood behind one of another frame
    const bool is_named = !base_frame_.empty() && !waiting.frame.empty();
    const FramePose found =
        is_named ? tree_.Find(base_frame_, waiting.frame, kUnbounded) : FramePose{};
    if (found.is_found()) {
      PlaceAt(found.X_PC, std::move(waiting.scan));
    } else {
      LeaveOut(kUnplaced);
      unplaced_frame_ = waiting.frame;
    }
  }
  waiting_.clear();
}

void DriveBuilder::PlaceInertia() {
  std::map<std::string, FramePose> units;  // in the base
  for (const auto& [time, frame, reading] : waiting_inertia_) {
    if (units.count(frame) == 0) {
      const double newest = tree_.NewestOf(base_frame_, frame).value_or(kUnbounded);
      units[frame] = frame == base_frame_ ? FramePose{FrameStatus::kFound, {}}
                                          : tree_.Find(base_frame_, frame, newest);
    }
    const FramePose& X_BI = units[frame];
    if (frame.empty() || !X_BI.is_found()) {
      LeaveOut("readings of an inertial unit whose place in the base is not known");
      continue;
    }
    const Eigen::Quaterniond& R_BI = X_BI.X_PC.rotation;
    RobotLog::Inertia inertia{time, {}, (R_BI * reading.w_I).z()};
    if (reading.R_WI) inertia.yaw = geometry::YawOf(*reading.R_WI * R_BI.inverse());
    log_.inertia.push_back(inertia);
  }
  waiting_inertia_.clear();
}

void DriveBuilder::RequireOdometry() const {
  if (!log_.odometry.empty()) return;
  if (!is_from_tf_) {
    throw base::ConfigError(
        fmt::format("{}: no reading of its odometry can be used{}", recording_, LeftOutText()));
  }
  const auto named = [](const std::string& frame, const auto& usual) {
    return frame.empty() ? fmt::format("'{}' or '{}'", usual[0], usual[1]) : "'" + frame + "'";
  };
  throw base::ConfigError(fmt::format(
      "{}: has no odometry: no topic of nav_msgs/Odometry is used, and its transforms do not tell "
      "how base {} moves in {} ({}); record /tf or the odometry's topic too, or name the frames "
      "with "
      "--odometry-frame and --base-frame{}",
      recording_, named(base_frame_, kBaseFrames), named(odometry_frame_, kOdometryFrames),
      FramesText(), LeftOutText()));
}

void DriveBuilder::LeaveOutBeyondOdometry() {
  const auto is_beyond = [&](const RobotLog::Scan& scan) {
    const auto after = std::lower_bound(
        log_.odometry.begin(), log_.odometry.end(), scan.time,
        [](const RobotLog::Odometry& odometry, double t) { return odometry.time < t; });
    if (after != log_.odometry.end() && after->time == scan.time) return false;
    if (after == log_.odometry.begin() || after == log_.odometry.end()) {
      LeaveOut("scans from before the first or after the last odometry");
      return true;
    }
    if (after->time - (after - 1)->time <= kLongestGap) return false;
    LeaveOut(fmt::format("scans within a gap of the odometry of more than {:g} s", kLongestGap));
    return true;
  };
  log_.scans.erase(std::remove_if(log_.scans.begin(), log_.scans.end(), is_beyond),
                   log_.scans.end());
}

void DriveBuilder::RequireScans() const {
  if (!log_.scans.empty()) return;
  if (left_out_.count(kUnplaced) > 0) {
    const std::string place = fmt::format("where the laser's frame '{}' is in the base '{}'",
                                          unplaced_frame_, base_frame_);
    const std::string what =
        base_frame_.empty()
            ? "its odometry has no child_frame_id (--base-frame names it), so it "
              "is not known where the laser is in the base"
            : fmt::format("its /tf and /tf_static do not tell {} ({})", place, FramesText());
    throw base::ConfigError(
        fmt::format("{}: {}; record both topics too, or say it with --laser \"x y yaw\" [m, m, "
                    "rad]{}",
                    recording_, what, LeftOutText()));
  }
  throw base::ConfigError(
      fmt::format("{}: none of its {} scans can be used{}", recording_, num_scans_, LeftOutText()));
}

/// "they tell of base_link, odom"
std::string DriveBuilder::FramesText() const {
  std::vector<std::string> names = tree_.Names();
  std::sort(names.begin(), names.end());
  return names.empty() ? "they tell of no frame"
                       : "they tell of " + base::Shortened(base::Join(names, ", "), 500);
}

/// "; left out: 3 scans whose header.stamp is zero", or nothing.
std::string DriveBuilder::LeftOutText() const {
  std::vector<std::string> parts;
  for (const auto& [what, count] : left_out_) parts.push_back(fmt::format("{} {}", count, what));
  return parts.empty() ? "" : "; left out: " + base::Join(parts, ", ");
}

RobotLog DriveBuilder::Take() {
  PlaceWaiting();
  PlaceRest();
  PlaceInertia();
  const int twice =
      PutInOrder(&log_.scans) + PutInOrder(&log_.odometry) + PutInOrder(&log_.inertia);
  if (twice > 0) left_out_["readings with the stamp of another one"] += twice;
  RequireOdometry();
  LeaveOutBeyondOdometry();
  RequireScans();
  const double said = log_.scans.front().reading.range_max;
  const std::string maximum = localisation::TakeLaserMaximum(&log_);
  const auto warn = [&](const std::string& what) {
    base::Log(base::LogLevel::kWarn, recording_ + ": " + what);
  };
  if (num_late_ > 0) warn(fmt::format("{} readings came late; put in order", num_late_));
  for (const auto& [what, count] : left_out_) warn(fmt::format("left out {} {}", count, what));
  if (!maximum.empty()) {
    warn(maximum + (said > 0.0 ? fmt::format("; range_max of the scans says {:g}", said)
                               : "; range_max of the scans tells none"));
  }
  return std::move(log_);
}

}  // namespace hires::sensing
