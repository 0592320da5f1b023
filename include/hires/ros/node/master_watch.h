#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace hires_ros {

/// Exit codes by which a supervisor can tell why a node of this package ended.
constexpr int kExitMasterGone = 69;  ///< the master did not come back in time

struct MasterWatchParams {
  double poll_period{0.2};   ///< [s] between two looks
  double call_timeout{0.5};  ///< [s] after which the master counts as silent
};

/// Watches the node's own master. A roscpp node registers once and never again: when its master is
/// replaced by a new process, the node goes on unregistered. The watch notices (other process id,
/// other run_id, or own registration gone), puts back what the new master's parameter server lost
/// (the node's private parameters and /use_sim_time, as they were when the watch was made, unless
/// they were set again), and shuts ROS down; Finish() then starts the program again in the
/// same process, so that roslaunch or any other parent sees the same child.
///
///   ros::init(argc, argv, "planner");
///   ros::NodeHandle nh;                      // registers the node
///   hires_ros::MasterWatch master_watch;
///   ... { node; ros::spin(); } ...           // the node is destroyed before Finish()
///   return master_watch.Finish(EXIT_SUCCESS);
class MasterWatch {
 public:
  /// @pre ROS is started (there is a NodeHandle).
  explicit MasterWatch(const MasterWatchParams& params = {});
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// True once the master is a new one; ROS is being shut down then.
  bool is_replaced() const { return is_replaced_; }

  /// [s] since the master last answered; 0 while it does. For nodes that give up some day.
  double silent_for() const { return silent_for_; }

  /// Ends the watch. Returns `code`, or starts the program again if the master was replaced.
  int Finish(int code);

 private:
  void Run();
  void Stop();

  MasterWatchParams params_;
  std::map<std::string, XmlRpc::XmlRpcValue> parameters_;  // to be put back
  std::atomic<bool> is_replaced_{false};
  std::atomic<double> silent_for_{0.0};
  std::mutex mutex_;
  std::condition_variable stop_;
  bool is_stopping_{false};
  std::thread thread_;
};

/// Replaces this process by a fresh start of the same program with the same arguments; open files
/// but the standard ones are closed, blocked signals are unblocked. Returns only if that fails.
void RestartProgram();

/// Makes SIGINT, SIGTERM and SIGHUP shut ROS down in good order (roscpp by itself: SIGINT only).
void ShutDownRosOnSignals();

/// Makes them do nothing but be noted, for nodes that have to bring the robot to a stand first: ROS
/// lives on. Give ros::init_options::NoSigintHandler.
void NoteStopSignals();
bool IsStopWanted();  ///< one of them came

}  // namespace hires_ros
