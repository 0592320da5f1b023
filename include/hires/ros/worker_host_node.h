#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/relay/relay_params.h"
#include "hires/relay/restart_policy.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/process.h"
#include "hires/ros/xmlrpc_master_api.h"

namespace hires_ros {

struct WorkerHostParams {
  int index{1};                      ///< k: the worker is /worker_k on port base_port + k
  int base_port{11411};              ///< 1024 .. 65000
  std::string address{"127.0.0.1"};  ///< on which master and worker listen; dotted numbers
  int nice{10};                      ///< of all three children, 0 .. 19
  /// Programs with arguments. {index}, {ns}, {port}, {address}, {master} (the worker's master, as
  /// URI) and {relay_config} stand for this worker's own.
  std::vector<std::string> master_command;
  std::vector<std::string> worker_command;
  std::vector<std::string> worker_arguments;  ///< added to worker_command
  std::vector<std::string> relay_command;
  std::string relay_config;              ///< path
  std::vector<std::string> environment;  ///< of the worker: "NAME=value" sets, "NAME" removes
  double start_timeout{10.0};            ///< [s] for the worker's master to answer
  double ready_timeout{60.0};            ///< [s] for the worker's first topic to cross
  double stop_grace{1.0};                ///< [s] from SIGTERM to SIGKILL
  double main_master_timeout{10.0};      ///< [s] of silence after which the host gives up
  hires::relay::RestartLimits restart;

  int port() const { return base_port + index; }
  std::string name_space() const { return "/worker_" + std::to_string(index); }
  std::string master_uri() const {
    return "http://" + address + ":" + std::to_string(port()) + "/";
  }
};

/// Reads config/worker_host.yaml; all keys are required. A relative `relay_config` is taken from
/// `folder`.  @throws hires::base::ConfigError for a missing, unknown or unfit key.
WorkerHostParams ReadWorkerHostParams(hires::base::ParamReader in, const std::string& folder);

/// The file in ~config; ~index, ~base_port, ~address, ~nice, ~worker_command, ~worker_arguments
/// and ~environment win over it.  @throws hires::base::ConfigError.
WorkerHostParams LoadWorkerHostParams();

/// `text` with the placeholders of WorkerHostParams filled in.
/// @throws hires::base::ConfigError for a placeholder that is none of them.
std::string FillIn(const std::string& text, const WorkerHostParams& params);

/// Keeps one worker alive: its master, then its node and the relay between both masters. When one
/// of them dies, all three are stopped and started again: the worker's node would never register
/// at a new master, and a worker that lost its relay is of no use to anybody.
class WorkerHostNode {
 public:
  /// Nothing is started yet.
  /// @throws hires::base::ConfigError if the relay's file is wrong, or others could not reach the
  /// worker at its address.
  WorkerHostNode(const WorkerHostParams& params, ros::NodeHandle* nh);
  ~WorkerHostNode();

  /// Runs the worker until a stop signal, the end of ROS, the loss of the main master or too many
  /// deaths in a row. On return no child is left.
  /// @return The program's exit code.
  /// @throws hires::base::ConfigError if the worker cannot be started at all: port taken, program
  /// missing.
  int Run(StopSignals* signals, const MasterWatch& master_watch);

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
  std::string PidText(const std::optional<ChildProcess>& child) const;
  std::vector<std::string> Filled(const std::vector<std::string>& words) const;
  std::vector<std::string> WorkerEnvironment() const;

  WorkerHostParams params_;
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
  std::optional<ChildProcess> master_;
  std::optional<ChildProcess> worker_;
  std::optional<ChildProcess> relay_;
};

/// Waits until the main master answers. False if a stop signal comes first.
bool WaitForMainMaster(StopSignals* signals);

}  // namespace hires_ros
