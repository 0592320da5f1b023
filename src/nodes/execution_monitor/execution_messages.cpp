#include "nodes/execution_monitor/execution_messages.h"

#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/imagination/imagine_answer.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;
using ImagineOutcome = execution::ImagineAnswered::Outcome;

std::vector<std::string> NamesIn(const hires::GenerateImagineState::Response& state,
                                 const std::vector<hires::Atom>& depends_on) {
  std::vector<std::string> names;
  for (const hires::ObjectState& object : state.world_state.objects) names.push_back(object.name);
  for (const hires::Atom& atom : depends_on) {
    names.insert(names.end(), atom.arguments.begin(), atom.arguments.end());
  }
  return names;
}

/// An answer that is no answer, of a client of another version.
bool IsUnknown(const hires::ImagineResult& result) {
  switch (result.outcome) {
    case hires::ImagineResult::RANKED:
    case hires::ImagineResult::RANKED_AT_DEADLINE:
    case hires::ImagineResult::CLOSE:
    case hires::ImagineResult::ALL_FAILED:
    case hires::ImagineResult::UNDECIDED:
    case hires::ImagineResult::NO_WORKER:
    case hires::ImagineResult::NOTHING_FINISHED:
    case hires::ImagineResult::CANCELLED:
      return false;
  }
  return true;
}

}  // namespace

hires::PlanGoal GoalOf(const execution::StartPlanning& command, double time_limit) {
  hires::PlanGoal goal;
  goal.task = command.tasks;
  goal.state = ToMsg(command.state);
  goal.more_facts = ToMsg(command.facts);
  goal.which = hires::PlanGoal::FIRST;
  goal.time_limit = ros::Duration(time_limit);
  goal.request_id = "execution_monitor";
  return goal;
}

execution::PlanArrived AnswerOf(int request, const hires::PlanResult& result) {
  using Outcome = execution::PlanArrived::Outcome;
  execution::PlanArrived answer;
  answer.request = request;
  answer.why = result.why;
  switch (result.outcome) {
    case hires::PlanResult::FOUND:
      answer.outcome = result.plans.empty() ? Outcome::kInvalid : Outcome::kFound;
      break;
    case hires::PlanResult::NO_PLAN:
      answer.outcome = Outcome::kNoPlan;
      break;
    case hires::PlanResult::INVALID:
      answer.outcome = Outcome::kInvalid;
      break;
    case hires::PlanResult::BUSY:
    case hires::PlanResult::CANCELLED:
      answer.outcome = Outcome::kUnavailable;
      break;
    default:
      answer.outcome = Outcome::kLimit;
  }
  return answer;
}

hires::ExecuteActionGoal GoalOf(const execution::StartStep& command) {
  hires::ExecuteActionGoal goal;
  goal.action = ToMsg(command.action);
  goal.time_limit = ros::Duration(std::isfinite(command.time_limit) ? command.time_limit : 0.0);
  return goal;
}

execution::StepFinished AnswerOf(int activity, const hires::ExecuteActionResult& result) {
  using Result = execution::StepFinished::Result;
  switch (result.code) {
    case hires::ExecuteActionResult::SUCCEEDED:
      return {activity, Result::kSucceeded, {}};
    case hires::ExecuteActionResult::PREEMPTED:
      return {activity, Result::kPreempted, FromMsg(result.failure)};
  }
  return {activity, Result::kFailed, FromMsg(result.failure)};
}

hires::ImagineGoal GoalOf(const execution::StartImagination& command,
                          const hires::GenerateImagineState::Response& state,
                          const execution::ImaginingParams& params) {
  hires::ImagineGoal goal;
  goal.steps.push_back(ToMsg(command.action));
  goal.world_state = state.world_state;
  goal.robot_state = state.robot_state;
  goal.rollouts = static_cast<std::uint32_t>(params.rollouts);
  goal.seed = command.SeedFrom(params.seed);
  goal.ranking = params.ranking;
  goal.min_success = command.min_success;
  goal.request_id = "execution_monitor";
  return goal;
}

execution::ImagineAnswered AnswerOf(int request, const hires::ImagineResult& result,
                                    const hires::GenerateImagineState::Response& state,
                                    bool is_late) {
  execution::ImagineAnswered invalid;
  invalid.request = request;
  invalid.outcome = ImagineOutcome::kInvalid;
  invalid.why = result.why;
  if (IsUnknown(result)) return invalid;
  try {
    return hires::imagination::AnswerOf(request, FromMsg(result), is_late,
                                        NamesIn(state, result.depends_on));
  } catch (const hires::base::ConfigError& error) {
    invalid.why = error.what();
    return invalid;
  }
}

std::string OutcomeName(execution::ImagineAnswered::Outcome outcome) {
  switch (outcome) {
    case ImagineOutcome::kRanked:
      return "ranked";
    case ImagineOutcome::kAllFailed:
      return "all_failed";
    case ImagineOutcome::kUndecided:
      return "undecided";
    case ImagineOutcome::kNoWorker:
      return "no_worker";
    case ImagineOutcome::kNothingFinished:
      return "nothing_finished";
    case ImagineOutcome::kInvalid:
      return "invalid";
    case ImagineOutcome::kUnavailable:
      return "unavailable";
  }
  HIRES_CHECK(false, "an outcome without a name");
  return "";
}

std::uint8_t CodeOf(execution::Finish::Outcome outcome) {
  switch (outcome) {
    case execution::Finish::Outcome::kSucceeded:
      return hires::AchieveResult::SUCCEEDED;
    case execution::Finish::Outcome::kNoPlan:
      return hires::AchieveResult::NO_PLAN;
    case execution::Finish::Outcome::kFailed:
      return hires::AchieveResult::FAILED;
    case execution::Finish::Outcome::kDryRun:
      return hires::AchieveResult::DRY_RUN;
    case execution::Finish::Outcome::kPreempted:
      return hires::AchieveResult::PREEMPTED;
  }
  return hires::AchieveResult::FAILED;
}

std::string OutcomeName(execution::Finish::Outcome outcome) {
  switch (outcome) {
    case execution::Finish::Outcome::kSucceeded:
      return "succeeded";
    case execution::Finish::Outcome::kNoPlan:
      return "no_plan";
    case execution::Finish::Outcome::kFailed:
      return "failed";
    case execution::Finish::Outcome::kDryRun:
      return "dry_run";
    case execution::Finish::Outcome::kPreempted:
      return "preempted";
  }
  return "failed";
}

}  // namespace hires_ros
