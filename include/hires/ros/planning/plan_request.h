#pragma once

#include <hires/Plan.h>
#include <hires/PlanGoal.h>
#include <hires/PlanResult.h>

#include <string>

#include "hires/planning/plan.h"
#include "hires/planning/planner.h"
#include "hires/planning/planner_config.h"

/// What a goal of the action `plan` means, and its answer.
namespace hires_ros {

/// One request, checked and ready for the search.
struct PlanRequest {
  hires::planning::Problem problem;
  hires::planning::PlanRequest search;  ///< `stop` is not set
};

/// @throws hires::base::ConfigError naming what cannot be understood or planned for: texts that are
/// no terms, atoms with variables, unknown problems and tasks, limits beyond the planner's own.
PlanRequest RequestOf(const hires::PlanGoal& goal,
                      const hires::planning::PlanningKnowledge& knowledge,
                      const hires::planning::PlannerConfig& config);

/// [s] from acceptance.  @throws hires::base::ConfigError if the goal asks for more than the
/// planner allows.
double TimeLimitOf(const hires::PlanGoal& goal, const hires::planning::PlannerConfig& config);

/// Reads the goal, searches, adds the reasons, all on the calling thread. Whatever the goal holds
/// becomes a result: it never throws. A cancelled result comes without plans.
/// @param stop  Asked all the time; besides, the goal's memory limit is kept.
hires::PlanResult AnswerTo(const hires::PlanGoal& goal,
                           const hires::planning::PlanningKnowledge& knowledge,
                           const hires::planning::PlannerConfig& config,
                           const hires::planning::StopQuestion& stop);

/// A result without plans; `why` is cut where it is endless.
hires::PlanResult ResultWithout(int outcome, const std::string& why);

/// @pre AddReasons has seen the plan.
hires::Plan ToMsg(const hires::planning::Plan& plan);

}  // namespace hires_ros
