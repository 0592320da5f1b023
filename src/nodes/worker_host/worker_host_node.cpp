#include "nodes/worker_host/worker_host_node.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <fmt/format.h>
#include <ros/file_log.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>
#include <csignal>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/relay/mirror.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;
using hires::base::ParamReader;
using hires::relay::FillIn;
using hires::relay::WorkerHostParams;

constexpr double kCallTimeout = 0.5;        // [s] for one question to a master
constexpr double kDiagnosticsPeriod = 1.0;  // [s]

std::string FolderOf(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash);
}

hires::relay::RelayParams ReadRelayOf(const WorkerHostParams& params) {
  return hires::relay::ReadRelayParams(ParamReader::FromFile(params.relay_config),
                                       {params.master_uri(), params.name_space()});
}

void RequireReachable(const WorkerHostParams& params) {
  const std::string main = ros::master::getURI();
  const auto endpoint = hires::relay::RequireMasterUri(main, "ROS_MASTER_URI");
  const auto here = NamesOfThisHost();
  if (hires::relay::IsLoopback(params.address) &&
      !hires::relay::IsSamePlace(endpoint.host, "localhost", here)) {
    throw ConfigError(fmt::format(
        "address is {}, which the main master {} on another computer cannot reach; set address to "
        "this computer's address in that network",
        params.address, main));
  }
}

bool EndIfAny(std::optional<hires::base::ChildProcess>* child, const char* name,
              std::string* what) {
  if (!*child) return false;
  const auto ended = (*child)->Ended();
  if (!ended) return false;
  *what = fmt::format("{} (pid {}) ended with {}", name, (*child)->pid(), *ended);
  return true;
}

}  // namespace

WorkerHostParams LoadWorkerHostParams() {
  RejectUnknownPrivate({"config", "index", "base_port", "address", "nice", "worker_command",
                        "worker_arguments", "environment"});
  const std::string path = ConfigPath("worker_host");
  WorkerHostParams params =
      hires::relay::ReadWorkerHostParams(ParamReader::FromFile(path), FolderOf(path));
  const std::string here = ros::names::clean(ros::this_node::getNamespace());
  if (here != "/") params.parent = here;
  Override("index", PrivateInt("index"), hires::base::Between(1, 256), &params.index);
  Override("base_port", PrivateInt("base_port"), hires::base::Between(1024, 65000),
           &params.base_port);
  Override("address", PrivateText("address"), hires::relay::WorkerAddress(), &params.address);
  Override("nice", PrivateInt("nice"), hires::base::Between(0, 19), &params.nice);
  const auto command = PrivateWords("worker_command");
  if (command && !command->empty()) params.worker_command = *command;
  const auto arguments = PrivateWords("worker_arguments");
  if (arguments && !arguments->empty()) params.worker_arguments = *arguments;
  const auto environment = PrivateWords("environment");
  if (environment && !environment->empty()) params.environment = *environment;
  if (!hires::relay::WorkerVariables().holds(params.environment)) {
    throw ConfigError("~environment: wanted " + hires::relay::WorkerVariables().wanted);
  }
  return params;
}

WorkerHostNode::WorkerHostNode(const WorkerHostParams& params, ros::NodeHandle* nh)
    : params_(params),
      relay_params_(ReadRelayOf(params)),
      main_(ros::master::getURI(), ros::this_node::getName(), kCallTimeout),
      diagnostics_(nh->advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10)),
      policy_(params.restart) {
  RequireReachable(params);
}

WorkerHostNode::~WorkerHostNode() { StopAll(); }

int WorkerHostNode::Run(hires::base::StopSignals* signals, const MasterWatch& master_watch) {
  RequireFreePort();
  // roscpp asks the master for a parameter before its first log line; that must not happen at the
  // moment at which the master hangs.
  Log(LogLevel::kInfo,
      fmt::format("worker={} state=starting master={}", params_.index, params_.master_uri()));
  while (ros::ok() && phase_ != Phase::kGaveUp) {
    const double now = hires::base::SteadyNow();
    Tick(now);
    if (now >= next_diagnostics_) PublishDiagnostics();
    if (signals->Wait(WaitTime(now))) break;
    if (master_watch.silent_for() > params_.main_master_timeout) {
      Log(LogLevel::kError, fmt::format("worker={} main master silent for {:.1f} s: worker ends",
                                        params_.index, master_watch.silent_for()));
      StopAll();
      return kExitMasterGone;
    }
  }
  StopAll();
  return phase_ == Phase::kGaveUp ? EXIT_FAILURE : EXIT_SUCCESS;
}

double WorkerHostNode::WaitTime(double now) const {
  switch (phase_) {
    case Phase::kWaiting:
      return std::clamp(start_at_ - now, 0.0, 0.2);
    case Phase::kMasterStarting:
      return 0.005;
    case Phase::kNodesStarting:
      return 0.02;
    case Phase::kReady:
    case Phase::kGaveUp:
      break;
  }
  return 0.2;
}

void WorkerHostNode::Tick(double now) {
  WatchChildren(now);
  switch (phase_) {
    case Phase::kWaiting:
      if (now >= start_at_) StartMaster(now);
      break;
    case Phase::kMasterStarting:
      AwaitMaster(now);
      break;
    case Phase::kNodesStarting:
      AwaitCrossing(now);
      break;
    case Phase::kReady:
    case Phase::kGaveUp:
      break;
  }
}

void WorkerHostNode::RequireFreePort() const {
  if (hires::base::IsPortFree(params_.address, params_.port())) return;
  const auto pid =
      AskPid({params_.address, params_.port()}, ros::this_node::getName(), kCallTimeout);
  throw ConfigError(fmt::format(
      "port {} at {} for the master of worker {} is taken by {}; end it, or choose another "
      "base_port (now {}) or index",
      params_.port(), params_.address, params_.index,
      pid ? fmt::format("a ROS master or node with process id {}", *pid) : "another program",
      params_.base_port));
}

void WorkerHostNode::StartMaster(double now) {
  if (!hires::base::IsPortFree(params_.address, params_.port())) {
    OnFailure(fmt::format("port {} is taken by another program", params_.port()), now);
    return;
  }
  phase_ = Phase::kMasterStarting;
  phase_since_ = started_at_ = now;
  policy_.OnStarted(now);
  master_.emplace(hires::base::ProcessOptions{Filled(params_.master_command), WorkerEnvironment(),
                                              params_.nice, ""});
}

void WorkerHostNode::AwaitMaster(double now) {
  const auto pid =
      AskPid({params_.address, params_.port()}, ros::this_node::getName(), kCallTimeout);
  if (pid == master_->pid()) {
    StartNodes(now);
  } else if (pid) {
    OnFailure(fmt::format("port {} is served by process {} and not by the worker's own master",
                          params_.port(), *pid),
              now);
  } else if (now - phase_since_ > params_.start_timeout) {
    OnFailure(fmt::format("the worker's master did not answer within {} s", params_.start_timeout),
              now);
  }
}

void WorkerHostNode::StartNodes(double now) {
  phase_ = Phase::kNodesStarting;
  phase_since_ = now;
  std::vector<std::string> command = params_.worker_command;
  command.insert(command.end(), params_.worker_arguments.begin(), params_.worker_arguments.end());
  worker_.emplace(
      hires::base::ProcessOptions{Filled(command), WorkerEnvironment(), params_.nice, ""});
  relay_.emplace(hires::base::ProcessOptions{
      Filled(params_.relay_command),
      {"ROS_MASTER_URI=" + ros::master::getURI(), "ROS_NAMESPACE=" + params_.parent},
      params_.nice,
      ""});
}

bool WorkerHostNode::HasCrossed() {
  const auto graph = main_.GetGraph();
  if (!graph) return false;
  const hires::relay::AliasNames names(relay_params_.alias_prefix,
                                       hires::relay::TagOf(params_.name_space()));
  for (const auto& registration : hires::relay::OwnRegistrations(*graph, names)) {
    // Not what an earlier start left behind: no node answers there, and the relay withdraws it.
    const auto uri = main_.LookupNode(registration.alias);
    const auto endpoint = uri ? hires::relay::ParseUri(*uri) : std::nullopt;
    if (endpoint && AskPid(*endpoint, ros::this_node::getName(), kCallTimeout)) return true;
  }
  return false;
}

void WorkerHostNode::AwaitCrossing(double now) {
  if (HasCrossed()) {
    phase_ = Phase::kReady;
    phase_since_ = now;
    time_to_ready_ = hires::base::SteadyNow() - started_at_;
    next_diagnostics_ = 0.0;
    Log(LogLevel::kInfo, fmt::format("worker={} state=ready time_to_ready={:.3f} master={}",
                                     params_.index, time_to_ready_, params_.master_uri()));
  } else if (now - phase_since_ > params_.ready_timeout) {
    OnFailure(fmt::format("nothing of the worker crossed to the main master within {} s",
                          params_.ready_timeout),
              now);
  }
}

void WorkerHostNode::WatchChildren(double now) {
  std::string what;
  if (EndIfAny(&master_, "rosmaster", &what) || EndIfAny(&worker_, "the worker's node", &what) ||
      EndIfAny(&relay_, "the relay", &what)) {
    OnFailure(what, now);
  }
}

void WorkerHostNode::OnFailure(const std::string& what, double now) {
  last_failure_ = what;
  next_diagnostics_ = 0.0;
  StopAll();
  const auto start_at = policy_.OnDied(now);
  phase_since_ = now;
  if (!start_at) {
    phase_ = Phase::kGaveUp;
    Log(LogLevel::kError, fmt::format("worker={} state=given_up restarts={}: {}", params_.index,
                                      policy_.num_restarts(), what));
    return;
  }
  phase_ = Phase::kWaiting;
  start_at_ = *start_at;
  Log(LogLevel::kWarn, fmt::format("worker={} state=restarting restarts={} in={:.2f}: {}",
                                   params_.index, policy_.num_restarts(), start_at_ - now, what));
}

void WorkerHostNode::StopAll() {
  // The relay first, while both masters are there for it to withdraw its mirrors.
  if (relay_) relay_->Terminate(params_.stop_grace);
  relay_.reset();
  if (worker_) worker_->Signal(SIGTERM);
  if (master_) master_->Terminate(params_.stop_grace);
  if (worker_) worker_->Terminate(params_.stop_grace);
  worker_.reset();
  master_.reset();
}

std::vector<std::string> WorkerHostNode::Filled(const std::vector<std::string>& words) const {
  std::vector<std::string> filled;
  for (const std::string& word : words) filled.push_back(FillIn(word, params_));
  return filled;
}

std::vector<std::string> WorkerHostNode::WorkerEnvironment() const {
  std::vector<std::string> environment{
      "ROS_MASTER_URI=" + params_.master_uri(), "ROS_NAMESPACE=" + params_.parent,
      "ROS_IP=" + params_.address, "ROS_HOSTNAME",
      "ROS_LOG_DIR=" + ros::file_log::getLogDirectory() + params_.name_space()};
  const auto more = Filled(params_.environment);
  environment.insert(environment.end(), more.begin(), more.end());
  return environment;
}

const char* WorkerHostNode::NameOf(Phase phase) {
  switch (phase) {
    case Phase::kWaiting:
      return "waiting";
    case Phase::kMasterStarting:
      return "master starting";
    case Phase::kNodesStarting:
      return "nodes starting";
    case Phase::kReady:
      return "ready";
    case Phase::kGaveUp:
      return "given up";
  }
  return "";
}

std::string WorkerHostNode::PidText(const std::optional<hires::base::ChildProcess>& child) const {
  return child ? std::to_string(child->pid()) : "none";
}

void WorkerHostNode::PublishDiagnostics() {
  next_diagnostics_ = hires::base::SteadyNow() + kDiagnosticsPeriod;
  diagnostic_updater::DiagnosticStatusWrapper status;
  status.name = ros::this_node::getName().substr(1) + ": processes";
  status.hardware_id = params_.name_space().substr(1);
  status.summary(phase_ == Phase::kReady    ? status.OK
                 : phase_ == Phase::kGaveUp ? status.ERROR
                                            : status.WARN,
                 NameOf(phase_));
  status.add("master pid", PidText(master_));
  status.add("worker pid", PidText(worker_));
  status.add("relay pid", PidText(relay_));
  status.add("master", params_.master_uri());
  status.add("restarts", policy_.num_restarts());
  status.add("time to ready [s]", time_to_ready_);
  status.add("last failure", last_failure_);
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(status);
  diagnostics_.publish(array);
}

bool WaitForMainMaster(hires::base::StopSignals* signals) {
  const auto main = hires::relay::RequireMasterUri(ros::master::getURI(), "ROS_MASTER_URI");
  bool has_told = false;
  while (!AskPid(main, ros::this_node::getName(), kCallTimeout)) {
    if (!has_told) {
      Log(LogLevel::kWarn,
          fmt::format("waiting for the main master {}; if it runs: can this computer look up '{}'? "
                      "(otherwise a line 'ADDRESS {}' in /etc/hosts helps), and does its firewall "
                      "let this computer in?",
                      ros::master::getURI(), main.host, main.host));
      has_told = true;
    }
    if (signals->Wait(0.05)) return false;
  }
  return true;
}

}  // namespace hires_ros
