#pragma once

#include <string>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// config/planner.yaml: what the planner knows, and how far a request may go.
struct PlannerConfig {
  std::string domain;                ///< path, SHOP2 or HDDL
  std::vector<std::string> initial;  ///< paths of problem files; may be none
  int threads{2};                    ///< searches side by side
  int max_waiting{1000};             ///< requests that may wait for a thread
  double time_limit{60.0};           ///< [s] where a request says nothing, and at most
  double memory_limit{1000.0};       ///< [MB] per search where a request says nothing, and at most
  int max_depth{1'000'000};          ///< decompositions and steps on one path
  int max_plans{1000};               ///< where a request for all says nothing, and at most
  double feedback_period{0.2};       ///< [s]
};

/// Relative paths count from the folder of the file.  @throws base::ConfigError naming file and
/// key.
PlannerConfig ReadPlannerConfig(const std::string& path);

/// What a planner knows before it is asked.
struct PlanningKnowledge {
  Domain domain;
  std::vector<Problem>
      problems;  ///< in the order of the files; the first one's facts hold at first
};

/// @throws base::ConfigError naming file, line and column; also where two problems share a name.
PlanningKnowledge LoadPlanningKnowledge(const PlannerConfig& config);

}  // namespace hires::planning
