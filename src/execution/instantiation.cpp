#include "execution/instantiation.h"

#include <fmt/format.h>

#include <algorithm>

#include "execution/facts.h"
#include "execution/step_effects.h"
#include "hires/base/error.h"
#include "hires/planning/reasons.h"
#include "hires/planning/substitution.h"
#include "hires/planning/task_text.h"

namespace hires::execution {
namespace {

using planning::Plan;
using planning::PlanNode;
using planning::TaskItem;
using planning::TaskNetwork;

void CollectLeaves(const TaskNetwork& network, std::vector<const Datum*>* leaves) {
  for (const TaskItem& item : network.items) {
    if (item.network.empty()) leaves->push_back(&item.task);
    for (const TaskNetwork& nested : item.network) CollectLeaves(nested, leaves);
  }
}

/// The subtasks of a node as the method writes them; none for the problem's own.
std::vector<const Datum*> SubtasksOf(const planning::Domain& domain, const PlanNode& node) {
  std::vector<const Datum*> leaves;
  if (node.method < 0 || node.branch < 0) return leaves;
  CollectLeaves(domain.methods.at(node.method).branches.at(node.branch).subtasks, &leaves);
  return leaves.size() == node.children.size() ? leaves : std::vector<const Datum*>();
}

bool Mentions(const planning::Formula& formula, const std::string& variable) {
  std::set<std::string> names;
  CollectVariables(formula.term, &names);
  CollectVariables(formula.expression, &names);
  return names.count(variable) > 0 ||
         std::any_of(formula.parts.begin(), formula.parts.end(),
                     [&](const auto& part) { return Mentions(part, variable); });
}

bool Mentions(const std::vector<planning::Effect>& effects, const std::string& variable) {
  return std::any_of(effects.begin(), effects.end(), [&](const planning::Effect& effect) {
    std::set<std::string> names;
    CollectVariables(effect.term, &names);
    return names.count(variable) > 0 || Mentions(effect.condition, variable) ||
           Mentions(effect.effects, variable);
  });
}

/// Whether the argument at that place decides what the step needs or does.
bool Matters(const planning::Domain& domain, const Datum& task, std::size_t place) {
  const planning::Operator* op = OperatorOf(domain, task);
  if (op == nullptr || place >= op->head.items.size()) return true;
  const Datum& variable = op->head.items[place];
  if (variable.kind != Datum::Kind::kVariable) return true;
  return Mentions(op->precondition.condition, variable.text) ||
         Mentions(op->deletes, variable.text) || Mentions(op->adds, variable.text);
}

class Instantiation {
 public:
  Instantiation(const planning::Domain& domain, Plan* plan) : domain_(domain), plan_(*plan) {}

  void Set(int step, std::size_t place, const Datum& value) {
    SetTask(step, place, value);
    const int node = plan_.steps[step].node;
    if (node < 0 || node >= static_cast<int>(plan_.nodes.size())) return;
    if (plan_.nodes[node].parent >= 0) SetSiblings(plan_.nodes[node].parent, node, place, value);
  }

  bool matters() const { return matters_; }

 private:
  void SetTask(int step, std::size_t place, const Datum& value) {
    matters_ = matters_ || Matters(domain_, plan_.steps[step].task, place);
    plan_.steps[step].task.items[place] = value;
    const int node = plan_.steps[step].node;
    if (node >= 0 && node < static_cast<int>(plan_.nodes.size())) {
      plan_.nodes[node].task.items[place] = value;
    }
  }

  void SetSiblings(int parent, int node, std::size_t place, const Datum& value) {
    const std::vector<int> children = plan_.nodes[parent].children;
    const std::vector<const Datum*> subtasks = SubtasksOf(domain_, plan_.nodes[parent]);
    const auto at = std::find(children.begin(), children.end(), node) - children.begin();
    if (subtasks.empty() || at >= static_cast<std::ptrdiff_t>(subtasks.size())) return;
    if (place >= subtasks[at]->items.size()) return;
    const Datum variable = subtasks[at]->items[place];
    if (variable.kind != Datum::Kind::kVariable) return;
    for (auto& [name, bound] : plan_.nodes[parent].bindings) {
      if (name == variable.text) bound = value;
    }
    for (std::size_t i = at + 1; i < children.size(); ++i) {
      SetWhere(*subtasks[i], variable, children[i], value);
    }
  }

  void SetWhere(const Datum& subtask, const Datum& variable, int node, const Datum& value) {
    if (plan_.nodes[node].step < 0) return;
    for (std::size_t place = 1; place < subtask.items.size(); ++place) {
      if (subtask.items[place] == variable) SetTask(plan_.nodes[node].step, place, value);
    }
  }

  const planning::Domain& domain_;
  Plan& plan_;
  bool matters_{false};
};

}  // namespace

std::string Instantiate(const planning::Domain& domain, const planning::Problem& problem, int step,
                        const std::vector<std::string>& arguments, Plan* plan) {
  const Datum task = plan->steps[step].task;
  if (arguments.size() + 1 != task.items.size()) {
    return fmt::format("{} arguments came for {}", arguments.size(), ToString(task));
  }
  try {
    Instantiation change(domain, plan);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const Datum value = planning::ReadGroundTerm(arguments[i], "argument");
      if (value != task.items[i + 1]) change.Set(step, i + 1, value);
    }
    if (change.matters()) AddReasons(domain, problem, plan);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

Plan Reordered(const Plan& plan, const std::vector<int>& order) {
  Plan result = plan;
  std::vector<int> place(order.size() + 1, static_cast<int>(order.size()));
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<int>(i);
    result.steps[i] = plan.steps[order[i]];
    for (planning::CausalLink& link : result.steps[i].links) {
      if (link.producer >= 0) {
        link.producer =
            static_cast<int>(std::find(order.begin(), order.end(), link.producer) - order.begin());
      }
    }
  }
  for (auto& [before, after] : result.subtask_order) {
    before = place[before];
    after = place[after];
  }
  for (PlanNode& node : result.nodes) {
    if (node.step >= 0) node.step = place[node.step];
    if (node.at_step >= 0 && node.at_step < static_cast<int>(place.size())) {
      node.at_step = place[node.at_step];
    }
  }
  return result;
}

}  // namespace hires::execution
