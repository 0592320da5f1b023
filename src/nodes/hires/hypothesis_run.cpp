#include "nodes/hires/hypothesis_run.h"

#include <fmt/format.h>
#include <hires/GroundTruth.h>
#include <ros/ros.h>
#include <signal.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "hires/cli/hypothesis_play.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/scenario.h"
#include "hires/evaluation/timeline.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/ros/conversions.h"
#include "nodes/hires/remote_achieve.h"

namespace hires_ros {
namespace {

namespace evaluation = hires::evaluation;
using evaluation::HypothesisOrder;
using evaluation::HypothesisRun;
using hires::base::ConfigError;

constexpr double kSettle = 1.0;  // [s] simulated, after the task, in which things may yet fall
constexpr double kSettleLimit = 60.0;  // [s] of the wall's clock for that
constexpr double kStopGrace = 25.0;    // [s] for roslaunch to end its nodes
constexpr double kPoll = 0.05;         // [s]

/// Everything below the master that this run is given.
void EnterSystem(const HypothesisOrder& order, int port) {
  const auto set = [](const char* name, const std::string& value) {
    setenv(name, value.c_str(), 1);
  };
  set("ROS_MASTER_URI", fmt::format("http://127.0.0.1:{}/", port));
  set("ROS_IP", "127.0.0.1");
  unsetenv("ROS_HOSTNAME");
  set("ROS_HOME", order.folder + "/ros");
  set("ROS_LOG_DIR", order.folder + "/ros/log");
}

hires::base::ProcessOptions LaunchOptions(const HypothesisOrder& order,
                                          const evaluation::Scenario& scenario, int port,
                                          const std::string& package_folder) {
  const auto argument = [](const std::string& name, const std::string& value) {
    return name + ":=" + value;
  };
  hires::base::ProcessOptions options;
  options.command = {"roslaunch",
                     "-p",
                     std::to_string(port),
                     package_folder + "/launch/hypothesis_run.launch",
                     argument("scenario", order.scenario),
                     argument("knowledge", hires::base::Join(scenario.knowledge, " ")),
                     argument("imagination", order.imagines ? "true" : "false"),
                     argument("workers", std::to_string(order.workers)),
                     argument("base_port", std::to_string(port)),
                     argument("pace", fmt::format("{}", order.pace)),
                     argument("seed", std::to_string(order.seed)),
                     argument("store", order.folder + "/blackboard.db")};
  options.output = order.folder + "/system.log";
  return options;
}

/// The last truth that came, from whichever thread spins.
class Witness {
 public:
  explicit Witness(ros::NodeHandle* nh)
      : subscriber_(nh->subscribe("ground_truth/summary", 10, &Witness::OnSummary, this)) {}

  bool HasSeen() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return has_seen_;
  }
  evaluation::RunTruth Truth() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return truth_;
  }

 private:
  void OnSummary(const hires::GroundTruthConstPtr& summary) {
    const std::lock_guard<std::mutex> lock(mutex_);
    truth_.contact = summary->contact;
    for (const hires::ObjectTruth& object : summary->objects) {
      truth_.objects[hires::base::ToLower(object.name)] = FromMsg(object);
    }
    has_seen_ = true;
  }

  mutable std::mutex mutex_;
  evaluation::RunTruth truth_;
  bool has_seen_{false};
  ros::Subscriber subscriber_;
};

/// Why a run must end before its task does: what was first.
class Limits {
 public:
  Limits(const HypothesisOrder& order, hires::base::ChildProcess* system,
         hires::base::StopSignals* stop)
      : goal_(order.goal), system_(system), stop_(stop), begin_(hires::base::SteadyNow()) {}

  /// @param wall_limit  [s] from the run's start.
  bool Broken(double wall_limit) {
    if (!outcome_.empty()) return true;
    if (stop_->Wait(0.0)) Break("cancelled", "it was told to end");
    const auto ended = system_->Ended();
    if (ended) Break("system_died", "roslaunch ended with " + *ended);
    if (hires::base::SteadyNow() - begin_ > wall_limit) {
      Break("timed_out", fmt::format("{:g} s of the wall's clock are over", wall_limit));
    }
    const double simulated = ros::isInitialized() && ros::Time::isValid() && ros::Time::isSimTime()
                                 ? ros::Time::now().toSec()
                                 : 0.0;
    if (simulated > goal_.time_limit) {
      Break("timed_out", fmt::format("{:g} s simulated are over", goal_.time_limit));
    }
    return !outcome_.empty();
  }
  bool Broken() { return Broken(goal_.wall_limit); }
  double start_limit() const { return goal_.start_limit; }
  void Pass(double seconds) { stop_->Wait(seconds); }

  const std::string& outcome() const { return outcome_; }  ///< empty while nothing is broken
  const std::string& reason() const { return reason_; }

 private:
  void Break(const std::string& outcome, const std::string& reason) {
    if (!outcome_.empty()) return;
    outcome_ = outcome;
    reason_ = reason;
  }

  const evaluation::HypothesisGoal& goal_;
  hires::base::ChildProcess* system_;
  hires::base::StopSignals* stop_;
  double begin_;
  std::string outcome_, reason_;
};

void AwaitStart(const std::function<bool()>& is_there, const std::string& what, Limits* limits) {
  while (!is_there()) {
    if (limits->Broken(limits->start_limit())) {
      throw ConfigError("waiting for " + what);
    }
    limits->Pass(kPoll);
  }
}

/// The master answers and says whose clock counts; a node that starts before does not know.
void AwaitMaster(Limits* limits) {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hypothesis_run",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  AwaitStart([] { return ros::master::check(); }, "the master", limits);
  AwaitStart([] { return ros::param::has("/use_sim_time"); }, "the parameters", limits);
}

/// What is put down or falls needs a moment to come to rest.
void AwaitRest(Limits* limits) {
  const ros::Time end = ros::Time::now() + ros::Duration(kSettle);
  const double give_up = hires::base::SteadyNow() + kSettleLimit;
  while (ros::Time::now() < end && hires::base::SteadyNow() < give_up && !limits->Broken()) {
    limits->Pass(kPoll);
  }
}

void Watch(const HypothesisOrder& order, const evaluation::Scenario& scenario,
           const std::vector<evaluation::WantedPlace>& places, Limits* limits, HypothesisRun* run) {
  AwaitMaster(limits);
  ros::NodeHandle nh;
  Witness witness(&nh);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  AwaitStart([&] { return witness.HasSeen(); }, "the robot's world", limits);
  const auto report = AchieveRemotely({scenario.task, "", order.goal.start_limit}, {},
                                      [&] { return limits->Broken(); });
  evaluation::WriteJson(ToJson(report), order.folder + "/result.json");
  evaluation::CountReport(report, run);
  AwaitRest(limits);
  evaluation::Judge(order.goal, places, witness.Truth(), run);
  run->is_complete = limits->outcome().empty();
}

/// What roslaunch said last about a process that died; "" for nothing.
std::string LastDeath(const std::string& log) {
  std::ifstream file(log);
  std::string death;
  for (std::string line; std::getline(file, line);) {
    if (line.find("has died") != std::string::npos) death = line;
  }
  return death;
}

/// Never throws for what a run may run into.
HypothesisRun Play(const HypothesisOrder& order, const evaluation::Scenario& scenario,
                   const std::vector<evaluation::WantedPlace>& places, Limits* limits) {
  HypothesisRun run;
  try {
    Watch(order, scenario, places, limits, &run);
  } catch (const std::exception& error) {
    run.outcome = "broke_down";
    run.reason = error.what();
  }
  limits->Broken();  // a system that died may have been noticed elsewhere first
  if (!run.is_complete && !limits->outcome().empty()) {
    run.outcome = limits->outcome();
    run.reason = limits->reason() + (run.reason.empty() ? "" : "; ") + run.reason;
  }
  const std::string death = run.is_complete ? "" : LastDeath(order.folder + "/system.log");
  if (!death.empty()) run.reason += "; " + death;
  run.success = run.success && run.is_complete;
  return run;
}

/// roslaunch ends its nodes in order when it is interrupted.
void StopSystem(hires::base::ChildProcess* system, hires::base::StopSignals* stop) {
  system->Signal(SIGINT);
  const double end = hires::base::SteadyNow() + kStopGrace;
  while (!system->Ended() && hires::base::SteadyNow() < end) {
    stop->Wait(0.0);
    usleep(20000);
  }
}

HypothesisRun PlayInSystem(const HypothesisOrder& order, int port,
                           const std::string& package_folder, hires::base::StopSignals* stop) {
  const auto scenario = evaluation::ReadScenario(
      fmt::format("{}/config/scenarios/{}.yaml", package_folder, order.scenario));
  const auto scene = hires::imagination::ReadSetupConfig(package_folder + "/config/scene.yaml");
  const auto places = evaluation::PlacesOf(order.goal, hires::world::LoadWorld(scene.world),
                                           scene.manipulation.place.area_edge);
  EnterSystem(order, port);
  hires::base::ChildProcess system(LaunchOptions(order, scenario, port, package_folder));
  Limits limits(order, &system, stop);
  const HypothesisRun run = Play(order, scenario, places, &limits);
  if (ros::isStarted()) ros::shutdown();
  StopSystem(&system, stop);
  return run;
}

int PortOf(const std::string& word) {
  char* end = nullptr;
  const long port = std::strtol(word.c_str(), &end, 10);
  if (*end == '\0' && port >= 1024 && port < 65000) return static_cast<int>(port);
  throw ConfigError(fmt::format("port '{}': wanted a number from 1024 to 64999", word));
}

}  // namespace

int RunHypothesisProcess(const std::vector<std::string>& words, const std::string& package_folder) {
  if (words.size() != 3) {
    throw ConfigError(
        fmt::format("{}: wanted ORDER.json RECORD.json FIRST_PORT; `hires experiment "
                    "hypothesis` starts it",
                    hires::cli::kHypothesisRunVerb));
  }
  hires::base::StopSignals stop;
  hires::base::StopWithParent();
  hires::base::AdoptOrphans();
  const HypothesisOrder order =
      hires::cli::ParseHypothesisOrder(hires::base::ReadTextFile(words[0]), words[0]);
  HypothesisRun run;
  try {
    run = PlayInSystem(order, PortOf(words[2]), package_folder, &stop);
  } catch (...) {
    hires::base::KillDescendants();
    throw;
  }
  hires::base::KillDescendants();
  evaluation::WriteJson(ToJson(run), words[1]);
  return EXIT_SUCCESS;
}

}  // namespace hires_ros
