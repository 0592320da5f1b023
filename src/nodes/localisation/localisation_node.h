#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/GetMap.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>
#include <topic_tools/shape_shifter.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/localisation/monte_carlo.h"
#include "hires/ros/place/placed_scans.h"
#include "hires/ros/transforms/transform_listener.h"
#include "hires/ros/values/pose_messages.h"
#include "hires/ros/world/map_request.h"
#include "nodes/localisation/localisation_params.h"
#include "nodes/localisation/pose_keeper.h"

namespace hires_ros {

/// Tells where the robot is in a map, by its base laser and what tf says of its odometry: the
/// interface of AMCL. With a map of a file it is the map server, too. Scans are used in the order
/// of their stamps, each once tf says where odometry and laser were then, so the same messages give
/// the same poses, bit for bit. What cannot be used is dropped with the reason, and the poses go on
/// without it. Where nobody said where the robot begins, and its scans do not fit the place that
/// the configuration names, nothing is told until it is found: that place is nobody's belief.
class LocalisationNode {
 public:
  LocalisationNode(const LocalisationNodeParams& params, ros::NodeHandle* nh);

 private:
  using Empty = std_srvs::Empty;

  void Listen(ros::NodeHandle* nh);
  void ServeMap(ros::NodeHandle* nh);  ///< that of a file
  void OnMap(const nav_msgs::OccupancyGrid& msg);
  void BeginWith(const hires::world::OccupancyGrid& map);
  void AskForMap();  ///< where none was latched
  void OnInitialPose(const geometry_msgs::PoseWithCovarianceStamped& msg);
  bool SetPose(const UncertainPose& pose);
  bool OnGlobalLocalisation(Empty::Request& request, Empty::Response& response);
  bool OnNoMotionUpdate(Empty::Request& request, Empty::Response& response);

  void OnTransforms(const TransformBuffer::News& news);
  void OnScan(const topic_tools::ShapeShifter& msg);
  void Use(const PlacedScan& scan);
  bool IsLessSure(double stamp) const;
  void GoOnFromKept(const PlacedScan& scan);
  void Keep(const PlacedScan& scan);
  bool NoteLost(double stamp);
  void Publish(const ros::Time& stamp, bool is_new);

  void Refuse(const std::string& topic, const std::string& why);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  std::string WhatMapItWaitsFor() const;
  void DiagnoseBelief(diagnostic_updater::DiagnosticStatusWrapper& status);

  const LocalisationNodeParams params_;
  ros::NodeHandle nh_;
  TransformListener transforms_;
  PlacedScans scans_;
  MapRequest map_server_;
  std::optional<nav_msgs::OccupancyGrid> map_;                         // that is used
  std::optional<hires::localisation::MonteCarloLocalisation> filter_;  // once there is a map
  Eigen::AlignedBox2d extent_;                                         // of that map
  std::optional<UncertainPose> told_;  // the pose, before there was a map
  std::optional<KeptPlace> kept_;      // of a process before, until something is used
  PoseKeeper keeper_;
  bool is_updated_{false};  // by a scan since it began
  bool is_lost_{false};     // as was told last
  bool has_place_;          // whether somebody said where it begins, or its scans agreed with it
  Eigen::Matrix3d told_covariance_{Eigen::Matrix3d::Zero()};
  double begun_;  // [s] steady

  std::string last_drop_;                     // the last message that was dropped, and why
  std::map<std::string, long> num_outcomes_;  // of scans that the filter heard
  std::map<std::string, long> num_dropped_;   // by topic
  hires::base::TopicWarnings warnings_;
  long num_scans_{0};

  ros::Publisher pose_, particles_, transform_, map_publisher_;
  std::vector<ros::Subscriber> inputs_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
