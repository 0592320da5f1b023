#include "hires/mapping/mapper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "base/averages.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/progress.h"
#include "hires/geometry/angles.h"
#include "hires/mapping/map_doubt.h"
#include "hires/robot/odometry_jumps.h"
#include "mapping/draw_grid.h"
#include "mapping/keyframe_map.h"
#include "mapping/motion_comparison.h"
#include "mapping/odometry_track.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;
using localisation::RobotLog;

constexpr double kMatchSpacing = 0.05;   // [m] between points that are matched
constexpr double kJumpSd = 0.3;          // [m], [rad] after a reset of the odometry
constexpr double kUntoldSd = 0.1;        // [m], [rad] between scans without odometry
constexpr double kSearchedSd = 0.05;     // [m], [rad] of a pose that was searched for
constexpr double kBeyond = 4.0;          // sd of a prior that no odometry errs by
constexpr double kBeyondAtLeast = 0.03;  // [m], [rad] likewise
constexpr double kFitsNothing = 0.9;     // share of scans from which on there is no map
constexpr double kUsualRange = 3.0;      // [m] in rooms
constexpr double kSuspicious = 20.0;     // [m] more than that in the median is another unit
constexpr double kDrawnStep = 0.05;      // [m], [rad] between scans that are drawn

bool IsFarFrom(const Pose2& a, const Pose2& b, double step) {
  return (a.position() - b.position()).norm() > step ||
         std::abs(geometry::WrapToPi(a.yaw - b.yaw)) > step;
}

/// What odometry tells, where the laser tells nothing.
ScanMatch ByOdometry(const PosePrior& prior) {
  ScanMatch match;
  match.X_MB = prior.X_MB;
  const Eigen::Vector3d sd(prior.position_sd, prior.position_sd, prior.yaw_sd);
  match.information.diagonal() = sd.cwiseAbs2().cwiseInverse();
  return match;
}

/// Whether the laser shows the odometry wrong: by the wide search, or where its match lies farther
/// from the prior than any odometry errs.
bool ContradictsOdometry(const ScanMatch& match, const PosePrior& prior) {
  if (match.is_searched) return true;
  const Pose2 off = prior.X_MB.Inverse() * match.X_MB;
  return match.fit >= kGoodFit &&
         (off.position().norm() > kBeyondAtLeast + kBeyond * prior.position_sd ||
          std::abs(geometry::WrapToPi(off.yaw)) > kBeyondAtLeast + kBeyond * prior.yaw_sd);
}

/// " Are ranges in centimetres? ..." where their median is one of no room; else nothing.
std::string QuestionOfUnits(const RobotLog& log) {
  std::vector<float> ranges;
  for (const RobotLog::Scan& scan : log.scans) {
    for (const float range : scan.reading.ranges)
      if (std::isfinite(range) && range > 0.0F) ranges.push_back(range);
  }
  if (ranges.empty()) return "";
  const auto [least, most] = std::minmax_element(ranges.begin(), ranges.end());
  if (*least == *most) {
    return fmt::format("; all its ranges are {:g}, as a laser says where it meets nothing", *most);
  }
  const double middle = base::Median(ranges);
  if (middle < kSuspicious) return "";
  const auto distance = [&](double unit) {
    return std::abs(std::log(middle / unit / kUsualRange));
  };
  const bool is_centimetres = distance(100.0) < distance(1000.0);
  return fmt::format(
      "; half of its ranges are longer than {:.0f}, wanted metres: are they in {}? Divide them by "
      "{}",
      middle, is_centimetres ? "centimetres" : "millimetres", is_centimetres ? 100 : 1000);
}

}  // namespace

class Mapper::Impl {
 public:
  explicit Impl(const MapperParams& params)
      : params_(params),
        track_(params.max_linear_speed, params.max_angular_speed),
        jumps_(params.max_linear_speed, params.max_angular_speed),
        keyframes_(params),
        X_MB_(params.X_MBegin) {}

  void AddOdometry(const RobotLog::Odometry& odometry) {
    track_.Add(odometry.time, odometry.reading.X_OB);
    TakeThoseThatNeedNotWait();
  }
  void AddScan(const RobotLog::Scan& scan) {
    HIRES_CHECK(scan.time >= last_time_, "times of scans do not go back");
    last_time_ = scan.time;
    waiting_.push_back(scan);
    TakeThoseThatNeedNotWait();
  }
  std::optional<localisation::TimedPose> newest() const;
  MapCounts counts() const {
    return {keyframes_.size(),
            keyframes_.num_loops(),
            num_lost_,
            odometry_jumps_,
            static_cast<int>(records_.size()),
            num_searched_,
            keyframes_.num_breaks(),
            comparison_.turns_alike(),
            comparison_.ways_alike(),
            comparison_.num_stretches(),
            comparison_.num_disagreed()};
  }
  MapSketch sketch() const;
  MapResult Result();

 private:
  /// Where a scan was made, from the keyframe before it.
  struct Record {
    double time{0.0};
    int keyframe{0};
    Pose2 X_KB;
  };

  /// What odometry is added to.
  struct Anchor {
    Pose2 X_MB;
    std::optional<Pose2> X_OB;
    double sd{0.0};  // [m], [rad] by which the robot may have moved beside
  };

  void TakeThoseThatNeedNotWait();
  void TakeFirstWaiting();
  void TakeScan(const RobotLog::Scan& scan);
  void TakeReset();
  void NoteBreak(const SurfacePoints& few, const std::optional<ScanMatch>& match, bool is_due);
  PosePrior Predict(const RobotLog::Scan& scan);
  void Keep(const RobotLog::Scan& scan);
  Pose2 PoseAt(std::size_t record) const;

  MapperParams params_;
  OdometryTrack track_;
  robot::OdometryJumps jumps_;          // of what scans say themselves
  std::deque<RobotLog::Scan> waiting_;  // for odometry
  double last_time_{std::numeric_limits<double>::lowest()};

  KeyframeMap keyframes_;
  Anchor anchor_;
  Pose2 X_MB_;                 // at the last scan
  std::optional<Pose2> X_OB_;  // odometry there
  double time_{0.0}, way_{0.0};
  std::optional<Pose2> moved_;  // since the last scan, where odometry tells it
  MotionComparison comparison_;

  std::vector<Record> records_;                               // of all scans
  std::vector<std::shared_ptr<const RobotLog::Scan>> drawn_;  // those that show something new
  std::vector<std::size_t> drawn_records_;                    // which they are
  int num_lost_{0}, num_searched_{0}, odometry_jumps_{0};
  bool was_unfit_{false};   // the last scan saw much, and fitted nothing
  int resets_of_track_{0};  // that were taken
};

void Mapper::Impl::TakeThoseThatNeedNotWait() {
  while (!waiting_.empty() && (waiting_.front().X_OB || track_.Reaches(waiting_.front().time)))
    TakeFirstWaiting();
}

void Mapper::Impl::TakeFirstWaiting() {
  RobotLog::Scan scan = std::move(waiting_.front());
  waiting_.pop_front();
  if (!scan.X_OB) {
    scan.X_OB = track_.At(scan.time);
    if (track_.num_resets() > resets_of_track_) TakeReset();
  }
  TakeScan(scan);
}

/// The track goes on without it; how the robot moved meanwhile is not known.
void Mapper::Impl::TakeReset() {
  odometry_jumps_ += track_.num_resets() - resets_of_track_;
  resets_of_track_ = track_.num_resets();
  anchor_.sd = kJumpSd;
}

void Mapper::Impl::TakeScan(const RobotLog::Scan& scan) {
  const PosePrior prior = Predict(scan);
  SurfacePoints points = PointsOf(scan, params_.max_range);
  SurfacePoints few = Thinned(points, kMatchSpacing);
  const std::optional<ScanMatch> match = keyframes_.Match(few, prior);
  if (!match && keyframes_.size() > 0) ++num_lost_;
  const Pose2 X_MBefore = X_MB_;
  X_MB_ = match ? match->X_MB : prior.X_MB;
  const bool disagree = match && ContradictsOdometry(*match, prior);
  if (match && moved_) {
    comparison_.Add(X_MBefore.Inverse() * X_MB_, *moved_, disagree);
  } else {
    comparison_.Restart();
  }
  const bool is_due = !points.empty() && keyframes_.IsDue(X_MB_);
  NoteBreak(few, match, is_due);
  // Else the next slip of the odometry would be looked for from here on, beside this one.
  if (disagree) {
    anchor_ = {X_MB_, scan.X_OB, kSearchedSd};
    ++num_searched_;
    keyframes_.NoteSlip();
  }
  if (keyframes_.size() == 0 || is_due) {
    X_MB_ =
        keyframes_.Add(std::move(points), std::move(few), match ? *match : ByOdometry(prior), way_);
    anchor_ = {X_MB_, scan.X_OB, 0.0};
  }
  Keep(scan);
}

/// One scan alone may be spoilt; a keyframe or a second scan that fits nothing is a break, and so
/// is what was found only by a search and fits badly.
void Mapper::Impl::NoteBreak(const SurfacePoints& few, const std::optional<ScanMatch>& match,
                             bool is_due) {
  const bool is_doubtful = match ? match->is_searched && match->fit < kGoodFit : SeesMuch(few);
  if (is_doubtful && (match || is_due || was_unfit_)) keyframes_.NoteBreak();
  was_unfit_ = is_doubtful && !match;
}

/// From the anchor on, not from the last scan: where walls tell nothing, as along a corridor, the
/// noise of many matches would add up to more than the odometry's error.
PosePrior Mapper::Impl::Predict(const RobotLog::Scan& scan) {
  const bool is_told = X_OB_ && scan.X_OB;
  const Pose2 moved = is_told ? X_OB_->Inverse() * *scan.X_OB : Pose2{};
  const bool is_jump = is_told && jumps_.IsJump(moved, scan.time - time_);
  if (is_jump) ++odometry_jumps_;
  moved_ = is_told && !is_jump ? std::make_optional(moved) : std::nullopt;
  if (is_jump || !is_told) anchor_ = {X_MB_, scan.X_OB, is_jump ? kJumpSd : kUntoldSd};
  if (!is_jump) way_ += moved.position().norm();
  X_OB_ = scan.X_OB;
  time_ = scan.time;
  const Pose2 since = is_told ? anchor_.X_OB->Inverse() * *scan.X_OB : Pose2{};
  const double way = since.position().norm();
  return {anchor_.X_MB * since, 0.003 + params_.odometry_sd * way + anchor_.sd,
          0.002 + params_.odometry_sd * (std::abs(since.yaw) + way) + anchor_.sd};
}

void Mapper::Impl::Keep(const RobotLog::Scan& scan) {
  const int keyframe = keyframes_.size() - 1;
  records_.push_back({scan.time, keyframe, keyframes_.pose(keyframe).Inverse() * X_MB_});
  if (!drawn_.empty() && !IsFarFrom(X_MB_, PoseAt(drawn_records_.back()), kDrawnStep)) return;
  drawn_.push_back(std::make_shared<const RobotLog::Scan>(scan));
  drawn_records_.push_back(records_.size() - 1);
}

Pose2 Mapper::Impl::PoseAt(std::size_t i) const {
  return keyframes_.pose(records_[i].keyframe) * records_[i].X_KB;
}

std::optional<localisation::TimedPose> Mapper::Impl::newest() const {
  if (records_.empty()) return std::nullopt;
  return localisation::TimedPose{records_.back().time, PoseAt(records_.size() - 1)};
}

MapSketch Mapper::Impl::sketch() const {
  MapSketch sketch{drawn_, {}, params_.resolution, params_.max_range, keyframes_.Returns()};
  for (const std::size_t record : drawn_records_) sketch.X_MBs.push_back(PoseAt(record));
  return sketch;
}

MapResult Mapper::Impl::Result() {
  while (!waiting_.empty()) TakeFirstWaiting();
  MapResult result{counts(), {}, {}, {}};
  for (std::size_t i = 0; i < records_.size(); ++i)
    result.trajectory.push_back({records_[i].time, PoseAt(i)});
  const MapSketch drawn = sketch();
  result.grid = Draw(drawn);
  result.evidence = EvidenceOf(drawn, result.grid);
  return result;
}

world::OccupancyGrid Draw(const MapSketch& sketch) {
  std::vector<const RobotLog::Scan*> scans;
  for (const auto& scan : sketch.scans) scans.push_back(scan.get());
  return DrawGrid(scans, sketch.X_MBs, sketch.resolution, sketch.max_range);
}

Mapper::Mapper(const MapperParams& params) : impl_(std::make_unique<Impl>(params)) {}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;

void Mapper::AddOdometry(const RobotLog::Odometry& odometry) { impl_->AddOdometry(odometry); }
void Mapper::AddScan(const RobotLog::Scan& scan) { impl_->AddScan(scan); }
std::optional<localisation::TimedPose> Mapper::newest() const { return impl_->newest(); }
MapCounts Mapper::counts() const { return impl_->counts(); }
MapSketch Mapper::sketch() const { return impl_->sketch(); }
MapResult Mapper::Result() { return impl_->Result(); }

MapResult MakeMap(const RobotLog& log, const MapperParams& params, const std::string& task) {
  const bool has_met = std::any_of(log.scans.begin(), log.scans.end(), [&](const auto& scan) {
    return !PointsOf(scan, params.max_range).empty();
  });
  if (!has_met) {
    throw base::ConfigError(
        "no scan of the log measured anything; wanted a drive on which a laser met walls" +
        QuestionOfUnits(log));
  }
  Mapper mapper(params);
  auto odometry = log.odometry.begin();
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    for (; odometry != log.odometry.end() && odometry->time <= log.scans[i].time; ++odometry)
      mapper.AddOdometry(*odometry);
    mapper.AddScan(log.scans[i]);
    base::ReportProgress(task, static_cast<double>(i) / log.scans.size());
  }
  for (; odometry != log.odometry.end(); ++odometry) mapper.AddOdometry(*odometry);
  const int num_lost = mapper.counts().num_lost;
  if (num_lost > kFitsNothing * static_cast<double>(log.scans.size())) {
    throw base::ConfigError(
        fmt::format("{} of {} scans fit nothing that was seen before, so there is no map{}",
                    num_lost, log.scans.size(), QuestionOfUnits(log)));
  }
  MapResult result = mapper.Result();
  base::ReportProgress(task, 1.0);
  return result;
}

}  // namespace hires::mapping
