#include "lab/src/graph/graph_run.h"

#include <fmt/format.h>
#include <signal.h>

#include <cstdlib>
#include <fstream>

#include "hires/base/error.h"
#include "hires/base/failure.h"
#include "hires/base/text.h"
#include "hires/ros/imagination/truth_messages.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;

constexpr double kSettle = 1.0;  // [s] simulated, after the task, in which things may yet fall
constexpr double kSettleLimit = 60.0;   // [s] of the wall's clock for that
constexpr double kStopGrace = 25.0;     // [s] for roslaunch to end its nodes
constexpr double kPoll = 0.05;          // [s]
constexpr double kStoppedLimit = 10.0;  // [s] that a process of the graph may be stopped

void AwaitStart(const std::function<bool()>& is_there, const std::string& what, RunLimits* limits) {
  while (!is_there()) {
    if (limits->Broken(limits->start_limit())) throw ConfigError("waiting for " + what);
    limits->Pass(kPoll);
  }
}

}  // namespace

void EnterGraph(const std::string& folder, int port) {
  const auto set = [](const char* name, const std::string& value) {
    setenv(name, value.c_str(), 1);
  };
  set("ROS_MASTER_URI", fmt::format("http://127.0.0.1:{}/", port));
  set("ROS_IP", "127.0.0.1");
  unsetenv("ROS_HOSTNAME");
  set("ROS_HOME", folder + "/ros");
  set("ROS_LOG_DIR", folder + "/ros/log");
}

hires::base::ProcessOptions GraphLaunch(const std::string& package_folder,
                                        const std::string& folder, int port,
                                        const std::vector<std::string>& arguments) {
  hires::base::ProcessOptions options;
  options.command = {"roslaunch", "-p", std::to_string(port),
                     package_folder + "/lab/launch/hypothesis_run.launch",
                     fmt::format("base_port:={}", port)};
  options.command.insert(options.command.end(), arguments.begin(), arguments.end());
  options.output = folder + "/system.log";
  return options;
}

RunLimits::RunLimits(const GraphLimits& limits, hires::base::ChildProcess* graph,
                     hires::base::StopSignals* stop)
    : limits_(limits), graph_(graph), stop_(stop), begin_(hires::base::SteadyNow()) {}

void RunLimits::WatchProcesses() { processes_.emplace(kStoppedLimit); }

bool RunLimits::Broken(double wall_limit) {
  if (!outcome_.empty()) return true;
  if (stop_->Wait(0.0)) Break("cancelled", "it was told to end");
  const auto ended = graph_->Ended();
  if (ended) Break("system_died", "roslaunch ended with " + *ended);
  const double now = hires::base::SteadyNow();
  if (processes_) {
    if (const auto broken = processes_->Broken(now)) Break("process_broke", *broken);
  }
  if (now - begin_ > wall_limit) {
    Break(hires::base::ToString(hires::base::FailureCode::kTimedOut),
          fmt::format("{:g} s of the wall's clock are over", wall_limit));
  }
  const double simulated = ros::isInitialized() && ros::Time::isValid() && ros::Time::isSimTime()
                               ? ros::Time::now().toSec()
                               : 0.0;
  if (simulated > limits_.simulated) {
    is_time_over_ = is_time_over_ || outcome_.empty();
    Break(hires::base::ToString(hires::base::FailureCode::kTimedOut),
          fmt::format("{:g} s simulated are over", limits_.simulated));
  }
  return !outcome_.empty();
}

void RunLimits::Break(const std::string& outcome, const std::string& reason) {
  if (!outcome_.empty()) return;
  outcome_ = outcome;
  reason_ = reason;
}

bool Witness::HasSeen() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return has_seen_;
}

hires::simulation::RunTruth Witness::Truth() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return truth_;
}

void Witness::OnSummary(const hires::GroundTruthConstPtr& summary) {
  const std::lock_guard<std::mutex> lock(mutex_);
  truth_.contact = summary->contact;
  for (const hires::ObjectTruth& object : summary->objects) {
    truth_.objects[hires::base::ToLower(object.name)] = FromMsg(object);
  }
  has_seen_ = true;
}

void AwaitMaster(RunLimits* limits) {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "graph_run",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  AwaitStart([] { return ros::master::check(); }, "the master", limits);
  AwaitStart([] { return ros::param::has("/use_sim_time"); }, "the parameters", limits);
}

void AwaitTruth(const Witness& witness, RunLimits* limits) {
  AwaitStart([&] { return witness.HasSeen(); }, "the robot's world", limits);
}

void AwaitRest(RunLimits* limits) {
  const ros::Time end = ros::Time::now() + ros::Duration(kSettle);
  const double give_up = hires::base::SteadyNow() + kSettleLimit;
  while (ros::Time::now() < end && hires::base::SteadyNow() < give_up && !limits->Broken()) {
    limits->Pass(kPoll);
  }
}

void StopGraph(hires::base::ChildProcess* graph, hires::base::StopSignals* stop) {
  graph->Signal(SIGINT);
  const double end = hires::base::SteadyNow() + kStopGrace;
  while (!graph->Ended() && hires::base::SteadyNow() < end) {
    stop->Wait(0.0);
    usleep(20000);
  }
}

std::string LastDeath(const std::string& folder) {
  std::ifstream file(folder + "/system.log");
  std::string death;
  for (std::string line; std::getline(file, line);) {
    if (line.find("has died") != std::string::npos) death = line;
  }
  return death;
}

int PortOf(const std::string& word) {
  char* end = nullptr;
  const long port = std::strtol(word.c_str(), &end, 10);
  if (*end == '\0' && port >= 1024 && port < 65000) return static_cast<int>(port);
  throw ConfigError(fmt::format("port '{}': wanted a number from 1024 to 64999", word));
}

}  // namespace hires_ros
