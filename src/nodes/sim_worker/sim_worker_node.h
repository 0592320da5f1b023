#pragma once

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/RolloutAction.h>
#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "hires/base/mailbox.h"
#include "hires/imagination/imagination_setup.h"
#include "nodes/sim_worker/robot_broadcaster.h"

namespace hires_ros {

struct SimWorkerParams {
  int index{1};  ///< k of worker_k
  hires::imagination::SetupConfig setup;
  double display_rate{20.0};  ///< [Hz] of /clock, /tf, odometry and markers, by the wall's clock
};

/// The file in ~config (config/sim_worker.yaml where there is none); ~index, ~world, ~robot,
/// ~objects and ~uncertainty win over it, ~action_libraries adds to it.  @throws
/// hires::base::ConfigError.
SimWorkerParams LoadSimWorkerParams();

/// Plays rollouts for any client: the action worker_k/rollout. Goals wait for their turn in the
/// order in which they came; they are played on a thread beside the ROS callbacks. Feedback carries
/// one rollout each, the result all of them once more. The robot's URDF is the parameter
/// /robot_description of the worker's master.
class SimWorkerNode {
 public:
  SimWorkerNode(const SimWorkerParams& params, hires::imagination::ImaginationSetup setup,
                ros::NodeHandle* nh);
  ~SimWorkerNode();

 private:
  using Server = actionlib::ActionServer<hires::RolloutAction>;
  using GoalHandle = Server::GoalHandle;

  void OnGoal(GoalHandle goal);
  void OnCancel(GoalHandle goal);
  void Work();
  void Play(GoalHandle goal);
  bool PlayRange(GoalHandle goal, const hires::imagination::RolloutSetup& setup,
                 hires::RolloutResult* result);
  hires::imagination::RolloutSetup SetupFor(const hires::RolloutGoal& goal) const;
  bool IsCancelled(const std::string& id) const;
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  SimWorkerParams params_;
  hires::imagination::ImaginationSetup setup_;
  RobotBroadcaster broadcaster_;
  hires::base::Mailbox<GoalHandle> waiting_;
  mutable std::mutex cancelled_mutex_;
  std::set<std::string> cancelled_;  // goal ids
  std::atomic<long> rollouts_played_{0};
  std::atomic<bool> stop_{false};
  Server server_;
  diagnostic_updater::Updater updater_;
  ros::Timer heartbeat_;
  std::thread thread_;
};

}  // namespace hires_ros
