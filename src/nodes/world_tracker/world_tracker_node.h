#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/Detections.h>
#include <hires/ExecuteActionActionGoal.h>
#include <hires/ExecuteActionActionResult.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/control/world_tracker.h"
#include "hires/ros/robot/controller_topics.h"
#include "hires/ros/sensing/sensor_receiver.h"
#include "hires/skills/action_set.h"
#include "nodes/world_tracker/world_tracker_params.h"
#include "nodes/world_tracker/world_tracker_writer.h"

namespace hires_ros {

/// Turns what the robot senses into fluents on the Blackboard and into the objects that the middle
/// layer's skills know of.
class WorldTrackerNode {
 public:
  WorldTrackerNode(const WorldTrackerParams& params, hires::translation::TranslatorContext context,
                   ros::NodeHandle* nh);

 private:
  void Subscribe(ros::NodeHandle* nh);
  template <typename Message>
  void SubscribeTo(ros::NodeHandle* nh, const std::string& topic, int queue,
                   std::function<void(const Message&)> take);
  void OnScan(const sensor_msgs::LaserScan& msg);
  void OnCloud(const sensor_msgs::PointCloud2& msg);
  void ShowTray();
  void OnGoal(const hires::ExecuteActionActionGoal& msg);
  void OnResult(const hires::ExecuteActionActionResult& msg);

  void ReadView();
  void PublishKnown(const hires::sensing::RobotEstimate& now,
                    const std::vector<hires::robot::SeenObject>& known);
  hires::control::WorldTracker::Hooks TrackerHooks();
  void TellActions();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const WorldTrackerParams params_;
  const hires::translation::TranslatorContext context_;
  const std::shared_ptr<const hires::skills::ActionSet> actions_;
  SensorReceiver sensors_;
  std::optional<hires::sensing::FloorWatch>
      floor_;  // of a robot with a laser, or clouds of the floor
  hires::control::WorldTracker tracker_;
  std::map<std::string, std::string> running_;  // goal id -> action

  std::atomic<bool> is_view_new_{false};
  ros::Publisher known_, tray_markers_;
  int num_shown_{0};  // scans of the tray so far
  TrajectoryTopic head_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  ObservationWriter writer_;  // last: its threads end first
};

}  // namespace hires_ros
