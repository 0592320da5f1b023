#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/Detections.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"
#include "hires/ros/sensing/sensor_receiver.h"
#include "hires/sensing/ground_watch.h"
#include "hires/sensing/observation_maker.h"
#include "hires/sensing/scan_obstacles.h"

namespace hires_ros {

/// What a robot's topics say of it and of what it sees, as observations for skills.
class RobotInputs {
 public:
  struct Hooks {
    /// A message was taken in; transforms count with the moment up to which the robot is localised.
    std::function<void(const std::string& topic, double stamp)> arrived;
    std::function<void()> clock_restarted;  ///< stamps begin again
  };

  RobotInputs(const hires::imagination::ImaginationSetup& setup,
              const hires::control::RobotNames& names, const hires::sensing::ScanParams& scan,
              Hooks hooks, ros::NodeHandle* nh);

  const hires::sensing::RobotStateEstimator& state() const { return sensors_.state(); }

  /// @param now  where the robot is, by state().
  hires::robot::Observation ObservationOf(const hires::sensing::RobotEstimate& now);

  /// What has not come, by the names of topics and frames; empty: nothing is missing.
  std::string Missing() const { return sensors_.NameOf(state().MissingNow()); }
  int num_bad() const { return sensors_.num_bad(); }  ///< messages, or parts of them

 private:
  void Subscribe(ros::NodeHandle* nh);
  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnJoints(const sensor_msgs::JointState& msg);
  void OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static);
  void OnScan(const sensor_msgs::LaserScan& msg);
  void OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg);
  void OnCloud(const sensor_msgs::PointCloud2& msg);
  void OnTrayScan(const sensor_msgs::LaserScan& msg);
  void OnDetections(const hires::Detections& msg);

  const hires::control::RobotNames names_;
  const Hooks hooks_;
  SensorReceiver sensors_;
  hires::sensing::ObservationMaker observations_;
  std::optional<hires::sensing::GroundWatch> ground_;  // of a robot that sees the floor
  int num_restarts_{0};                                // of the robot's clock
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hires_ros
