#pragma once

#include <sensor_msgs/LaserScan.h>

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "hires/control/robot_names.h"
#include "hires/localisation/live_scan_params.h"
#include "hires/localisation/scan_outcome.h"
#include "hires/ros/transforms/transform_listener.h"

namespace hires_ros {

/// A scan in the plane of the base, and where the robot was then.
struct PlacedScan {
  std_msgs::Header header;
  hires::robot::ScanReading reading;
  hires::geometry::Pose2 X_OB;  ///< base in the odometry's frame
  hires::geometry::Pose2 X_BL;  ///< laser in the base
};

/// For people: what of a scan makes that outcome.
std::string WhyBad(hires::localisation::ScanOutcome outcome,
                   const hires::robot::ScanReading& reading);

/// A laser's scans while they are made. Each is handed over once tf says where odometry and laser
/// were at its stamp, in the order in which they came; what cannot be used is dropped with the
/// reason: scans without stamp or frame, too old, of the future, of a tilted laser, those whose
/// transform is still unknown when that of a later one is known, and the first one where more than
/// 100 wait (2.5 s at 40 Hz).
class PlacedScans {
 public:
  static constexpr std::size_t kMostWaiting = 100;
  using OnScan = std::function<void(const PlacedScan&)>;
  using OnDrop = std::function<void(const std::string& why)>;

  /// @param tree   must outlive this.
  /// @param names  frames of odometry and base.
  PlacedScans(const TransformBuffer& tree, const hires::control::RobotNames& names,
              const hires::localisation::LiveScanParams& limits, OnScan on_scan, OnDrop on_drop);
  PlacedScans(const PlacedScans&) = delete;

  /// Until this is empty again, all scans wait for it.
  void Need(const std::string& what) { needed_ = what; }

  void Add(const sensor_msgs::LaserScanConstPtr& scan);

  /// Hands over the scans that wait, as far as all else is there. There may be many, and more
  /// transforms: after each of these `are_all_tried` is false, which looks at the first scan alone.
  void Try(bool are_all_tried);

  /// Drops those that can no longer be used, whatever comes.
  void DropUseless();

  void Forget();  ///< those that wait

  /// What the first one waits for; empty: none waits, or just for a moment, as scans do that are
  /// faster than the transforms of their time.
  std::string waits_for() const;

 private:
  /// Odometry and laser at the time of a scan.
  struct Mount {
    Placement X_OB, X_BL;
    bool is_known() const { return X_OB.X_PC && X_BL.X_PC; }
    std::string waits_for() const;
    std::string why_never() const;
  };

  std::string WhyUntimely(const ros::Time& stamp) const;
  Mount MountOf(const sensor_msgs::LaserScan& scan) const;
  void HandOver(const sensor_msgs::LaserScan& scan, const Mount& mount);

  const TransformBuffer& tree_;
  const std::string odometry_frame_, base_frame_;
  const hires::localisation::LiveScanParams limits_;
  OnScan on_scan_;
  OnDrop on_drop_;
  std::string needed_;
  std::deque<sensor_msgs::LaserScanConstPtr> waiting_;
  std::string waits_for_;
  std::optional<double> handed_over_;  // [s] steady, the last one
};

}  // namespace hires_ros
