#include "hires/planning/validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/planning/step_replay.h"
#include "planning/check/decomposition_check.h"

namespace hires::planning {
namespace {

bool AreEqualCosts(double a, double b) {
  return std::fabs(a - b) <= 1e-9 * std::max({1.0, std::fabs(a), std::fabs(b)});
}

/// The plan carries costs: not one that another planner wrote without them.
bool HasCosts(const Plan& plan) {
  return plan.cost != 0.0 || std::any_of(plan.steps.begin(), plan.steps.end(),
                                         [](const PlanStep& step) { return step.cost != 0.0; });
}

/// Carries the plan out and notes what is wrong on the way.
class ExecutionCheck {
 public:
  ExecutionCheck(const Problem& problem, const Plan& plan, StepReplay* replay)
      : problem_(problem), plan_(plan), replay_(*replay) {}

  std::vector<std::string> Run() {
    for (const PlanStep& step : plan_.steps) Take(step);
    if (HasCosts(plan_)) CheckSum();
    CheckGoal();
    return std::move(wrong_);
  }

  bool is_free_by_domain() const { return cost_by_domain_ == 0.0; }

 private:
  void Take(const PlanStep& step) {
    const int index = replay_.moment();
    const auto say = [&](const std::string& text) {
      wrong_.push_back(fmt::format("step {} {}: {}", index, ToString(step.task), text));
    };
    ReplayedStep taken;
    try {
      taken = replay_.Take(step);
    } catch (const base::ConfigError& error) {
      say(std::string("cannot be checked: ") + error.what());
      replay_.Skip(index);
      return;
    }
    for (const std::string& text : taken.wrong) say(text);
    cost_by_domain_ += std::fabs(taken.cost);
    if (taken.op == nullptr || !HasCosts(plan_) || AreEqualCosts(taken.cost, step.cost)) return;
    say(fmt::format("has cost {}, its operator says {}", step.cost, taken.cost));
  }

  void CheckSum() {
    double sum = 0.0;
    for (const PlanStep& step : plan_.steps) sum += step.cost;
    if (AreEqualCosts(sum, plan_.cost)) return;
    wrong_.push_back(fmt::format("the plan's cost is {}, its steps cost {}", plan_.cost, sum));
  }

  void CheckGoal() {
    if (!problem_.goal) return;
    if (replay_.prover().Holds({*problem_.goal, replay_.facts(), replay_.moment()})) return;
    wrong_.push_back(At(problem_.source, problem_.goal->place) +
                     "the problem's goal does not hold after the last step");
  }

  const Problem& problem_;
  const Plan& plan_;
  StepReplay& replay_;
  double cost_by_domain_{0.0};
  std::vector<std::string> wrong_;
};

}  // namespace

std::vector<std::string> ValidatePlan(const Domain& domain, const Problem& problem,
                                      const Plan& plan, const Functions& functions) {
  StepReplay replay(domain, problem, functions, false);
  ExecutionCheck execution(problem, plan, &replay);
  std::vector<std::string> wrong = execution.Run();
  std::vector<std::string> tree = CheckTree(plan);
  if (tree.empty()) {
    const bool is_foreign = !HasCosts(plan) && !execution.is_free_by_domain();
    const bool is_windowed = domain.language == Domain::Language::kHddl || is_foreign;
    tree = DecompositionCheck(domain, problem, plan, replay.facts(), is_windowed, &replay.prover())
               .Run();
  }
  wrong.insert(wrong.end(), tree.begin(), tree.end());
  return wrong;
}

}  // namespace hires::planning
