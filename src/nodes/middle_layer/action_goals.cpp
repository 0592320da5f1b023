#include "nodes/middle_layer/action_goals.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"

namespace hires_ros {
namespace {

using hires::ExecuteActionResult;
using hires::base::ConfigError;
using hires::base::Failure;
using hires::base::LogLevel;
using hires::control::ActionEnd;
using hires::control::ActionNews;
using Code = hires::base::FailureCode;

ExecuteActionResult ResultOf(std::uint8_t code, const Failure& failure, double duration) {
  ExecuteActionResult result;
  result.code = code;
  result.failure = ToMsg(failure);
  result.failure.detail = hires::base::Shortened(failure.detail);
  result.duration = duration;
  return result;
}

void RequireTimeLimit(double time_limit) {
  if (time_limit >= 0.0) return;
  throw ConfigError(
      fmt::format("time_limit is {:g} s, wanted 0 (the node's own) or more", time_limit));
}

}  // namespace

ActionGoals::ActionGoals(const Params& params, Hooks hooks, ros::NodeHandle* nh)
    : params_(params),
      hooks_(std::move(hooks)),
      server_(
          *nh, kExecuteAction, [this](GoalHandle goal) { OnGoal(goal); },
          [this](GoalHandle goal) { OnCancel(goal); }, false) {}

void ActionGoals::OnGoal(GoalHandle goal) {
  try {
    hooks_.check(FromMsg(goal.getGoal()->action));
    RequireTimeLimit(goal.getGoal()->time_limit.toSec());
  } catch (const ConfigError& error) {
    goal.setRejected(
        ResultOf(ExecuteActionResult::INVALID, {Code::kInvalidAction, {}, error.what()}, 0.0));
    return;
  }
  if (params_.dry_run) {
    goal.setRejected(ResultOf(ExecuteActionResult::FAILED, Code::kDryRun, 0.0));
    return;
  }
  waiting_.push_back({goal, Steady::now()});
  StartWaiting();
}

void ActionGoals::StartWaiting() {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    const Failure why_not = hooks_.why_not_ready(FromMsg(waiting->goal.getGoal()->action));
    const std::chrono::duration<double> waited = Steady::now() - waiting->since;
    if (!why_not) {
      StartGoal(waiting->goal);
    } else if (waited.count() > params_.start_patience) {
      waiting->goal.setRejected(ResultOf(ExecuteActionResult::FAILED, why_not, 0.0));
    } else {
      ++waiting;
      continue;
    }
    waiting = waiting_.erase(waiting);
  }
}

void ActionGoals::StartGoal(GoalHandle goal) {
  const hires::base::ActionCall action = FromMsg(goal.getGoal()->action);
  const int id = next_id_;
  const Failure refusal = hooks_.start(id, action, goal.getGoal()->time_limit.toSec());
  if (refusal) {
    goal.setRejected(ResultOf(ExecuteActionResult::INVALID, refusal, 0.0));
    return;
  }
  ++next_id_;
  hires::base::Log(LogLevel::kInfo, fmt::format("action={} begins", hires::base::ToString(action)));
  goal.setAccepted();
  going_[id] = {goal, 0.0, ""};
  hooks_.started(id, action);
}

void ActionGoals::OnCancel(GoalHandle goal) {
  waiting_.remove_if([&](Waiting& waiting) {
    if (!(waiting.goal == goal)) return false;
    goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, {}, 0.0));
    return true;
  });
  for (const auto& [id, going] : going_) {
    if (!(going.goal == goal)) continue;
    hooks_.cancel(id);
    return;  // it may have ended, and is no more in the map then
  }
}

void ActionGoals::End(const ActionNews& news, ActionEnd end, const Failure& failure) {
  const auto going = going_.find(news.id);
  GoalHandle goal = going->second.goal;
  going_.erase(going);
  ++num_ended_;
  hires::base::Log(LogLevel::kInfo,
                   fmt::format("action={} ends failure=\"{}\" duration={:.2f}",
                               hires::base::ToString(FromMsg(goal.getGoal()->action)),
                               ToString(failure), news.elapsed));
  switch (end) {
    case ActionEnd::kSucceeded:
      goal.setSucceeded(ResultOf(ExecuteActionResult::SUCCEEDED, failure, news.elapsed));
      break;
    case ActionEnd::kFailed:
      goal.setAborted(ResultOf(ExecuteActionResult::FAILED, failure, news.elapsed));
      break;
    case ActionEnd::kPreempted:
      goal.setCanceled(ResultOf(ExecuteActionResult::PREEMPTED, failure, news.elapsed));
      break;
  }
}

void ActionGoals::PublishFeedback(const std::vector<ActionNews>& news) {
  for (const ActionNews& entry : news) {
    Going& going = going_.at(entry.id);
    if (entry.elapsed < going.next_feedback && entry.phase == going.phase) continue;
    going.next_feedback = entry.elapsed + params_.feedback_period;
    going.phase = entry.phase;
    hires::ExecuteActionFeedback feedback;
    feedback.elapsed = entry.elapsed;
    feedback.phase = entry.phase;
    going.goal.publishFeedback(feedback);
  }
}

}  // namespace hires_ros
