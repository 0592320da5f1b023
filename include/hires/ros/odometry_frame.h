#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "hires/ros/robot_messages.h"

namespace hires_ros {

/// Puts odometry into the frame that localisation corrects. A PR2's wheels count in a frame of
/// their own (`odom`); a filter joins them with the IMU and tells by tf where the base is in
/// `odom_combined`, 30 times a second. In between the wheels say how it went on. Knows no clock:
/// all times are stamps [s].
class OdometryFrame {
 public:
  /// @param frame  tf's name of the odometry's frame (RobotNames::odometry_frame).
  explicit OdometryFrame(std::string frame) : frame_(std::move(frame)) {}

  /// What tf says of the base in the frame.
  void OnTransform(double stamp, const hires::geometry::Pose2& X_OB);

  /// The reading with its pose in the frame; nothing while tf has not told where its own frame is.
  /// A reading that is in the frame already is given back as it is.
  std::optional<OdometryReading> Take(double stamp, const std::string& frame_id,
                                      const OdometryReading& raw);

 private:
  struct Raw {
    double stamp;
    hires::geometry::Pose2 X_RB;  // in the wheels' frame R
  };
  void Align();

  std::string frame_;
  std::deque<Raw> raw_;  // of the last second, oldest first
  std::optional<std::pair<double, hires::geometry::Pose2>> told_;  // by tf, not made use of yet
  std::optional<hires::geometry::Pose2> X_OR_;
};

/// tf names frames without the slash that old nodes put in front.
std::string BareFrame(const std::string& frame);

/// Where tf says that `child` is in `parent`, in the plane; nothing where it tells of other frames,
/// or no numbers.
std::optional<hires::geometry::Pose2> PoseBetween(const geometry_msgs::TransformStamped& transform,
                                                  const std::string& parent,
                                                  const std::string& child);

}  // namespace hires_ros
