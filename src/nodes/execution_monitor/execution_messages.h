#pragma once

#include <hires/AchieveResult.h>
#include <hires/ExecuteActionGoal.h>
#include <hires/ExecuteActionResult.h>
#include <hires/GenerateImagineState.h>
#include <hires/ImaginationStatus.h>
#include <hires/ImagineGoal.h>
#include <hires/ImagineResult.h>
#include <hires/PlanGoal.h>
#include <hires/PlanResult.h>
#include <hires/StepStatus.h>

#include <string>
#include <vector>

#include "hires/execution/monitor_config.h"
#include "hires/planning/planner_config.h"
#include "hires/ros/execution/step_messages.h"
#include "hires/ros/values/atom_messages.h"

/// What the execution monitor sends and receives, as messages.
namespace hires_ros {

/// @param time_limit  [s] for the planner.
hires::PlanGoal GoalOf(const hires::execution::StartPlanning& command, double time_limit);
/// The plan that a planner found, with its reasons: the steps alone are taken from the message;
/// what they rest on is worked out from the domain, so that there is one truth.
/// @throws hires::base::ConfigError where the steps cannot be taken from the goal's state.
hires::planning::Plan PlanOf(const hires::Plan& message, const hires::PlanGoal& goal,
                             const hires::planning::PlanningKnowledge& knowledge);
/// The answer without its plan.
hires::execution::PlanArrived AnswerOf(int request, const hires::PlanResult& result);

hires::ExecuteActionGoal GoalOf(const hires::execution::StartStep& command);
hires::execution::StepFinished AnswerOf(int activity, const hires::ExecuteActionResult& result);

/// Without a deadline: that moves, so the caller keeps it.
hires::ImagineGoal GoalOf(const hires::execution::StartImagination& command,
                          const hires::GenerateImagineState::Response& state,
                          const hires::execution::ImaginingParams& params);
/// @param state    That was imagined in: its objects are what the prediction rests on.
/// @param is_late  We cancelled it because its time was over: what was found until then counts.
hires::execution::ImagineAnswered AnswerOf(int request, const hires::ImagineResult& result,
                                           const hires::GenerateImagineState::Response& state,
                                           bool is_late);
std::string OutcomeName(hires::execution::ImagineAnswered::Outcome outcome);  ///< "ranked", ...

/// Code of hires::AchieveResult.
std::uint8_t CodeOf(hires::execution::Finish::Outcome outcome);
std::string OutcomeName(hires::execution::Finish::Outcome outcome);  ///< "succeeded", ...

}  // namespace hires_ros
