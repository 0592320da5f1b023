#pragma once

#include <string>
#include <vector>

#include "hires/planning/plan.h"
#include "hires/planning/planner.h"
#include "hires/planning/shop2_reader.h"

namespace hires::test_support {

/// "(!lift b1) (!drop b1 t)": the steps of a plan on one line.
inline std::string Steps(const planning::Plan& plan) {
  std::string text;
  for (const planning::PlanStep& step : plan.steps) {
    text += (text.empty() ? "" : " ") + ToString(step.task);
  }
  return text;
}

inline std::vector<std::string> Steps(const planning::PlanResult& result) {
  std::vector<std::string> all;
  for (const planning::Plan& plan : result.plans) all.push_back(Steps(plan));
  return all;
}

/// Plans for `tasks` from `facts` (both as in a defproblem) with the items of a defdomain.
inline planning::PlanResult Solve(
    const std::string& items, const std::string& facts, const std::string& tasks,
    const planning::PlanRequest& request = {},
    const planning::Functions& functions = planning::Functions::Standard()) {
  const planning::Domain domain =
      planning::ReadShop2Domain("(defdomain d (" + items + "))", "domain");
  const planning::Problem problem =
      planning::ReadShop2Problems("(defproblem p d " + facts + " " + tasks + ")", "problem").at(0);
  return planning::FindPlans(domain, problem, request, functions);
}

/// All plans, in the order in which they are found.
inline std::vector<std::string> AllPlans(
    const std::string& items, const std::string& facts, const std::string& tasks,
    const planning::Functions& functions = planning::Functions::Standard()) {
  planning::PlanRequest request;
  request.which = planning::Which::kAll;
  return Steps(Solve(items, facts, tasks, request, functions));
}

}  // namespace hires::test_support
