#include "hires/planning/plan.h"

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::planning {

bool operator==(const Literal& a, const Literal& b) {
  return a.holds == b.holds && a.atom == b.atom;
}

std::string DecompositionPath(const Plan& plan, int step) {
  const auto is_index = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  HIRES_CHECK(is_index(step, plan.steps.size()), "the plan has no such step");
  HIRES_CHECK(is_index(plan.steps[step].node, plan.nodes.size()), "the step has no such node");
  std::vector<std::string> names;
  for (int node = plan.nodes[plan.steps[step].node].parent; node > 0;
       node = plan.nodes[node].parent) {
    HIRES_CHECK(names.size() < plan.nodes.size(), "a node is above itself");
    names.emplace_back(plan.nodes[node].task.Head());
  }
  std::reverse(names.begin(), names.end());
  return base::Join(names, "/");
}

std::string ToShop2Plan(const Plan& plan) {
  std::string text;
  for (const PlanStep& step : plan.steps) text += ToString(step.task) + '\n';
  return text;
}

}  // namespace hires::planning
