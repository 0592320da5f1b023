#include "planning/check/decomposition_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

// Variables that a plan still has are none of the domain's: they get names of their own.
constexpr char kOfPlan[] = "@plan";
constexpr char kThen[] = "@then";

/// Unifies a term of the domain with one of the plan.
bool UnifyWithPlan(const Datum& pattern, const Datum& of_plan, const char* suffix,
                   Substitution* values) {
  if (IsGround(of_plan)) return values->Unify(pattern, of_plan);  // no copy: lists may be long
  return values->Unify(pattern, RenameVariables(of_plan, suffix));
}

int Size(const std::vector<PlanNode>& nodes) { return static_cast<int>(nodes.size()); }

bool IsPrimitive(const PlanNode& node) { return node.method < 0; }

std::size_t CountLeaves(const TaskItem& item) {
  return item.network.empty() ? 1 : LeavesOf(item.network.front()).size();
}

/// Items so that each comes after those it waits for.
std::vector<std::size_t> InOrder(const TaskNetwork& network) {
  std::vector<int> waits_for(network.items.size(), 0);
  for (const auto& pair : network.order) ++waits_for.at(pair.second);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < waits_for.size(); ++i) {
    if (waits_for[i] == 0) order.push_back(i);
  }
  for (std::size_t done = 0; done < order.size(); ++done) {
    for (const auto& [before, after] : network.order) {
      if (static_cast<std::size_t>(before) != order[done]) continue;
      if (--waits_for[after] == 0) order.push_back(after);
    }
  }
  return order;
}

/// Checks one node's place in the tree, `text` tells which.
void CheckLinks(const Plan& plan, int index, std::vector<std::string>* wrong) {
  const PlanNode& node = plan.nodes[index];
  for (const int child : node.children) {
    if (child <= 0 || child >= Size(plan.nodes)) {
      wrong->push_back(fmt::format("node {}: its child {} does not exist", index, child));
    } else if (plan.nodes[child].parent != index) {
      wrong->push_back(fmt::format("{}: is a child of node {}, but names node {} as its parent",
                                   NodeText(plan, child), index, plan.nodes[child].parent));
    }
  }
}

void CheckLeaf(const Plan& plan, int index, std::vector<std::string>* wrong) {
  const PlanNode& node = plan.nodes[index];
  const auto say = [&](const std::string& text) {
    wrong->push_back(NodeText(plan, index) + ": " + text);
  };
  if (!IsPrimitive(node)) {
    if (node.step >= 0) say("has a method and a step");
    return;
  }
  if (!node.children.empty()) say("has children but no method");
  if (node.step < 0 || node.step >= static_cast<int>(plan.steps.size())) {
    return say("has neither a method nor a step of the plan");
  }
  const PlanStep& step = plan.steps[node.step];
  if (step.node != index) say(fmt::format("its step {} belongs to node {}", node.step, step.node));
  if (step.task != node.task) {
    say(fmt::format("its step {} is {}", node.step, ToString(step.task)));
  }
}

void CheckStep(const Plan& plan, int index, std::vector<std::string>* wrong) {
  const PlanStep& step = plan.steps[index];
  const bool has_node = step.node > 0 && step.node < Size(plan.nodes);
  if (has_node && plan.nodes[step.node].step == index) return;
  wrong->push_back(fmt::format("step {} {}: node {} is not its place in the decomposition", index,
                               ToString(step.task), step.node));
}

}  // namespace

std::vector<const TaskItem*> LeavesOf(const TaskNetwork& network) {
  std::vector<const TaskItem*> leaves;
  for (const TaskItem& item : network.items) {
    if (item.network.empty()) {
      leaves.push_back(&item);
      continue;
    }
    const std::vector<const TaskItem*> inner = LeavesOf(item.network.front());
    leaves.insert(leaves.end(), inner.begin(), inner.end());
  }
  return leaves;
}

std::vector<int> NodesFromRoot(const Plan& plan) {
  std::vector<int> order;
  std::vector<int> open = {0};
  while (!open.empty() && order.size() <= plan.nodes.size()) {
    const int node = open.back();
    open.pop_back();
    order.push_back(node);
    const std::vector<int>& children = plan.nodes[node].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return order;
}

std::string NodeText(const Plan& plan, int node) {
  if (node == 0) return "node 0 (the problem)";
  return fmt::format("node {} {}", node, ToString(plan.nodes[node].task));
}

std::vector<std::string> CheckTree(const Plan& plan) {
  if (plan.nodes.empty()) return {"the plan has no decomposition: node 0, the root, is missing"};
  std::vector<std::string> wrong;
  if (plan.nodes[0].parent != -1 || plan.nodes[0].step >= 0 || plan.nodes[0].method >= 0) {
    wrong.push_back("node 0 is the root: it has no parent, no step and no method");
  }
  for (int i = 0; i < Size(plan.nodes); ++i) CheckLinks(plan, i, &wrong);
  for (int i = 1; i < Size(plan.nodes); ++i) CheckLeaf(plan, i, &wrong);
  for (int i = 0; i < static_cast<int>(plan.steps.size()); ++i) CheckStep(plan, i, &wrong);
  if (!wrong.empty()) return wrong;
  std::vector<int> times_seen(plan.nodes.size(), 0);
  for (const int node : NodesFromRoot(plan)) ++times_seen[node];
  for (int i = 0; i < Size(plan.nodes); ++i) {
    if (times_seen[i] == 1) continue;
    wrong.push_back(fmt::format("{}: stands {} times in the tree below the root", NodeText(plan, i),
                                times_seen[i]));
  }
  return wrong;
}

DecompositionCheck::DecompositionCheck(const Domain& domain, const Problem& problem,
                                       const Plan& plan, const FactHistory& facts, bool windowed,
                                       ReferenceProver* prover)
    : domain_(domain),
      problem_(problem),
      plan_(plan),
      facts_(facts),
      windowed_(windowed),
      prover_(*prover),
      order_(NodesFromRoot(plan)),
      spans_(plan.nodes.size()) {}

std::vector<std::string> DecompositionCheck::Run() {
  FindSpans();
  for (const int node : order_) FindReadiness(node);
  for (const int node : order_) {
    try {
      CheckNode(node);
    } catch (const base::ConfigError& error) {
      Report(node, std::string("cannot be checked: ") + error.what());
    }
  }
  return std::move(wrong_);
}

void DecompositionCheck::Report(int node, const std::string& text) {
  wrong_.push_back(NodeText(plan_, node) + ": " + text);
}

void DecompositionCheck::FindSpans() {
  for (auto at = order_.rbegin(); at != order_.rend(); ++at) {
    const PlanNode& node = plan_.nodes[*at];
    Span& span = spans_[*at];
    span.first_step = node.step;
    span.end = node.step >= 0 ? node.step + 1 : -1;
    for (const int child : node.children) {
      const Span& inner = spans_[child];
      if (inner.first_step >= 0 && (span.first_step < 0 || inner.first_step < span.first_step)) {
        span.first_step = inner.first_step;
      }
      span.end = std::max(span.end, inner.end);
    }
    span.begin = span.first_step;
    if (windowed_ || IsPrimitive(node)) continue;
    span.begin = node.at_step;
    span.end = std::max(span.end, node.at_step);
  }
  spans_[0].begin = 0;
}

const TaskNetwork* DecompositionCheck::NetworkOf(int node) const {
  if (node == 0) return &problem_.tasks;
  const PlanNode& plan_node = plan_.nodes[node];
  if (plan_node.method < 0 || plan_node.method >= static_cast<int>(domain_.methods.size())) {
    return nullptr;
  }
  const std::vector<Branch>& branches = domain_.methods[plan_node.method].branches;
  const bool has_branch =
      plan_node.branch >= 0 && plan_node.branch < static_cast<int>(branches.size());
  return has_branch ? &branches[plan_node.branch].subtasks : nullptr;
}

const Precondition& DecompositionCheck::PreconditionOf(int node) const {
  if (node == 0) return problem_.parameters;
  const PlanNode& plan_node = plan_.nodes[node];
  return domain_.methods[plan_node.method].branches[plan_node.branch].precondition;
}

void DecompositionCheck::CheckNode(int node) {
  CheckOrder(node);
  if (domain_.language == Domain::Language::kShop2 && !windowed_) CheckImmediate(node);
  const TaskNetwork* network = NetworkOf(node);
  if (network == nullptr) {
    if (IsPrimitive(plan_.nodes[node])) return;
    return Report(node, fmt::format("method {}, branch {} does not exist in the domain",
                                    plan_.nodes[node].method, plan_.nodes[node].branch));
  }
  if (LeavesOf(*network).size() != plan_.nodes[node].children.size()) {
    return Report(
        node,
        fmt::format("has {} children where its {} asks for {}", plan_.nodes[node].children.size(),
                    node == 0 ? "task network" : "method's branch", LeavesOf(*network).size()));
  }
  if (node == 0) return CheckRoot();
  CheckMethod(node, domain_.methods[plan_.nodes[node].method]);
}

void DecompositionCheck::FindReadiness(int node) {
  const TaskNetwork* network = NetworkOf(node);
  if (network == nullptr) return;
  const std::vector<const TaskItem*> leaves = LeavesOf(*network);
  if (leaves.size() != plan_.nodes[node].children.size()) return;
  const int ready = windowed_ ? spans_[node].ready : std::max(spans_[node].begin, 0);
  Walk(*network, ready, plan_.nodes[node].children, 0);
  MarkImmediate(node, leaves);
}

/// Notes when each task of `network` could begin, if the whole could at `ready`.
/// @return when all of it is done.
int DecompositionCheck::Walk(const TaskNetwork& network, int ready,
                             const std::vector<int>& children, std::size_t first_leaf) {
  std::vector<std::size_t> leaf_of(network.items.size() + 1, first_leaf);
  for (std::size_t i = 0; i < network.items.size(); ++i) {
    leaf_of[i + 1] = leaf_of[i] + CountLeaves(network.items[i]);
  }
  std::vector<int> ready_of(network.items.size(), ready);
  int end_of_all = ready;
  for (const std::size_t i : InOrder(network)) {
    const TaskItem& item = network.items[i];
    int end = ready_of[i];
    if (item.network.empty()) {
      Span& span = spans_[children[leaf_of[i]]];
      span.ready = ready_of[i];
      end = std::max(end, span.end);
    } else {
      end = Walk(item.network.front(), ready_of[i], children, leaf_of[i]);
    }
    end_of_all = std::max(end_of_all, end);
    for (const auto& [before, after] : network.order) {
      if (static_cast<std::size_t>(before) == i) ready_of[after] = std::max(ready_of[after], end);
    }
  }
  return end_of_all;
}

/// Of an immediate task, what comes first is immediate as well.
void DecompositionCheck::MarkImmediate(int node, const std::vector<const TaskItem*>& leaves) {
  const std::vector<int>& children = plan_.nodes[node].children;
  int first = -1;
  for (std::size_t i = 0; i < children.size(); ++i) {
    Span& span = spans_[children[i]];
    span.immediate = leaves[i]->immediate;
    if (first < 0 || span.begin < first) first = span.begin;
  }
  if (!spans_[node].immediate) return;
  for (const int child : children) {
    if (spans_[child].begin == first) spans_[child].immediate = true;
  }
}

void DecompositionCheck::CheckOrder(int node) {
  const Span& span = spans_[node];
  if (span.begin >= 0 && span.begin < span.ready) {
    Report(node, fmt::format("begins after {} steps, before what it has to wait for is done after "
                             "{} steps",
                             span.begin, span.ready));
  }
  if (windowed_ || IsPrimitive(plan_.nodes[node])) return;
  const int moment = plan_.nodes[node].at_step;
  if (moment < 0 || moment > static_cast<int>(plan_.steps.size())) {
    Report(node, fmt::format("was decomposed after {} steps, the plan has {}", moment,
                             plan_.steps.size()));
  } else if (span.first_step >= 0 && moment > span.first_step) {
    Report(node, fmt::format("was decomposed after {} steps, but step {} belongs to it", moment,
                             span.first_step));
  }
}

void DecompositionCheck::CheckImmediate(int node) {
  const Span& span = spans_[node];
  if (!span.immediate) return;
  const int end = std::min(span.begin, static_cast<int>(plan_.steps.size()));
  for (int step = span.ready; step < end; ++step) {
    if (spans_[plan_.steps[step].node].immediate) continue;
    Report(node, fmt::format("is immediate and could go on after {} steps, but step {} {} came "
                             "before it",
                             span.ready, step, ToString(plan_.steps[step].task)));
    return;
  }
}

void DecompositionCheck::ReadRecord(int node, Reading* reading) const {
  for (const auto& [variable, value] : plan_.nodes[node].bindings) {
    reading->fits &= UnifyWithPlan(MakeVariable(variable), value, kThen, &reading->values);
  }
}

void DecompositionCheck::ReadChild(int node, int child, const TaskItem& item, Reading* reading) {
  const Datum wanted = prover_.evaluator().Instantiate(item.task, reading->values);
  if (UnifyWithPlan(wanted, plan_.nodes[child].task, kOfPlan, &reading->values)) return;
  reading->fits = false;
  Report(node, fmt::format("its subtask {} cannot be {} (node {})", ToString(wanted),
                           ToString(plan_.nodes[child].task), child));
}

/// What the variables are by the plan: its record first, then the head, then the children.
DecompositionCheck::Reading DecompositionCheck::Read(int node, const Datum* head,
                                                     const std::vector<const TaskItem*>& leaves) {
  Reading reading;
  ReadRecord(node, &reading);
  const bool fits_head =
      head == nullptr || UnifyWithPlan(*head, plan_.nodes[node].task, kOfPlan, &reading.values);
  if (!reading.fits || !fits_head) {
    Report(node, fmt::format("its task does not fit the method for {} with the recorded bindings",
                             head != nullptr ? ToString(*head) : "the problem"));
    reading.fits = false;
    return reading;
  }
  const std::vector<int>& children = plan_.nodes[node].children;
  for (const bool with_call : {false, true}) {  // a call needs what the others bind
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (HasCall(leaves[i]->task) != with_call) continue;
      ReadChild(node, children[i], *leaves[i], &reading);
    }
  }
  return reading;
}

/// Values for the proof of the precondition. What only the children tell may have been bound later,
/// so it counts only where the plan records nothing.
void DecompositionCheck::Fill(int node, const Datum* head, const Precondition& precondition,
                              Reading* reading) const {
  std::set<std::string> of_head;
  if (head != nullptr) CollectVariables(*head, &of_head);
  std::set<std::string> recorded;
  for (const auto& [variable, value] : plan_.nodes[node].bindings) {
    if (IsGround(value)) recorded.insert(variable);
  }
  for (const std::string& variable : of_head) {
    const Datum value = reading->values.Apply(MakeVariable(variable));
    if (IsGround(value)) reading->known[variable] = value;
  }
  for (const std::string& variable : VariablesOf(precondition.condition)) {
    if (of_head.count(variable) > 0 || (recorded.count(variable) == 0 && !windowed_)) continue;
    const Datum value = reading->values.Apply(MakeVariable(variable));
    if (IsGround(value)) reading->expected[variable] = value;
  }
}

void DecompositionCheck::CheckMethod(int node, const Method& method) {
  const Branch& branch = method.branches[plan_.nodes[node].branch];
  Reading reading = Read(node, &method.head, LeavesOf(branch.subtasks));
  if (!reading.fits) return;
  Fill(node, &method.head, branch.precondition, &reading);
  CheckPrecondition(node, branch, reading);
  if (domain_.language == Domain::Language::kShop2 && !windowed_) {
    CheckEarlierBranches(node, method, reading);
  }
}

void DecompositionCheck::CheckRoot() {
  Reading reading = Read(0, nullptr, LeavesOf(problem_.tasks));
  if (!reading.fits) return;
  for (const std::string& variable : VariablesOf(problem_.parameters.condition)) {
    const Datum value = reading.values.Apply(MakeVariable(variable));
    if (IsGround(value)) reading.expected[variable] = value;
  }
  if (Holds(problem_.parameters, 0, reading.known, reading.expected)) return;
  Report(0, "what the problem asks of its parameters does not hold");
}

bool DecompositionCheck::Holds(const Precondition& precondition, int moment, const ValueMap& known,
                               const ValueMap& expected) {
  const Formula& condition = precondition.condition;
  if (condition.kind == Formula::Kind::kSequence && condition.parts.empty()) return true;
  return prover_.Holds({precondition.condition, facts_, moment, known, expected});
}

void DecompositionCheck::CheckPrecondition(int node, const Branch& branch, const Reading& reading) {
  const Span& span = spans_[node];
  int first = plan_.nodes[node].at_step;
  int last = first;
  if (windowed_) {
    first = span.ready;
    last = span.first_step >= 0 ? span.first_step : static_cast<int>(plan_.steps.size());
  }
  for (int moment = first; moment <= last; ++moment) {
    if (Holds(branch.precondition, moment, reading.known, reading.expected)) return;
  }
  const std::string when = first == last ? fmt::format("after {} steps", first)
                                         : fmt::format("after any of {} to {} steps", first, last);
  Report(node, fmt::format("{}the precondition of branch {} of its method does not hold {}",
                           At(domain_.source, branch.place), plan_.nodes[node].branch + 1, when));
}

/// The subtask of `parent` at `place` with what was known of the parent's task and what the
/// precondition bound; nothing that was bound later.
Datum DecompositionCheck::SubtaskAsItCame(int parent, const Datum& task_of_parent,
                                          std::size_t place) {
  const TaskNetwork* network = NetworkOf(parent);
  const std::vector<const TaskItem*> leaves = LeavesOf(*network);
  const Datum& last_known = plan_.nodes[plan_.nodes[parent].children[place]].task;
  if (leaves.size() != plan_.nodes[parent].children.size()) return last_known;
  if (HasCall(leaves[place]->task)) return last_known;
  Substitution values;
  if (parent != 0) values.Unify(domain_.methods[plan_.nodes[parent].method].head, task_of_parent);
  const std::set<std::string> bound = VariablesBoundBy(PreconditionOf(parent).condition);
  for (const auto& [variable, value] : plan_.nodes[parent].bindings) {
    if (bound.count(variable) > 0) values.Unify(MakeVariable(variable), value);
  }
  return RenameVariables(values.Apply(leaves[place]->task), fmt::format("@{}", parent));
}

/// A task with the variables that were open when it came up, before its method bound any.
Datum DecompositionCheck::TaskAsItCame(int node) {
  std::vector<int> path;
  for (int at = node; at > 0; at = plan_.nodes[at].parent) path.push_back(at);
  Datum task;
  for (auto at = path.rbegin(); at != path.rend(); ++at) {
    const int parent = plan_.nodes[*at].parent;
    if (NetworkOf(parent) == nullptr) return plan_.nodes[node].task;
    const std::vector<int>& siblings = plan_.nodes[parent].children;
    const auto place = std::find(siblings.begin(), siblings.end(), *at) - siblings.begin();
    task = SubtaskAsItCame(parent, task, static_cast<std::size_t>(place));
  }
  return task;
}

ValueMap DecompositionCheck::HeadAsItCame(int node, const Method& method, const ValueMap& known) {
  const Datum task = TaskAsItCame(node);
  if (IsGround(task)) return known;
  Substitution values;
  values.Unify(method.head, task);
  ValueMap result;
  for (const auto& [variable, value] : known) {
    result[variable] = values.Apply(MakeVariable(variable));
  }
  return result;
}

void DecompositionCheck::CheckEarlierBranches(int node, const Method& method,
                                              const Reading& reading) {
  const int moment = plan_.nodes[node].at_step;
  for (int i = 0; i < plan_.nodes[node].branch; ++i) {
    const Precondition& precondition = method.branches[i].precondition;
    if (!Holds(precondition, moment, reading.known, {})) continue;
    // A variable of the task may have been unbound then; only what holds both ways is certain.
    if (!Holds(precondition, moment, HeadAsItCame(node, method, reading.known), {})) continue;
    Report(node, fmt::format("{}branch {} of its method holds after {} steps, so branch {} must "
                             "not be used",
                             At(domain_.source, method.branches[i].place), i + 1, moment,
                             plan_.nodes[node].branch + 1));
    return;
  }
}

}  // namespace hires::planning
