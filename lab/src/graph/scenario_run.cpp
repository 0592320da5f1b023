#include "lab/src/graph/scenario_run.h"

#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "lab/src/series/scenario_play.h"
#include "reports/text/report_json.h"
#include "reports/task/timeline.h"
#include "lab/src/graph/graph_run.h"
#include "nodes/hires/remote_achieve.h"

namespace hires_ros {
namespace {

namespace loop = hires::loop;
namespace reports = hires::reports;
using hires::base::ConfigError;
using nlohmann::ordered_json;

std::vector<std::string> ArgumentsOf(const hires::lab::GraphOrder& order) {
  return {"scenario:=" + order.run.files.scenario,
          "world:=" + order.run.files.world,
          "knowledge:=" + hires::base::Join(order.run.files.knowledge, " "),
          "truth:=" + order.run.truth,
          fmt::format("workers:={}", order.workers),
          fmt::format("pace:={}", order.pace),
          fmt::format("seed:={}", order.run.seed),
          "store:=" + StoreOf(order.run)};
}

ordered_json TruthJson(const hires::simulation::RunTruth& truth, double seconds) {
  ordered_json objects = ordered_json::object();
  for (const auto& [name, fate] : truth.objects) objects[name] = {{"falls", fate.falls}};
  return {{"virtual_seconds", seconds}, {"touched", truth.contact}, {"objects", objects}};
}

/// Says each change of a step in a line: whoever waits sees that it goes on.
class Progress {
 public:
  /// @return whether it is the first.
  bool Tell(const loop::AchieveStatus& status) {
    std::string text;
    for (const auto& step : status.steps) {
      text += fmt::format(" {}:{}", step.action.name, loop::ToString(step.phase));
    }
    for (const auto& each : status.imaginations) {
      text += fmt::format(" {}~{}", each.action.name, loop::ToString(each.outcome));
    }
    const bool is_first = last_.empty();
    if (text != last_) std::cout << fmt::format("{:.1f} s:{}", status.now, text) << std::endl;
    last_ = text;
    return is_first && !text.empty();
  }

 private:
  std::string last_;
};

ordered_json Play(const hires::lab::GraphOrder& order, RunLimits* limits) {
  AwaitMaster(limits);
  ros::NodeHandle nh;
  Witness witness(&nh);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  AwaitTruth(witness, limits);
  Progress progress;
  const auto on_status = [&](const loop::AchieveStatus& status) {
    if (progress.Tell(status)) limits->WatchProcesses();
  };
  const auto report = AchieveRemotely({order.run.task, "", limits->start_limit()}, on_status,
                                      [&] { return limits->Broken(); });
  AwaitRest(limits);
  ordered_json json = reports::ToJson(report);
  json["in_truth"] = TruthJson(witness.Truth(), ros::Time::now().toSec());
  if (limits->is_time_over()) {  // what ended the task was this process
    json["outcome"] = loop::ToString(loop::AchieveOutcome::kFailed);
    json["reason"] = limits->reason();
  }
  return json;
}

/// @throws base::ConfigError where the graph broke down, with how.
ordered_json PlayInGraph(const hires::lab::GraphOrder& order, int port,
                         const std::string& package_folder) {
  hires::base::StopSignals stop;
  EnterGraph(order.run.folder, port);
  hires::base::ChildProcess graph(
      GraphLaunch(package_folder, order.run.folder, port, ArgumentsOf(order)));
  GraphLimits seconds;
  seconds.simulated = order.time_limit;
  RunLimits limits(seconds, &graph, &stop);
  ordered_json result;
  std::string broken;
  try {
    result = Play(order, &limits);
  } catch (const std::exception& error) {
    broken = error.what();
  }
  limits.Broken();  // a graph that died may have been noticed elsewhere first
  if (ros::isStarted()) ros::shutdown();
  StopGraph(&graph, &stop);
  if (!limits.outcome().empty() && !limits.is_time_over()) {
    broken = limits.outcome() + ": " + limits.reason();
  }
  if (broken.empty()) return result;
  const std::string death = LastDeath(order.run.folder);
  throw ConfigError(broken + (death.empty() ? "" : "; " + death));
}

}  // namespace

int RunScenarioProcess(const std::vector<std::string>& words, const std::string& package_folder) {
  if (words.size() != 3) {
    throw ConfigError(fmt::format(
        "{}: wanted ORDER.json RESULT.json FIRST_PORT; `hires_lab scenarios --graph` starts it",
        hires::lab::kScenarioRunVerb));
  }
  hires::base::StopWithParent();
  hires::base::AdoptOrphans();
  const auto order = hires::lab::ParseGraphOrder(hires::base::ReadTextFile(words[0]), words[0]);
  ordered_json result;
  try {
    result = PlayInGraph(order, PortOf(words[2]), package_folder);
  } catch (...) {
    hires::base::KillDescendants();
    throw;
  }
  hires::base::KillDescendants();
  reports::WriteJson(result, words[1]);
  return EXIT_SUCCESS;
}

}  // namespace hires_ros
