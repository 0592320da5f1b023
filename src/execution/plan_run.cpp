#include "execution/plan_run.h"

#include <algorithm>

#include "execution/instantiation.h"
#include "hires/planning/domain.h"
#include "hires/planning/plan_order.h"
#include "hires/planning/reasons.h"

namespace hires::execution {
namespace {

using planning::Plan;
using planning::PlanStep;

StepRun::Kind KindOf(const Datum& task) {
  if (task.Head().substr(0, 2) == "!!") return StepRun::Kind::kBookkeeping;
  return task.Head() == "!imagine" ? StepRun::Kind::kImagine : StepRun::Kind::kAction;
}

bool LacksReasons(const PlanStep& step) {
  return step.links.empty() && step.adds.empty() && step.deletes.empty();
}

/// Plans from elsewhere may come without reasons, or with part of them.
bool HasReasons(const Plan& plan) {
  const auto is_whole = [](const PlanStep& step) {
    return step.links.size() == step.preconditions.size();
  };
  const auto& steps = plan.steps;
  if (!std::all_of(steps.begin(), steps.end(), is_whole)) return false;
  if (std::all_of(steps.begin(), steps.end(), LacksReasons)) return false;
  return !plan.nodes.empty() || std::any_of(steps.begin(), steps.end(), [](const PlanStep& step) {
    return !step.reads.empty();
  });
}

/// Predicates that steps change; what was said with others stays as it is. What variables among the
/// effects stood for is known from the plan.
std::set<std::string> ChangingIn(const Plan& plan, const planning::Domain& domain) {
  std::set<std::string> names = planning::ChangingPredicates(domain).names;
  for (const PlanStep& step : plan.steps) {
    for (const auto* atoms : {&step.deletes, &step.adds}) {
      for (const Datum& atom : *atoms) names.emplace(atom.Head());
    }
  }
  return names;
}

std::vector<Expectation> ExpectationsOf(const PlanStep& step,
                                        const std::set<std::string>& changing) {
  std::vector<Expectation> expectations;
  for (const planning::CausalLink& link : step.links) {
    if (changing.count(std::string(link.literal.atom.Head())) == 0) continue;
    expectations.push_back({link.literal, ToString(link.literal.atom), link.producer});
  }
  return expectations;
}

}  // namespace

PlanRun::PlanRun(int number, Plan plan, planning::Problem problem, const planning::Domain& domain,
                 const planning::OperatorData& operators)
    : number_(number), plan_(std::move(plan)), problem_(std::move(problem)) {
  if (!HasReasons(plan_)) AddReasons(domain, problem_, &plan_);
  steps_.resize(plan_.steps.size());
  Derive(domain, operators);
}

void PlanRun::Derive(const planning::Domain& domain, const planning::OperatorData& operators) {
  const std::set<std::string> changing = ChangingIn(plan_, domain);
  plan_.subtask_order.clear();
  if (operators.subtask_order == planning::SubtaskOrder::kKept) {
    plan_.subtask_order = OrderOfSubtasks(domain, problem_, plan_);
  }
  for (int i = 0; i < size(); ++i) {
    const PlanStep& planned = plan_.steps[static_cast<std::size_t>(i)];
    StepRun& step = at(i);
    step.kind = KindOf(planned.task);
    step.action = CallOf(planned.task);
    step.after.clear();
    step.expectations = ExpectationsOf(planned, changing);
    if (step.kind != StepRun::Kind::kAction) continue;
    step.resources = ResourcesOf(operators, planned);
    step.disturbance = DisturbanceOf(domain, operators, planned);
    step.duration = DurationOf(operators, planned);
    step.expected = step.duration.expected.value_or(step.duration.min);
  }
  for (const auto& [before, after] : PartialOrder(plan_)) at(after).after.push_back(before);
}

int PlanRun::FindActivity(int activity) const {
  for (int i = 0; i < size(); ++i) {
    const StepRun& step = at(i);
    if (step.activity == activity && step.IsActive() && step.phase == StepPhase::kRunning) return i;
  }
  return -1;
}

std::vector<int> PlanRun::Active() const {
  std::vector<int> active;
  for (int i = 0; i < size(); ++i) {
    if (at(i).IsActive()) active.push_back(i);
  }
  return active;
}

bool PlanRun::AreDone(const std::vector<int>& steps) const {
  return std::all_of(steps.begin(), steps.end(),
                     [&](int step) { return at(step).phase == StepPhase::kDone; });
}

bool PlanRun::IsOver() const {
  return std::all_of(steps_.begin(), steps_.end(), [](const StepRun& step) {
    return step.kind == StepRun::Kind::kImagine || step.phase == StepPhase::kDone;
  });
}

std::string PlanRun::Instantiate(int index, const std::vector<std::string>& arguments,
                                 const planning::Domain& domain,
                                 const planning::OperatorData& operators) {
  Plan changed = plan_;
  const std::string wrong = execution::Instantiate(domain, problem_, index, arguments, &changed);
  if (!wrong.empty()) return wrong;
  plan_ = std::move(changed);
  Derive(domain, operators);
  return "";
}

PlanRun::DoneFirst PlanRun::WithDoneFirst(const std::vector<int>& informs) const {
  const auto is_done = [&](int index) {
    const StepRun& step = at(index);
    if (step.kind != StepRun::Kind::kImagine) return step.phase == StepPhase::kDone;
    const int informed = informs[static_cast<std::size_t>(index)];
    return informed >= 0 && at(informed).phase == StepPhase::kDone;
  };
  std::vector<int> order;
  for (int i = 0; i < size(); ++i) order.push_back(i);
  const auto rest = std::stable_partition(order.begin(), order.end(), is_done);
  return {Reordered(plan_, order), static_cast<int>(rest - order.begin())};
}

}  // namespace hires::execution
