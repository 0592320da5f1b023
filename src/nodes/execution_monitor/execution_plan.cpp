#include <fmt/format.h>

#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/planning/reasons.h"
#include "hires/planning/step_replay.h"
#include "hires/planning/task_text.h"
#include "hires/ros/planning/plan_nodes.h"
#include "hires/ros/planning/plan_request.h"
#include "nodes/execution_monitor/execution_messages.h"

namespace hires_ros {
namespace {

namespace planning = hires::planning;

constexpr double kNoLimit = 1e9;

/// Far beyond whatever a goal asks for: it was the planner's to refuse it.
planning::PlannerConfig AnyConfig() {
  planning::PlannerConfig config;
  config.time_limit = kNoLimit;
  config.memory_limit = kNoLimit;
  return config;
}

/// Steps below one root, until the message says how the tasks broke down.
planning::Plan StepsOf(const hires::Plan& message) {
  planning::Plan plan;
  plan.cost = message.cost;
  plan.nodes.emplace_back();
  for (std::size_t i = 0; i < message.steps.size(); ++i) {
    planning::PlanStep step;
    step.task =
        planning::ReadGroundTerm(message.steps[i].task, fmt::format("plan.steps[{}].task", i));
    step.cost = message.steps[i].cost;
    step.node = static_cast<int>(plan.nodes.size());
    planning::PlanNode node;
    node.task = step.task;
    node.parent = 0;
    node.step = static_cast<int>(i);
    node.at_step = static_cast<int>(i);
    plan.nodes[0].children.push_back(step.node);
    plan.nodes.push_back(std::move(node));
    plan.steps.push_back(std::move(step));
  }
  return plan;
}

/// What the variables beside those of the head stand for, by the first proof of each step.
void AddBindings(const planning::Domain& domain, const planning::Problem& problem,
                 planning::Plan* plan) {
  const planning::Functions& functions = planning::Functions::Standard();
  planning::StepReplay replay(domain, problem, functions, false);
  for (planning::PlanStep& step : plan->steps) {
    const planning::ReplayedStep taken = replay.Take(step);
    if (taken.op == nullptr) continue;  // AddReasons says so
    std::set<std::string> head;
    planning::CollectVariables(taken.op->head, &head);
    for (const auto& [variable, value] : taken.values) {
      if (head.count(variable) == 0) step.bindings.emplace_back(variable, value);
    }
  }
}

}  // namespace

planning::Plan PlanOf(const hires::Plan& message, const hires::PlanGoal& goal,
                      const planning::PlanningKnowledge& knowledge) {
  const planning::Problem problem = RequestOf(goal, knowledge, AnyConfig()).problem;
  planning::Plan plan = StepsOf(message);
  AddNodes(message, knowledge.domain, &plan);
  AddBindings(knowledge.domain, problem, &plan);
  planning::AddReasons(knowledge.domain, problem, &plan);
  return plan;
}

}  // namespace hires_ros
