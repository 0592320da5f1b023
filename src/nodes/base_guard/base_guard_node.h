#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/Config.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <hires/BaseRequest.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/control/move_base_tuner.h"
#include "hires/navigation/base_guard.h"
#include "hires/ros/transforms/transform_buffer.h"
#include "nodes/base_guard/base_guard_params.h"

namespace hires_ros {

/// The guard of the base as a process of its own, between the node that drives and the robot: a
/// middle layer that crashes or hangs does not stop it. Velocities come in on base_guard/cmd_vel
/// and requests to drive on base_guard/request; what goes out goes to RobotNames::base_command.
/// What it does is published on base_guard/state (latched) and /diagnostics.
///
/// Its own clock is steady; messages are as old as ROS time says. Where the robot's move_base
/// drives, a request waits until move_base's planner has the request's limits, which are taken back
/// when it is over; and a stop cancels move_base's goals.
///
/// When the node ends in good order while the base moves, it first brings it to a stand.
class BaseGuardNode {
 public:
  BaseGuardNode(const BaseGuardNodeParams& params, ros::NodeHandle* nh);

  /// Works until ROS ends, or `stop` says so and the base has been brought to a stand.
  void Run(const std::function<bool()>& stop);

 private:
  using Steady = std::chrono::steady_clock;

  void Subscribe(ros::NodeHandle* nh);
  void OnRequest(const hires::BaseRequest& msg);
  void OnCommand(const geometry_msgs::Twist& msg);
  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg);
  void OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static);
  void OnLink(hires::navigation::PoseSource source, std::optional<double> stamp);
  hires::geometry::Twist2 VelocityOfBase(const nav_msgs::Odometry& msg);
  void TellOfLooseFrame(const std::string& frame);
  void OnPlannerUpdate(const dynamic_reconfigure::Config& msg);

  double Now() const;  ///< [s] steady, since the node began
  /// When a message's content was so, on the clock of Now().
  double StampOf(const ros::Time& stamp) const;
  void Update();  ///< lets the guard look, and sends what it says
  void TendTuner(double now);
  void PublishState();
  void CancelMoveBase();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const BaseGuardNodeParams params_;
  hires::navigation::BaseGuard guard_;
  const Steady::time_point begin_;
  TransformBuffer tree_;
  std::map<hires::navigation::PoseSource, double> newest_;  // [s] stamp of what is known of a link
  std::set<hires::navigation::PoseSource> static_sources_;  // transforms that never age
  ros::Time last_transforms_;                               // when some came
  std::string loose_frame_;            // of the odometry, that nothing connects with the base
  std::set<std::string> told_frames_;  // of which that was logged

  std::unique_ptr<hires::control::MoveBaseTuner> tuner_;  // where move_base drives
  hires::BaseRequest request_;                            // the last that came
  std::uint64_t tuned_for_{0};  // the request whose limits the planner was told

  struct Said {
    hires::navigation::GuardState state;
    std::uint64_t request;
    hires::base::Failure failure;
    bool operator==(const Said& other) const {
      return state == other.state && request == other.request && failure == other.failure;
    }
  };
  std::unique_ptr<Said> said_;
  long num_stops_{0};
  bool is_ending_{false};  // the node was told to stop

  ros::Publisher base_, state_, cancel_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
};

}  // namespace hires_ros
