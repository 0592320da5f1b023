// Writing down the plans that were found.
#include <algorithm>
#include <utility>

#include "planning/proof/mix.h"
#include "planning/search/search.h"

namespace hires::planning {

bool Search::FoundPlan() {
  if (program_.goal() != nullptr) {
    const std::size_t floor = prover_.num_choices();
    const std::uint32_t variables = bindings_.Make(program_.goal_slots());
    if (!prover_.Solve(program_.goal(), variables, true)) {
      Note(Term(), program_.problem().source, "the problem's goal does not hold in the end");
      return false;
    }
    prover_.Cut(floor);
  }
  if (request_.which == Which::kAll && !plan_keys_.insert(PlanKey()).second) return false;
  if (request_.which == Which::kBest) {
    if (cost_ >= best_cost_) return false;  // the first of the cheapest stays
    plans_.clear();
  }
  best_cost_ = std::min(best_cost_, cost_);
  plans_.push_back(Extract());
  enough_ = request_.which == Which::kFirst ||
            (request_.which == Which::kAll && plans_.size() >= request_.max_plans);
  return false;
}

/// The same for plans with the same steps in the same order and the same decomposition: those that
/// differ only in when a task was found to need no step are one plan.
std::uint64_t Search::PlanKey() {
  std::vector<std::uint64_t> way(network_.size(), 0);
  for (const Decomposition& decomposition : decompositions_) {
    way[decomposition.node] =
        1 + 64 * static_cast<std::uint64_t>(decomposition.method->index + 1) + decomposition.branch;
  }
  std::uint64_t key = 0;
  for (std::uint32_t node = Network::kRoot; node < network_.size(); ++node) {
    const Network::Node& source = network_.node(node);
    const std::uint64_t parent = source.parent == Network::kNone ? 0 : way[source.parent];
    const std::uint64_t task = terms_.Hash(bindings_.Resolve(source.task));
    way[node] = Mix(Mix(Mix(parent, source.item), way[node]), task);
    key += Mix(way[node], 0);
  }
  for (const Step& step : steps_) key = Mix(key, way[step.node]);
  return key;
}

std::vector<std::pair<std::string, Datum>> Search::Values(const std::vector<std::string>& names,
                                                          std::uint32_t first,
                                                          std::uint32_t variables) {
  std::vector<std::pair<std::string, Datum>> values;
  for (std::uint32_t i = first; i < names.size(); ++i) {
    const Term value = bindings_.Resolve(Term(Term::Kind::kVariable, variables + i));
    if (terms_.IsGround(value)) values.emplace_back(names[i], terms_.ToDatum(value));
  }
  return values;
}

Plan Search::Extract() {
  Plan plan;
  plan.cost = cost_;
  plan.steps.reserve(steps_.size());
  std::vector<int> number(network_.size(), -1);
  if (request_.decomposition) ExtractNodes(&plan, &number);
  for (const Step& step : steps_) {
    PlanStep& fresh = plan.steps.emplace_back();
    fresh.task = terms_.ToDatum(bindings_.Resolve(network_.node(step.node).task));
    fresh.cost = step.cost;
    fresh.node = number[step.node];
    fresh.bindings = Values(step.applied->variables, step.applied->num_head_slots, step.variables);
    if (fresh.node >= 0) plan.nodes[fresh.node].step = static_cast<int>(plan.steps.size()) - 1;
  }
  return plan;
}

int Search::AddNode(std::uint32_t node, int parent, Plan* plan, std::vector<int>* number) {
  const int self = static_cast<int>(plan->nodes.size());
  (*number)[node] = self;
  PlanNode& fresh = plan->nodes.emplace_back();
  if (node != Network::kRoot) {
    fresh.task = terms_.ToDatum(bindings_.Resolve(network_.node(node).task));
  }
  fresh.parent = parent;
  if (parent >= 0) plan->nodes[parent].children.push_back(self);
  return self;
}

void Search::ExtractNodes(Plan* plan, std::vector<int>* number) {
  plan->nodes.reserve(network_.size());
  std::vector<std::pair<std::uint32_t, int>> open{
      {Network::kRoot, -1}};  // node, parent in the plan
  while (
      !open.empty()) {  // not by recursion: methods that call themselves nest as deep as plans go
    auto [node, self] = open.back();
    open.pop_back();
    const Network::Node& source = network_.node(node);
    if (node == Network::kRoot || !source.task.IsNil()) self = AddNode(node, self, plan, number);
    if (source.first_child == Network::kNone) continue;
    for (auto i = static_cast<std::uint32_t>(source.subtasks->items.size()); i-- > 0;) {
      open.emplace_back(source.first_child + i, self);
    }
  }
  for (const Decomposition& decomposition : decompositions_) {
    PlanNode& node = plan->nodes[(*number)[decomposition.node]];
    node.method = decomposition.method->index;
    node.branch = static_cast<int>(decomposition.branch);
    const Branch& branch = *decomposition.method->branches[decomposition.branch].source;
    node.label = branch.label;
    if (node.label.empty() && decomposition.method->source != nullptr) {
      node.label = decomposition.method->source->name;
    }
    node.at_step = static_cast<int>(decomposition.num_steps);
    node.bindings = Values(decomposition.method->variables, decomposition.method->num_head_slots,
                           decomposition.variables);
  }
}

}  // namespace hires::planning
