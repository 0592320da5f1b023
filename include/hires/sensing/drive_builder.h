#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/localisation/robot_log.h"
#include "hires/sensing/frame_tree.h"

namespace hires::sensing {

/// Which messages of a recording are the drive. What is empty is found where only one thing fits.
struct DriveSource {
  std::string scan;            ///< topic of the laser
  std::string odometry;        ///< topic of the odometry; /tf: transforms tell it
  std::string imu;             ///< topic of the inertial unit; empty: none is used
  std::string odometry_frame;  ///< for odometry of transforms; empty: odom or odom_combined
  std::string base_frame;      ///< empty: that of the odometry's messages; of transforms
                               ///< base_footprint or base_link, whichever is connected first
  std::optional<geometry::Pose2> X_BL;  ///< laser in base, in place of what the transforms say
};

/// What an inertial unit says, in its own frame I.
struct UnitReading {
  std::optional<Eigen::Quaterniond> R_WI;        ///< W is level, of any heading; may be unknown
  Eigen::Vector3d w_I{Eigen::Vector3d::Zero()};  ///< [rad/s] rate; what counts where R_WI is not
};

/// Makes a log of what a robot said while it drove: scans, odometry, readings of its inertial unit,
/// and where frames are.
///
/// Stamps [s] are those in the messages. Readings up to 1 s late are put in order, of two with one
/// stamp the first one stays. A scan waits until the transforms tell where its laser was at its
/// stamp; what still waits at the end takes the newest they know. A laser that hangs upside down is
/// turned over, as localisation::LevelLaser does. Where `range_max` is larger than what the laser
/// says where it meets nothing, that shows by how often it says it, and counts. How an inertial
/// unit is mounted does not change: the newest that the transforms tell will do.
///
/// Left out, counted, and told as warnings: readings without stamp, with numbers that are none, of
/// another base, of an inertial unit of which the transforms tell nothing; scans with angles that
/// are none, of a tilted laser, from before its place was known, from before the first or after the
/// last odometry, and from within a gap of the odometry of more than 2 s.
class DriveBuilder {
 public:
  /// @param recording   for messages: "drive.bag".
  /// @param is_from_tf  the transforms tell the odometry.
  /// @param tree        what the recording said of frames so far; must outlive this.
  DriveBuilder(std::string recording, DriveSource source, bool is_from_tf, const FrameTree& tree);
  DriveBuilder(const DriveBuilder&) = delete;

  /// @param frame  of the laser.
  /// @throws base::ConfigError if the time jumps back by more than 1 s, or the ranges are too many
  /// to be held.
  void OnScan(double stamp, const std::string& frame, robot::ScanReading reading);

  /// @param base_frame  that the pose is of; it may be empty.
  /// @throws base::ConfigError if the time jumps back by more than 1 s, or where base_frame of the
  /// source is another one.
  void OnOdometry(double stamp, const std::string& base_frame,
                  const robot::OdometryReading& reading);

  /// @param frame  of the unit.
  /// @throws base::ConfigError if the time jumps back by more than 1 s.
  void OnInertia(double stamp, const std::string& frame, const UnitReading& reading);

  void OnTransforms();  ///< the tree knows more

  /// Counts what could not be handed over: "scans of another version of their type".
  void LeaveOut(const std::string& what) { ++left_out_[what]; }

  /// The log; it has a scan and odometry. Velocities are those of the odometry's messages, 0 where
  /// transforms tell it.
  /// @throws base::ConfigError saying what is missing: no odometry, nobody says where the laser
  /// is, no scan that can be used.
  localisation::RobotLog Take();

 private:
  struct WaitingScan {
    std::string frame;
    localisation::RobotLog::Scan scan;
  };
  struct WaitingInertia {
    double time;
    std::string frame;
    UnitReading reading;
  };
  void ChooseFrames();
  void TakeOdometryOfTransforms();
  void PlaceWaiting();
  /// @return whether it waits no longer.
  bool Place(WaitingScan* waiting);
  void PlaceAt(const geometry::Pose3& X_BL, localisation::RobotLog::Scan scan);
  void PlaceRest();
  void PlaceInertia();
  void InOrder(double time, const std::string& what, double* last);
  void RequireOdometry() const;
  void LeaveOutBeyondOdometry();
  void RequireScans() const;
  std::string FramesText() const;
  std::string LeftOutText() const;

  std::string recording_;
  DriveSource source_;
  bool is_from_tf_;
  const FrameTree& tree_;
  std::string odometry_frame_, base_frame_;  // once they are known
  std::deque<WaitingScan> waiting_;
  std::vector<WaitingInertia> waiting_inertia_;
  std::string unplaced_frame_;  // of a laser whose place nobody told
  localisation::RobotLog log_;
  double last_odometry_, last_scan_, last_inertia_;  // [s] latest times so far
  int num_late_{0};
  std::size_t num_scans_{0}, num_ranges_{0};
  std::map<std::string, int> left_out_;
};

}  // namespace hires::sensing
