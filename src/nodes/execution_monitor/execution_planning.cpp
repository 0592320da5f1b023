#include "nodes/execution_monitor/execution_planning.h"

#include <utility>

#include "hires/base/error.h"
#include "hires/ros/names/topic_names.h"
#include "nodes/execution_monitor/execution_messages.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;

}  // namespace

PlanRequests::PlanRequests(const hires::planning::PlanningKnowledge* knowledge, double time_limit,
                           const ActionLinkParams& params, ros::NodeHandle* nh, Post post,
                           OnAnswer on_answer)
    : knowledge_(knowledge),
      time_limit_(time_limit),
      post_(post),
      on_answer_(std::move(on_answer)),
      link_(kPlanAction, params, nh, std::move(post),
            [this](int key, const hires::PlanResultConstPtr& result, int, const std::string& why) {
              OnEnd(key, result, why);
            }) {}

void PlanRequests::Start(const execution::StartPlanning& command) {
  const int key = next_key_++;
  requests_[key] = {command.request, GoalOf(command, time_limit_)};
  link_.Send(key, requests_[key].goal);
}

void PlanRequests::Cancel(const execution::CancelPlanning& command) {
  for (auto request = requests_.begin(); request != requests_.end(); ++request) {
    if (request->second.id != command.request) continue;
    const int key = request->first;
    requests_.erase(request);
    return link_.Cancel(key);
  }
}

void PlanRequests::CancelAll() {
  for (const auto& [key, request] : std::exchange(requests_, {})) link_.Cancel(key);
}

void PlanRequests::OnEnd(int key, const hires::PlanResultConstPtr& result, const std::string& why) {
  const auto found = requests_.find(key);
  if (found == requests_.end()) return;
  if (result) {
    const Request request = found->second;
    return reader_.Post([this, key, request, result] { Read(key, request, result); });
  }
  execution::PlanArrived answer;
  answer.request = found->second.id;
  answer.outcome = execution::PlanArrived::Outcome::kUnavailable;
  answer.why = why;
  Answer(key, answer);
}

/// On the reader's thread.
void PlanRequests::Read(int key, const Request& request, const hires::PlanResultConstPtr& result) {
  execution::PlanArrived answer = AnswerOf(request.id, *result);
  if (answer.outcome == execution::PlanArrived::Outcome::kFound) {
    try {
      answer.plan = PlanOf(result->plans[0], request.goal, *knowledge_);
    } catch (const hires::base::ConfigError& error) {
      answer.outcome = execution::PlanArrived::Outcome::kInvalid;
      answer.why = error.what();
    }
  }
  post_([this, key, answer = std::move(answer)] { Answer(key, answer); });
}

void PlanRequests::Answer(int key, const execution::PlanArrived& answer) {
  if (requests_.erase(key) > 0) on_answer_(answer);
}

}  // namespace hires_ros
