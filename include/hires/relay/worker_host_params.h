#pragma once

#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/relay/restart_policy.h"

namespace hires::relay {

struct WorkerHostParams {
  int index{1};                      ///< k: the worker is worker_k on port base_port + k
  std::string parent;                ///< its namespace: empty, or "/robot1"
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
  RestartLimits restart;

  int port() const { return base_port + index; }
  std::string name_space() const { return parent + "/worker_" + std::to_string(index); }
  std::string master_uri() const {
    return "http://" + address + ":" + std::to_string(port()) + "/";
  }
};

/// Reads config/worker_host.yaml; all keys are required. A relative `relay_config` is taken from
/// `folder`.  @throws base::ConfigError for a missing, unknown or unfit key.
WorkerHostParams ReadWorkerHostParams(base::ParamReader in, const std::string& folder);

/// `text` with the placeholders of WorkerHostParams filled in.
/// @throws base::ConfigError for an unknown placeholder.
std::string FillIn(const std::string& text, const WorkerHostParams& params);

/// What `address` and `environment` may be, in a file or as a parameter.
base::Bound<std::string> WorkerAddress();
base::Bound<std::vector<std::string>> WorkerVariables();

}  // namespace hires::relay
