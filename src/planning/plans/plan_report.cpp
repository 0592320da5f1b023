#include "hires/planning/plan_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::planning {
namespace {

double CheapestCost(const std::vector<Plan>& plans) {
  double cost = plans.front().cost;
  for (const Plan& plan : plans) cost = std::min(cost, plan.cost);
  return cost;
}

/// @pre there is a plan.
std::string PlansText(const std::vector<Plan>& plans) {
  if (plans.size() == 1) {
    const std::size_t steps = plans[0].steps.size();
    return fmt::format("1 plan, {} step{}, cost {}", steps, steps == 1 ? "" : "s", plans[0].cost);
  }
  return fmt::format("{} plans, the cheapest costs {}", plans.size(), CheapestCost(plans));
}

std::string FoundText(const PlanResult& result, Which which) {
  const std::string plans = PlansText(result.plans);
  if (which == Which::kBest) return plans + "; none is cheaper";
  if (which == Which::kAll && !result.exhausted) return plans + "; there may be more";
  return result.exhausted ? plans + "; there are no others" : plans;
}

std::string StoppedText(const PlanResult& result, const char* why, const char* remedy) {
  const std::string found =
      result.plans.empty() ? "no plan found so far" : PlansText(result.plans) + " so far";
  return fmt::format("{} after {} expansions: {}{}", why, result.progress.expansions, found,
                     remedy);
}

/// Where the ways that led furthest ended, and then what may be behind it: a name that nothing
/// knows may also be one that does not matter.
std::string WhyNone(const PlanResult& result) {
  std::string text, task;
  for (const TraceEntry& end : result.deepest) {
    const bool is_same = end.task == task || end.task.empty();  // empty: all tasks are done
    const std::string at = is_same ? "," : fmt::format("; it got as far as {}:", end.task);
    text += fmt::format("{} {}{}", at, end.reason,
                        end.where.empty() ? "" : fmt::format(" ({})", end.where));
    task = end.task;
  }
  if (!result.unknown_names.empty()) {
    text += fmt::format("; neither a fact nor the domain knows {}",
                        base::Join(result.unknown_names, ", "));
  }
  return text;
}

}  // namespace

std::string OutcomeSentence(const PlanResult& result, Which which) {
  switch (result.outcome) {
    case PlanOutcome::kFound:
      return FoundText(result, which);
    case PlanOutcome::kNoPlan:
      return "there is no plan; every way was tried" + WhyNone(result);
    case PlanOutcome::kLimitTime:
      return StoppedText(result, "stopped at the time limit", "; allow more time");
    case PlanOutcome::kLimitMemory:
      return StoppedText(result, "stopped at the memory limit", "; allow more memory");
    case PlanOutcome::kCancelled:
      return StoppedText(result, "cancelled", "");
    case PlanOutcome::kLimitDepth:
      return StoppedText(result, "gave up paths at the depth limit", "; allow more depth");
    case PlanOutcome::kLimitCost:
      return StoppedText(result, "gave up paths at the cost limit", "; allow a higher cost");
  }
  return "";
}

Which ParseWhich(const std::string& text) {
  if (text == "first") return Which::kFirst;
  if (text == "all") return Which::kAll;
  if (text == "best") return Which::kBest;
  throw base::ConfigError(base::UnknownName("choice of plans", text, {"first", "all", "best"}));
}

}  // namespace hires::planning
