#pragma once

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/BaseGuardState.h>
#include <hires/Detections.h>
#include <hires/ExecuteActionAction.h>
#include <hires/LockstepAck.h>
#include <hires/LockstepTick.h>
#include <hires/WorldState.h>
#include <ros/node_handle.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <list>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/control/action_runner.h"
#include "hires/control/override_watch.h"
#include "hires/ros/sensor_receiver.h"
#include "hires/sensing/observation_maker.h"
#include "nodes/middle_layer/middle_layer_leave.h"
#include "nodes/middle_layer/middle_layer_params.h"
#include "nodes/middle_layer/move_base_link.h"

namespace hires_ros {

/// Carries out steps with the robot's own skills: the action `execute_action`. Several at once
/// where they need different groups of joints. The skills are those that rollouts play; here they
/// see what the robot's topics say, and what they want goes to its controllers.
///
/// A robot that nobody watches stands: when the node ends in good order it stops what runs; when it
/// is killed, the base's own timeout does.
///
/// On a real robot a guard stands between the skills and the base: velocities go to it, with a
/// request for leave that lives as long as this node does. When it stops the base, or the motors
/// halt, everything that runs fails with that.
///
/// In a dry run no controller has a publisher here, and every goal is refused.
///
/// In lockstep with a simulated robot, each tick is answered when all skills that were due have
/// looked at the sensors of that very stamp and what they want is on its way.
class MiddleLayerNode {
 public:
  MiddleLayerNode(const MiddleLayerParams& params, hires::imagination::ImaginationSetup setup,
                  ros::NodeHandle* nh);

  /// Works until `stop` says so or ROS ends; then stops the robot.
  void Run(const std::function<bool()>& stop);

 private:
  using Server = actionlib::ActionServer<hires::ExecuteActionAction>;
  using GoalHandle = Server::GoalHandle;
  using Steady = std::chrono::steady_clock;

  /// A goal whose controllers and sensors may not be connected yet.
  struct Waiting {
    GoalHandle goal;
    Steady::time_point since;
  };
  struct Going {
    GoalHandle goal;
    double next_feedback{0.0};  // [s] since its start
    std::string phase;
  };

  void Subscribe(ros::NodeHandle* nh);
  void Advertise(ros::NodeHandle* nh);
  void OnGoal(GoalHandle goal);
  void OnCancel(GoalHandle goal);
  void StartWaiting();
  void StartGoal(GoalHandle goal);
  std::set<std::string> GroupsOf(const hires::base::ActionCall& action) const;
  std::unique_ptr<hires::skills::Skill> MakeSkill(const hires::base::ActionCall& action) const;
  void OnEnded(const hires::control::ActionNews& news, hires::control::ActionEnd end,
               const hires::base::Failure& failure);

  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnMotorsHalted(bool are_halted);
  void OnGuardStopped(const hires::base::Failure& failure);
  void OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static);
  void OnScan(const sensor_msgs::LaserScan& msg);
  void OnDetections(const hires::Detections& msg);
  void OnTick(const hires::LockstepTick& msg);
  void Note(const std::string& topic, double stamp);

  void LookAt(double time, double stamp);
  hires::robot::Observation ObservationOf(const hires::sensing::RobotEstimate& now);
  void WeighLoad(double time, const hires::robot::Observation& seen);
  void LookWhereFree();  ///< without lockstep: as soon as a newer moment is complete
  void LookAtTick();     ///< in lockstep: once all sensors of the tick are there
  bool IsTickComplete() const;
  void AnswerTick();
  void OnWake();
  void Tend();  ///< what is due by the clocks
  void AskForLeave();
  void PublishFeedback();
  void Send(const hires::robot::Command& command);
  hires::base::Failure WhyNotReady(const std::set<std::string>& groups) const;
  std::string MissingController(const std::set<std::string>& groups) const;
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const MiddleLayerParams params_;
  const hires::imagination::ImaginationSetup setup_;
  SensorReceiver sensors_;
  hires::sensing::ObservationMaker observations_;
  hires::control::ActionRunner runner_;
  BaseLeave leave_;
  hires::control::OverrideWatch override_;
  std::shared_ptr<MoveBaseLink> move_base_;             // where it drives long ways; else null
  hires::navigation::BrakingLimits braking_{0.0, 0.0};  // what the load bears; 0: unknown
  double weighed_{-1.0};                                // [s] when that was found out
  bool are_motors_halted_{false};

  std::map<std::string, double> arrived_;  // topic -> newest stamp [s]
  double looked_{-1.0};                    // [s] stamp of the last look
  int restarts_{0};                        // of the robot's clock
  std::optional<hires::LockstepTick> tick_;
  std::optional<hires::LockstepAck> acked_;  // the last one
  bool is_tick_looked_at_{false};
  std::string awaited_;  // node for whose answers the robot waits
  std::uint64_t commands_since_ack_{0};
  Steady::time_point last_look_;

  std::list<Waiting> waiting_;
  std::map<int, Going> going_;
  int next_id_{1};
  long num_ended_{0};

  ros::Publisher base_, request_, ack_;
  std::map<std::string, ros::Publisher> trajectories_, grippers_;  // by group, by arm
  std::vector<ros::Subscriber> subscribers_;
  Server server_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer heartbeat_;
};

}  // namespace hires_ros
