#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/Detections.h>
#include <hires/ExecuteActionActionGoal.h>
#include <hires/ExecuteActionActionResult.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/ros/odometry_frame.h"
#include "hires/ros/world_tracker_params.h"
#include "hires/ros/world_tracker_senses.h"
#include "hires/ros/world_tracker_sweep.h"
#include "hires/ros/world_tracker_writer.h"

namespace hires_ros {

/// Turns what the robot senses into fluents on the Blackboard and into the objects that the middle
/// layer's skills know of.
class WorldTrackerNode {
 public:
  WorldTrackerNode(const WorldTrackerParams& params, hires::translation::TranslatorContext context,
                   ros::NodeHandle* nh);

 private:
  void Subscribe(ros::NodeHandle* nh);
  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg);
  void OnTransforms(const tf2_msgs::TFMessage& msg);
  void OnJoints(const sensor_msgs::JointState& msg);
  void OnDetections(const hires::Detections& msg);
  void OnGoal(const hires::ExecuteActionActionGoal& msg);
  void OnResult(const hires::ExecuteActionActionResult& msg);

  /// Calls `read`; what it says is wrong with a message becomes a warning.
  void Guard(const std::string& topic, const std::function<void()>& read);
  void Process();
  void HandleLate(const TrackerMoment& moment);
  void Handle(const TrackerMoment& moment);
  void ReadView();
  void PublishKnown(const TrackerMoment& moment,
                    const std::vector<hires::robot::SeenObject>& known);
  hires::translation::ObservedWorld Observed(
      const TrackerMoment& moment, const std::vector<hires::robot::SeenObject>& known) const;
  void TellActions();
  void Warn(const std::string& topic, const std::string& text);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const WorldTrackerParams params_;
  const hires::translation::TranslatorContext context_;
  const std::shared_ptr<const hires::perception::Surroundings> surroundings_;
  std::map<std::string, std::pair<double, double>> joint_limits_;  // by joint that may be set
  OdometryFrame odometry_frame_;
  TrackerSenses senses_;
  hires::sensing::ObjectMemory memory_;
  HeadSweep sweep_;
  std::map<std::string, std::string> running_;  // goal id -> action
  double time_{0.0};                            // [s] of the last moment
  double published_{-1e9};                      // [s] when known objects were told last
  std::map<std::string, double> warned_;        // topic -> steady [s]
  double hands_changed_{-1e9};                  // [s] when one took or let go of something
  std::uint64_t num_moments_{0}, num_looks_{0}, num_outdated_{0}, num_bad_{0};

  std::atomic<bool> is_view_new_{false};
  ros::Publisher known_, head_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  ObservationWriter writer_;  // last: its threads end first
};

}  // namespace hires_ros
