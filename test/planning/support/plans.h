#pragma once

#include <string>
#include <vector>

#include "hires/planning/datum_reader.h"
#include "hires/planning/domain.h"
#include "hires/planning/plan.h"
#include "hires/planning/planner.h"
#include "hires/planning/shop2_reader.h"

namespace hires::test_support {

/// A SHOP2 domain with these items.
inline planning::Domain DomainOf(const std::string& items) {
  return planning::ReadShop2Domain("(defdomain d (" + items + "))", "d.lisp");
}

inline planning::Problem ProblemOf(const std::string& facts, const std::string& tasks) {
  return planning::ReadShop2Problems("(defproblem p d " + facts + " " + tasks + ")", "p.lisp")
      .at(0);
}

/// A node or step by hand: "(!lift a)".
inline planning::Datum TaskOf(const std::string& text) {
  return planning::ReadData(text, "task").at(0);
}

/// A plan whose steps are the problem's own tasks, each of cost 1.
inline planning::Plan FlatPlan(const std::vector<std::string>& steps) {
  planning::Plan plan;
  plan.nodes.emplace_back();
  for (const std::string& text : steps) {
    planning::PlanNode node;
    node.task = TaskOf(text);
    node.parent = 0;
    node.step = static_cast<int>(plan.steps.size());
    planning::PlanStep step;
    step.task = node.task;
    step.cost = 1.0;
    step.node = static_cast<int>(plan.nodes.size());
    plan.nodes[0].children.push_back(step.node);
    plan.nodes.push_back(node);
    plan.steps.push_back(step);
    plan.cost += 1.0;
  }
  return plan;
}

/// The problem whose tasks are those steps, in their order.
inline planning::Problem FlatProblem(const std::string& facts,
                                     const std::vector<std::string>& steps) {
  std::string tasks;
  for (const std::string& step : steps) tasks += step;
  return ProblemOf(facts, "(" + tasks + ")");
}

/// A task of a plan by hand: `first_child` and so on are indices that the caller knows.
inline planning::PlanNode MethodNode(const std::string& task, int parent, std::vector<int> children,
                                     int method, int branch, int at_step) {
  planning::PlanNode node;
  node.task = TaskOf(task);
  node.parent = parent;
  node.children = std::move(children);
  node.method = method;
  node.branch = branch;
  node.at_step = at_step;
  return node;
}

/// The one plan that is found.
inline planning::Plan FirstPlan(const planning::Domain& domain, const planning::Problem& problem) {
  return planning::FindPlans(domain, problem).plans.at(0);
}

}  // namespace hires::test_support
