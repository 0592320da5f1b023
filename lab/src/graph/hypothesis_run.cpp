#include "lab/src/graph/hypothesis_run.h"

#include <fmt/format.h>
#include <ros/ros.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "lab/src/dissertation.h"
#include "lab/src/experiment/hypothesis_play.h"
#include "reports/text/report_json.h"
#include "sim_robot/scenario.h"
#include "reports/task/timeline.h"
#include "hires/imagination/imagination_setup.h"
#include "lab/src/graph/graph_run.h"
#include "nodes/hires/remote_achieve.h"

namespace hires_ros {
namespace {

namespace reports = hires::reports;
namespace sim_robot = hires::sim_robot;
namespace lab = hires::lab;
using lab::HypothesisOrder;
using lab::HypothesisRun;
using hires::base::ConfigError;

GraphLimits LimitsOf(const lab::HypothesisGoal& goal) {
  return {goal.start_limit, goal.wall_limit, goal.time_limit};
}

std::vector<std::string> LaunchArguments(const HypothesisOrder& order,
                                         const sim_robot::Scenario& scenario) {
  return {"scenario:=" + order.scenario,
          "knowledge:=" + hires::base::Join(scenario.knowledge, " "),
          fmt::format("imagination:={}", order.imagines),
          fmt::format("default:={}", lab::kDissertationDefaults),
          fmt::format("workers:={}", order.workers),
          fmt::format("pace:={}", order.pace),
          fmt::format("seed:={}", order.seed),
          "store:=" + order.folder + "/blackboard.db"};
}

void Watch(const HypothesisOrder& order, const sim_robot::Scenario& scenario,
           const std::vector<lab::WantedPlace>& places, RunLimits* limits,
           HypothesisRun* run) {
  AwaitMaster(limits);
  ros::NodeHandle nh;
  Witness witness(&nh);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  AwaitTruth(witness, limits);
  const auto report = AchieveRemotely({scenario.task, "", order.goal.start_limit}, {},
                                      [&] { return limits->Broken(); });
  reports::WriteJson(reports::ToJson(report), order.folder + "/result.json");
  lab::CountReport(report, run);
  AwaitRest(limits);
  lab::Judge(order.goal, places, witness.Truth(), run);
  run->is_complete = limits->outcome().empty();
}

/// Never throws for what a run may run into.
HypothesisRun Play(const HypothesisOrder& order, const sim_robot::Scenario& scenario,
                   const std::vector<lab::WantedPlace>& places, RunLimits* limits) {
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
  const std::string death = run.is_complete ? "" : LastDeath(order.folder);
  if (!death.empty()) run.reason += "; " + death;
  run.success = run.success && run.is_complete;
  return run;
}

HypothesisRun PlayInSystem(const HypothesisOrder& order, int port,
                           const std::string& package_folder, hires::base::StopSignals* stop) {
  const auto scenario = sim_robot::ReadScenario(
      fmt::format("{}/config/scenarios/{}.yaml", package_folder, order.scenario));
  const auto scene = hires::imagination::ReadSetupConfig(package_folder + "/config/scene.yaml");
  const auto places = lab::PlacesOf(order.goal, hires::world::LoadWorld(scene.world),
                                           scene.manipulation.place.area_edge);
  EnterGraph(order.folder, port);
  hires::base::ChildProcess system(
      GraphLaunch(package_folder, order.folder, port, LaunchArguments(order, scenario)));
  RunLimits limits(LimitsOf(order.goal), &system, stop);
  const HypothesisRun run = Play(order, scenario, places, &limits);
  if (ros::isStarted()) ros::shutdown();
  StopGraph(&system, stop);
  return run;
}

}  // namespace

int RunHypothesisProcess(const std::vector<std::string>& words, const std::string& package_folder) {
  if (words.size() != 3) {
    throw ConfigError(
        fmt::format("{}: wanted ORDER.json RECORD.json FIRST_PORT; `hires_lab experiment "
                    "hypothesis` starts it",
                    hires::lab::kHypothesisRunVerb));
  }
  hires::base::StopSignals stop;
  hires::base::StopWithParent();
  hires::base::AdoptOrphans();
  const HypothesisOrder order =
      hires::lab::ParseHypothesisOrder(hires::base::ReadTextFile(words[0]), words[0]);
  HypothesisRun run;
  try {
    run = PlayInSystem(order, PortOf(words[2]), package_folder, &stop);
  } catch (...) {
    hires::base::KillDescendants();
    throw;
  }
  hires::base::KillDescendants();
  reports::WriteJson(ToJson(run), words[1]);
  return EXIT_SUCCESS;
}

}  // namespace hires_ros
