#include "nodes/execution_monitor/execution_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/ros/conversions.h"

namespace hires_ros {
namespace {

namespace base = hires::base;
namespace execution = hires::execution;

constexpr double kNormalQuantile95 = 1.6448536269514722;

std::vector<hires::Atom> ToMsgs(const std::vector<base::Atom>& atoms) {
  std::vector<hires::Atom> messages;
  for (const base::Atom& atom : atoms) messages.push_back(ToMsg(atom));
  return messages;
}

/// What made most rollouts fail; nothing where none says.
base::Failure MainFailure(const hires::Prediction& prediction) {
  const auto most = std::max_element(
      prediction.failures.begin(), prediction.failures.end(),
      [](const hires::FailureCount& a, const hires::FailureCount& b) { return a.count < b.count; });
  return most == prediction.failures.end() ? base::Failure() : FromMsg(most->failure);
}

using ImagineOutcome = execution::ImagineAnswered::Outcome;

ImagineOutcome OutcomeOf(const hires::ImagineResult& result, bool is_late) {
  switch (result.outcome) {
    case hires::ImagineResult::RANKED:
    case hires::ImagineResult::RANKED_AT_DEADLINE:
      return ImagineOutcome::kRanked;
    case hires::ImagineResult::ALL_FAILED:
      return ImagineOutcome::kAllFailed;
    case hires::ImagineResult::UNDECIDED:
      return ImagineOutcome::kUndecided;
    case hires::ImagineResult::NO_WORKER:
      return ImagineOutcome::kNoWorker;
    case hires::ImagineResult::NOTHING_FINISHED:
      return ImagineOutcome::kNothingFinished;
    case hires::ImagineResult::CANCELLED:
      return is_late ? ImagineOutcome::kNothingFinished : ImagineOutcome::kUnavailable;
  }
  return ImagineOutcome::kInvalid;
}

void SetRecommended(const hires::Prediction& prediction, execution::ImagineAnswered* answer) {
  answer->recommended = FromMsg(prediction.action);
  answer->duration = prediction.duration_mean;
  // The message has no lower quantile: as of a normal distribution.
  answer->duration_low =
      std::max(0.0, prediction.duration_mean - kNormalQuantile95 * prediction.duration_sd);
  answer->duration_high = std::max(prediction.duration_p95, prediction.duration_mean);
}

std::vector<std::string> InstancesOf(const hires::GenerateImagineState::Response& state,
                                     const std::vector<hires::Atom>& depends_on) {
  std::set<std::string> instances;
  for (const hires::ObjectState& object : state.world_state.objects) {
    instances.insert(base::ToLower(object.name));
  }
  for (const hires::Atom& atom : depends_on) {
    for (const std::string& argument : atom.arguments) instances.insert(base::ToLower(argument));
  }
  return {instances.begin(), instances.end()};
}

}  // namespace

void SetDispatch(const std::vector<hires::StepStatus>& steps,
                 std::vector<hires::ImaginationStatus>* imaginations) {
  for (hires::ImaginationStatus& imagination : *imaginations) {
    const auto begun = [&](const hires::StepStatus& step) {
      if (std::isnan(step.started)) return false;
      if (step.plan == imagination.plan) return step.index == imagination.step;
      return step.plan > imagination.plan &&
             base::IsAmong(FromMsg(step.action), FromMsg(imagination.action));
    };
    const auto step = std::find_if(steps.begin(), steps.end(), begun);
    if (step != steps.end()) imagination.dispatch = step->started;
  }
}

hires::Atom ToMsg(const base::Atom& atom) {
  hires::Atom message;
  message.predicate = atom.predicate;
  message.arguments = atom.arguments;
  return message;
}

hires::PlanGoal GoalOf(const execution::StartPlanning& command, double time_limit) {
  hires::PlanGoal goal;
  goal.task = command.tasks;
  goal.state = ToMsgs(command.state);
  goal.more_facts = ToMsgs(command.facts);
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
  goal.seed = params.seed;
  goal.ranking = params.ranking;
  goal.min_success = command.min_success;
  goal.request_id = "execution_monitor";
  return goal;
}

execution::ImagineAnswered AnswerOf(int request, const hires::ImagineResult& result,
                                    const hires::GenerateImagineState::Response& state,
                                    bool is_late) {
  execution::ImagineAnswered answer;
  answer.request = request;
  answer.why = result.why;
  answer.outcome = OutcomeOf(result, is_late);
  const bool is_known =
      0 <= result.recommended && result.recommended < static_cast<int>(result.predictions.size());
  if (answer.outcome == ImagineOutcome::kRanked && !is_known) {
    answer.outcome = ImagineOutcome::kInvalid;
    answer.why = "the ranking recommends nothing: " + result.why;
  }
  if (answer.outcome == ImagineOutcome::kRanked) {
    SetRecommended(result.predictions[result.recommended], &answer);
  }
  for (const hires::Prediction& prediction : result.predictions) {
    if (answer.outcome != ImagineOutcome::kAllFailed) break;
    answer.failed.push_back(FromMsg(prediction.action));
    answer.failures.push_back(MainFailure(prediction));
  }
  answer.depends_on = InstancesOf(state, result.depends_on);
  return answer;
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
