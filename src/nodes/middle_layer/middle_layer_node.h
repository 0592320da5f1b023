#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/control/action_runner.h"
#include "hires/imagination/imagination_setup.h"
#include "nodes/middle_layer/action_goals.h"
#include "nodes/middle_layer/base_driving.h"
#include "nodes/middle_layer/drive_display.h"
#include "nodes/middle_layer/lockstep_client.h"
#include "nodes/middle_layer/middle_layer_params.h"
#include "nodes/middle_layer/robot_controllers.h"
#include "nodes/middle_layer/robot_inputs.h"

namespace hires_ros {

/// Carries out steps with the robot's own skills: the action `execute_action`. Several at once
/// where they need different groups of joints. The skills are those that rollouts play; here they
/// see what the robot's topics say, and what they want goes to its controllers.
///
/// When the node ends in good order it stops what runs, and with that the robot; when it is killed,
/// the base's own timeout does.
///
/// On a real robot a guard stands between the skills and the base: velocities go to it, with a
/// request for permission that lives as long as this node does. When it stops the base, or the
/// motors halt, everything that runs fails with that.
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
  using Steady = std::chrono::steady_clock;

  hires::control::ActionRunner::Hooks RunnerHooks();
  ActionGoals::Hooks GoalHooks();
  void ConnectRobot(ros::NodeHandle* nh);

  std::set<std::string> GroupsOf(const hires::base::ActionCall& action) const;
  hires::base::Failure WhyNotReady(const hires::base::ActionCall& action) const;
  hires::base::Failure Start(int id, const hires::base::ActionCall& action, double time_limit);
  void OnEnded(const hires::control::ActionNews& news, hires::control::ActionEnd end,
               const hires::base::Failure& failure);

  void OnMotorsHalted(bool are_halted);
  void OnArrived(const std::string& topic, double stamp);
  void LookWhereFree();  ///< without lockstep: as soon as a newer moment is complete
  void LookAtTick();     ///< in lockstep: once all sensors of the tick are there
  void LookAt(double time, double stamp);
  void AnswerTick();

  void Send(const hires::robot::Command& command);
  void PublishFeedback();
  void ShowDrive(const std::vector<hires::control::ActionNews>& news);
  void Tend();  ///< what is due by the clocks
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const MiddleLayerParams params_;
  const hires::imagination::ImaginationSetup setup_;
  std::optional<RobotControllers> controllers_;  // none in a dry run
  std::unique_ptr<BaseDriving> driving_;         // likewise
  hires::control::ActionRunner runner_;
  ActionGoals goals_;
  DriveDisplay display_;
  std::unique_ptr<LockstepClient> lockstep_;  // null without lockstep
  RobotInputs inputs_;
  double looked_{-1.0};           // [s] stamp of the last look
  Steady::time_point last_look_;  // when it was
  bool are_motors_halted_{false};
  ros::Subscriber motors_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer heartbeat_;
};

}  // namespace hires_ros
