#include "hires/ros/place/placed_scans.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/process.h"
#include "hires/localisation/laser_mount.h"
#include "hires/ros/robot/scan_messages.h"

namespace hires_ros {
namespace {

namespace localisation = hires::localisation;

std::string WhyMalformed(const std_msgs::Header& header) {
  if (header.stamp.isZero()) return "header.stamp is 0, wanted the scan's time";
  if (hires::sensing::BareFrame(header.frame_id).empty())
    return "header.frame_id is empty, wanted the laser's frame";
  return "";
}

}  // namespace

std::string WhyBad(localisation::ScanOutcome outcome, const hires::robot::ScanReading& reading) {
  return fmt::format("{}: {} ranges, angle_min {:g}, angle_increment {:g} rad, {:g} to {:g} m",
                     localisation::ToString(outcome), reading.ranges.size(), reading.angle_min,
                     reading.angle_increment, reading.range_min, reading.range_max);
}

std::string PlacedScans::Mount::waits_for() const {
  return X_OB.waits_for.empty() ? X_BL.waits_for : X_OB.waits_for;
}

std::string PlacedScans::Mount::why_never() const {
  return X_OB.why_never.empty() ? X_BL.why_never : X_OB.why_never;
}

PlacedScans::PlacedScans(const TransformBuffer& tree, const hires::control::RobotNames& names,
                         const localisation::LiveScanParams& limits, OnScan on_scan, OnDrop on_drop)
    : tree_(tree),
      odometry_frame_(names.odometry_frame),
      base_frame_(names.base_frame),
      limits_(limits),
      on_scan_(std::move(on_scan)),
      on_drop_(std::move(on_drop)) {}

void PlacedScans::Add(const sensor_msgs::LaserScanConstPtr& scan) {
  const std::string why = WhyMalformed(scan->header);
  if (!why.empty()) return on_drop_(why);
  waiting_.push_back(scan);
  DropUseless();
  Try(true);
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  on_drop_(fmt::format("{} newer scans wait as well, for {}", kMostWaiting, waits_for_));
}

std::string PlacedScans::WhyUntimely(const ros::Time& stamp) const {
  const double age = (ros::Time::now() - stamp).toSec();
  // There is one clock in simulated time: a scan ahead of it came before the message on /clock.
  const bool is_simulated = ros::Time::isSimTime();
  const double max_ahead =
      is_simulated ? std::max(limits_.max_ahead, limits_.max_age) : limits_.max_ahead;
  if (age < -max_ahead) {
    return fmt::format("its stamp lies {:.1f} s in the future, wanted {:g} at most; {}", -age,
                       max_ahead,
                       is_simulated ? "let what gives the time on /clock give the scans as well"
                                    : "synchronise the clocks of the computers");
  }
  if (age <= limits_.max_age) return "";
  if (waits_for_.empty()) {
    return fmt::format(
        "it is {:.1f} s old, wanted {:g} at most; play bags with --clock and "
        "use_sim_time",
        age, limits_.max_age);
  }
  return fmt::format("it waited until it was {:.1f} s old for {}", age, waits_for_);
}

PlacedScans::Mount PlacedScans::MountOf(const sensor_msgs::LaserScan& scan) const {
  const double time = scan.header.stamp.toSec();
  return {PlaceAt(tree_, odometry_frame_, base_frame_, time),
          PlaceAt(tree_, base_frame_, hires::sensing::BareFrame(scan.header.frame_id), time)};
}

void PlacedScans::Try(bool are_all_tried) {
  if (waiting_.empty()) return;
  if (ros::Time::now().isZero()) {
    waits_for_ = "the time on /clock";
    return;
  }
  if (!needed_.empty()) {
    waits_for_ = needed_;
    return;
  }
  for (std::size_t i = 0; i < waiting_.size();) {
    const Mount mount = MountOf(*waiting_[i]);
    if (!mount.is_known()) {
      if (i == 0) waits_for_ = mount.waits_for();
      if (!are_all_tried) return;
      ++i;
      continue;
    }
    // What is known of a later scan will not become known of an earlier one.
    for (; i > 0; --i) {
      const Mount earlier = MountOf(*waiting_.front());
      waiting_.pop_front();
      on_drop_("tf knows all of a later scan already, but of this one not " + earlier.waits_for() +
               earlier.why_never());
    }
    const sensor_msgs::LaserScanConstPtr scan = waiting_.front();
    waiting_.pop_front();
    waits_for_.clear();
    handed_over_ = hires::base::SteadyNow();
    HandOver(*scan, mount);
  }
}

void PlacedScans::HandOver(const sensor_msgs::LaserScan& scan, const Mount& mount) {
  hires::robot::ScanReading reading = ReadingOf(scan);
  const auto X_BL = localisation::LevelLaser(*mount.X_BL.X_PC, &reading);
  if (!X_BL) {
    return on_drop_(
        fmt::format("its laser '{}' is tilted by {:.2f} rad in '{}', wanted a level one, "
                    "or one upside down, within {:g} rad",
                    scan.header.frame_id, hires::geometry::TiltOf(mount.X_BL.X_PC->rotation),
                    base_frame_, localisation::kMostLaserTilt));
  }
  on_scan_({scan.header, std::move(reading), hires::geometry::Flatten(*mount.X_OB.X_PC), *X_BL});
}

void PlacedScans::DropUseless() {
  if (ros::Time::now().isZero()) return;
  for (auto scan = waiting_.begin(); scan != waiting_.end();) {
    std::string why = WhyUntimely((*scan)->header.stamp);
    if (why.empty()) why = MountOf(**scan).why_never();
    if (why.empty()) {
      ++scan;
      continue;
    }
    scan = waiting_.erase(scan);
    on_drop_(why);
  }
  if (waiting_.empty()) waits_for_.clear();
}

std::string PlacedScans::waits_for() const {
  constexpr double kMoment = 1.0;  // [s]
  const bool is_served = handed_over_ && hires::base::SteadyNow() - *handed_over_ < kMoment;
  return is_served ? "" : waits_for_;
}

void PlacedScans::Forget() {
  waiting_.clear();
  waits_for_.clear();
}

}  // namespace hires_ros
