#include "hires/planning/plan_json.h"

#include <nlohmann/json.hpp>

#include "hires/planning/plan_order.h"

namespace hires::planning {
namespace {

using nlohmann::ordered_json;

/// An array of what `convert` makes of each item; [] where there is none.
template <typename Items, typename Convert>
ordered_json ArrayOf(const Items& items, const Convert& convert) {
  ordered_json array = ordered_json::array();
  for (const auto& item : items) array.push_back(convert(item));
  return array;
}

ordered_json AtomsToJson(const std::vector<Datum>& atoms) {
  return ArrayOf(atoms, [](const Datum& atom) { return ToString(atom); });
}

ordered_json ArgumentsToJson(const Datum& task) {
  ordered_json arguments = ordered_json::array();
  for (std::size_t i = 1; i < task.items.size(); ++i) arguments.push_back(ToString(task.items[i]));
  return arguments;
}

ordered_json ToJson(const CausalLink& link) {
  return {{"producer", link.producer}, {"precondition", ToString(link.literal)}};
}

ordered_json StepToJson(const Plan& plan, int index) {
  const PlanStep& step = plan.steps[index];
  return {{"operator", step.task.Head()},
          {"arguments", ArgumentsToJson(step.task)},
          {"cost", step.cost},
          {"preconditions",
           ArrayOf(step.preconditions, [](const Literal& literal) { return ToString(literal); })},
          {"deletes", AtomsToJson(step.deletes)},
          {"adds", AtomsToJson(step.adds)},
          {"links", ArrayOf(step.links, [](const CausalLink& link) { return ToJson(link); })},
          {"path", DecompositionPath(plan, index)}};
}

ordered_json ToJson(const TraceEntry& entry) {
  return {{"depth", entry.depth},
          {"task", entry.task},
          {"where", entry.where},
          {"reason", entry.reason}};
}

}  // namespace

std::string ToString(const Literal& literal) {
  const std::string atom = ToString(literal.atom);
  return literal.holds ? atom : "(not " + atom + ")";
}

ordered_json ToJson(const Plan& plan) {
  ordered_json steps = ordered_json::array();
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    steps.push_back(StepToJson(plan, static_cast<int>(i)));
  }
  return {{"cost", plan.cost},
          {"steps", std::move(steps)},
          {"order", ArrayOf(PartialOrder(plan), [](const std::pair<int, int>& pair) {
             return ordered_json::array({pair.first, pair.second});
           })}};
}

ordered_json ToJson(const PlanResult& result, const SearchCosts& costs) {
  ordered_json json{{"outcome", ToString(result.outcome)},
                    {"exhausted", result.exhausted},
                    {"plans", ArrayOf(result.plans, [](const Plan& plan) { return ToJson(plan); })},
                    {"statistics",
                     {{"expansions", result.progress.expansions},
                      {"inferences", result.progress.inferences},
                      {"cpu_seconds", costs.cpu_seconds},
                      {"peak_mb", costs.peak_mb}}}};
  if (!result.trace.empty()) {
    json["trace"] = ArrayOf(result.trace, [](const TraceEntry& entry) { return ToJson(entry); });
  }
  return json;
}

}  // namespace hires::planning
