#include "hires/planning/planner_config.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/planning/planning_files.h"

namespace hires::planning {
namespace {

/// As the path is written, or from the folder of the file that names it.
std::string PathFrom(const std::string& config_path, const std::string& path) {
  return (std::filesystem::path(config_path).parent_path() / path).lexically_normal().string();
}

void AddProblems(const std::string& path, PlanningKnowledge* knowledge) {
  for (Problem& problem : LoadProblems(path, knowledge->domain)) {
    if (!problem.fault.empty()) throw base::ConfigError(problem.fault);
    for (const Problem& other : knowledge->problems) {
      if (other.name != problem.name) continue;
      throw base::ConfigError(
          fmt::format("{}: problem '{}' comes a second time, first in {}; rename one of them", path,
                      problem.name, other.source));
    }
    knowledge->problems.push_back(std::move(problem));
  }
}

}  // namespace

PlannerConfig ReadPlannerConfig(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  PlannerConfig config;
  config.domain = PathFrom(path, in.GetString("domain"));
  for (const std::string& file : in.GetStrings("initial")) {
    config.initial.push_back(PathFrom(path, file));
  }
  config.threads = in.Get("threads", base::Between(1, 256));
  config.max_waiting = in.Get("max_waiting", base::Between(0, 100'000));
  config.time_limit = in.Get("time_limit", base::Between(0.001, 1e6));
  config.memory_limit = in.Get("memory_limit", base::Between(1.0, 1e6));
  config.max_depth = in.Get("max_depth", base::Between(1, 100'000'000));
  config.max_plans = in.Get("max_plans", base::Between(1, 1'000'000));
  config.feedback_period = in.Get("feedback_period", base::Between(0.01, 10.0));
  in.RejectUnknownKeys();
  return config;
}

PlanningKnowledge LoadPlanningKnowledge(const PlannerConfig& config) {
  PlanningKnowledge knowledge;
  knowledge.domain = LoadDomain(config.domain);
  for (const std::string& path : config.initial) AddProblems(path, &knowledge);
  return knowledge;
}

}  // namespace hires::planning
