#include "planning/search/plan_extractor.h"

#include "planning/proof/mix.h"

namespace hires::planning {

std::uint64_t PlanExtractor::Key() {
  const Network& network = path_.network();
  std::vector<std::uint64_t> way(network.size(), 0);
  for (const SearchPath::Decomposition& decomposition : path_.decompositions()) {
    way[decomposition.node] =
        1 + 64 * static_cast<std::uint64_t>(decomposition.method->index + 1) + decomposition.branch;
  }
  std::uint64_t key = 0;
  for (std::uint32_t node = Network::kRoot; node < network.size(); ++node) {
    const Network::Node& source = network.node(node);
    const std::uint64_t parent = source.parent == Network::kNone ? 0 : way[source.parent];
    const std::uint64_t task = path_.terms().Hash(path_.Task(node));
    way[node] = Mix(Mix(Mix(parent, source.item), way[node]), task);
    key += Mix(way[node], 0);
  }
  for (const SearchPath::Step& step : path_.steps()) key = Mix(key, way[step.node]);
  return key;
}

Plan PlanExtractor::Extract(bool decomposition) {
  Plan plan;
  plan.cost = path_.cost();
  Numbers numbers(path_.network().size(), -1);
  if (decomposition) {
    AddNodes(&plan, &numbers);
    AddDecompositions(numbers, &plan);
  }
  AddSteps(numbers, &plan);
  return plan;
}

void PlanExtractor::AddSteps(const Numbers& numbers, Plan* plan) {
  plan->steps.reserve(path_.num_steps());
  for (const SearchPath::Step& step : path_.steps()) {
    PlanStep& fresh = plan->steps.emplace_back();
    fresh.task = path_.terms().ToDatum(path_.Task(step.node));
    fresh.cost = step.cost;
    fresh.node = numbers[step.node];
    fresh.bindings = Values(step.applied->variables, step.applied->num_head_slots, step.variables);
    if (fresh.node >= 0) plan->nodes[fresh.node].step = static_cast<int>(plan->steps.size()) - 1;
  }
}

std::vector<std::pair<std::string, Datum>> PlanExtractor::Values(
    const std::vector<std::string>& names, std::uint32_t first, std::uint32_t variables) {
  std::vector<std::pair<std::string, Datum>> values;
  for (std::uint32_t i = first; i < names.size(); ++i) {
    const Term value = path_.bindings().Resolve(Instantiator::Variable(variables, i));
    if (path_.terms().IsGround(value)) {
      values.emplace_back(names[i], path_.terms().ToDatum(value));
    }
  }
  return values;
}

int PlanExtractor::AddNode(std::uint32_t node, int parent, Plan* plan, Numbers* numbers) {
  const int self = static_cast<int>(plan->nodes.size());
  (*numbers)[node] = self;
  PlanNode& fresh = plan->nodes.emplace_back();
  if (node != Network::kRoot) fresh.task = path_.terms().ToDatum(path_.Task(node));
  fresh.parent = parent;
  if (parent >= 0) plan->nodes[parent].children.push_back(self);
  return self;
}

/// Not by recursion: methods that call themselves nest as deep as plans go.
void PlanExtractor::AddNodes(Plan* plan, Numbers* numbers) {
  const Network& network = path_.network();
  plan->nodes.reserve(network.size());
  std::vector<std::pair<std::uint32_t, int>> open{
      {Network::kRoot, -1}};  // node, parent in the plan
  while (!open.empty()) {
    auto [node, self] = open.back();
    open.pop_back();
    const Network::Node& source = network.node(node);
    if (node == Network::kRoot || !source.task.IsNil()) self = AddNode(node, self, plan, numbers);
    if (source.first_child == Network::kNone) continue;
    for (auto i = static_cast<std::uint32_t>(source.subtasks->items.size()); i-- > 0;) {
      open.emplace_back(source.first_child + i, self);
    }
  }
}

void PlanExtractor::AddDecompositions(const Numbers& numbers, Plan* plan) {
  for (const SearchPath::Decomposition& decomposition : path_.decompositions()) {
    const CompiledMethod& method = *decomposition.method;
    PlanNode& node = plan->nodes[numbers[decomposition.node]];
    node.method = method.index;
    node.branch = static_cast<int>(decomposition.branch);
    node.label = method.branches[decomposition.branch].source->label;
    if (node.label.empty() && method.source != nullptr) node.label = method.source->name;
    node.at_step = static_cast<int>(decomposition.num_steps);
    node.bindings = Values(method.variables, method.num_head_slots, decomposition.variables);
  }
}

}  // namespace hires::planning
