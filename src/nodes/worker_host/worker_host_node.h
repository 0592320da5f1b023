#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/base/process.h"
#include "hires/relay/relay_params.h"
#include "hires/relay/restart_policy.h"
#include "hires/relay/worker_host_params.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/master_watch.h"

namespace hires_ros {

/// The file in ~config; ~index, ~base_port, ~address, ~nice, ~worker_command, ~worker_arguments
/// and ~environment win over it.  @throws hires::base::ConfigError.
hires::relay::WorkerHostParams LoadWorkerHostParams();

/// Keeps one worker alive: its master, then its node and the relay between both masters. When one
/// of them dies, all three are stopped and started again: the worker's node would never register
/// at a new master, and a worker that lost its relay is of no use to anybody.
class WorkerHostNode {
 public:
  /// Nothing is started yet.
  /// @throws hires::base::ConfigError if the relay's file is wrong, or others could not reach the
  /// worker at its address.
  WorkerHostNode(const hires::relay::WorkerHostParams& params, ros::NodeHandle* nh);
  ~WorkerHostNode();

  /// Runs the worker until a stop signal, the end of ROS, the loss of the main master or too many
  /// deaths in a row. On return no child is left.
  /// @return The program's exit code.
  /// @throws hires::base::ConfigError if the worker cannot be started at all: port taken, program
  /// missing.
  int Run(hires::base::StopSignals* signals, const MasterWatch& master_watch);

 private:
  enum class Phase { kWaiting, kMasterStarting, kNodesStarting, kReady, kGaveUp };
  static const char* NameOf(Phase phase);

  void Tick(double now);
  void StartMaster(double now);
  void AwaitMaster(double now);
  void StartNodes(double now);
  void AwaitCrossing(double now);
  void WatchChildren(double now);
  void OnFailure(const std::string& what, double now);
  void RequireFreePort() const;
  bool HasCrossed();
  void StopAll();
  double WaitTime(double now) const;
  void PublishDiagnostics();
  std::string PidText(const std::optional<hires::base::ChildProcess>& child) const;
  std::vector<std::string> Filled(const std::vector<std::string>& words) const;
  std::vector<std::string> WorkerEnvironment() const;

  hires::relay::WorkerHostParams params_;
  hires::relay::RelayParams relay_params_;
  XmlRpcMasterApi main_;
  ros::Publisher diagnostics_;
  hires::relay::RestartPolicy policy_;
  Phase phase_{Phase::kWaiting};
  double phase_since_{0.0};    // [s] on the steady clock, as all times here
  double start_at_{0.0};       // when to leave kWaiting
  double started_at_{0.0};     // when this life of the worker began
  double time_to_ready_{0.0};  // [s] of the last start
  double next_diagnostics_{0.0};
  std::string last_failure_;
  std::optional<hires::base::ChildProcess> master_;
  std::optional<hires::base::ChildProcess> worker_;
  std::optional<hires::base::ChildProcess> relay_;
};

/// Waits until the main master answers. False if a stop signal comes first.
bool WaitForMainMaster(hires::base::StopSignals* signals);

}  // namespace hires_ros
