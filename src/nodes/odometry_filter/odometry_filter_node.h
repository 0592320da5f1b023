#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Imu.h>

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/localisation/heading_feed.h"
#include "hires/localisation/odometry_filter.h"
#include "hires/ros/transforms/transform_listener.h"
#include "nodes/odometry_filter/odometry_filter_params.h"

namespace hires_ros {

/// Joins wheel odometry and an inertial unit's heading, or the integral of its rate where it tells
/// no orientation: the interface of robot_pose_ekf. Odometry
/// waits for the inertial readings of its time and for how tf says they are mounted, imu_wait of
/// its own time at most; so the same messages give the same poses, bit for bit, as long as the unit
/// is not later than that.
class OdometryFilterNode {
 public:
  OdometryFilterNode(const OdometryFilterNodeParams& params, ros::NodeHandle* nh);

 private:
  struct Waiting {
    ros::Time stamp;
    hires::robot::OdometryReading reading;
  };
  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnInertia(const sensor_msgs::Imu& msg);
  void Advance();  ///< filters what need not wait any more
  bool MustWait(const Waiting& first) const;
  void UseInertia();
  void DropUnplaced();
  void Filter(const Waiting& odometry);
  void Note(const std::string& topic, hires::localisation::FilterOutcome outcome);
  void Drop(const std::string& topic, const std::string& why);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const OdometryFilterNodeParams params_;
  ros::NodeHandle nh_;
  TransformListener transforms_;
  hires::localisation::OdometryFilter filter_;
  hires::localisation::HeadingFeed heading_;
  std::deque<Waiting> waiting_;
  std::deque<sensor_msgs::Imu> unplaced_;       // tf does not say yet how their unit is mounted
  ros::Time newest_odometry_, newest_inertia_;  // stamps that came last
  double odometry_came_{-1e9}, inertia_came_{-1e9};            // [s] steady
  std::map<std::string, std::map<std::string, long>> counts_;  // topic -> outcome -> readings
  hires::base::TopicWarnings warnings_;
  std::string last_drop_;

  ros::Publisher pose_, transform_;
  std::vector<ros::Subscriber> inputs_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
