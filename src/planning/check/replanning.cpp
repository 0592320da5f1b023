#include "hires/planning/replanning.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "hires/base/check.h"
#include "hires/planning/step_replay.h"
#include "planning/check/decomposition_check.h"

namespace hires::planning {
namespace {

/// How far each task of a plan is after some steps.
class Advance {
 public:
  Advance(const Plan& plan, int executed)
      : begun_(plan.nodes.size(), false), finished_(plan.nodes.size(), false) {
    const std::vector<int> order = NodesFromRoot(plan);
    for (auto at = order.rbegin(); at != order.rend(); ++at) Look(plan, executed, *at);
  }

  bool IsBegun(int node) const { return begun_[node]; }
  bool IsFinished(int node) const { return finished_[node]; }

 private:
  void Look(const Plan& plan, int executed, int index) {
    const PlanNode& node = plan.nodes[index];
    if (node.method < 0 && index != 0) {
      begun_[index] = finished_[index] = node.step < executed;
      return;
    }
    finished_[index] = !node.children.empty() || node.at_step < executed;
    for (const int child : node.children) {
      finished_[index] = finished_[index] && finished_[child];
      begun_[index] = begun_[index] || begun_[child];
    }
  }

  std::vector<bool> begun_;
  std::vector<bool> finished_;
};

std::string OfNode(int node) { return '%' + std::to_string(node); }

/// The order between those items that are kept, by their new places; also what only followed by way
/// of items that are gone.
std::vector<std::pair<int, int>> OrderOfKept(const TaskNetwork& network,
                                             const std::vector<int>& new_place) {
  std::set<std::pair<int, int>> order;
  for (std::size_t first = 0; first < new_place.size(); ++first) {
    if (new_place[first] < 0) continue;
    std::vector<int> open = {static_cast<int>(first)};
    std::set<int> seen;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      for (const auto& [before, after] : network.order) {
        if (before != at || !seen.insert(after).second) continue;
        if (new_place[after] < 0) open.push_back(after);
        if (new_place[after] >= 0) order.emplace(new_place[first], new_place[after]);
      }
    }
  }
  return {order.begin(), order.end()};
}

/// Cuts the decomposition of a plan down to what is left.
class RemainingTasks {
 public:
  RemainingTasks(const Domain& domain, const Problem& problem, const Plan& plan, int executed,
                 int keep_depth)
      : domain_(domain),
        problem_(problem),
        plan_(plan),
        advance_(plan, executed),
        keep_depth_(keep_depth) {}

  TaskNetwork Build() { return RestOf(0, Datum(), problem_.tasks, 0); }

  /// Begun tasks that stand as tasks again.
  const std::set<int>& again() const { return again_; }

 private:
  /// What is left of the network of `task`, read with the values that are known by now.
  TaskNetwork RestOf(int node, const Datum& task, const TaskNetwork& network, int depth) {
    const Substitution values = ValuesOf(node, task, network);
    std::size_t leaf = 0;
    return RestOf(node, network, depth, values, &leaf);
  }

  TaskNetwork RestOf(int node, const TaskNetwork& network, int depth, const Substitution& values,
                     std::size_t* leaf) {
    TaskNetwork rest;
    std::vector<int> new_place(network.items.size(), -1);
    for (std::size_t i = 0; i < network.items.size(); ++i) {
      std::optional<TaskItem> item = RestOf(node, network.items[i], depth, values, leaf);
      if (!item) continue;
      new_place[i] = static_cast<int>(rest.items.size());
      rest.items.push_back(std::move(*item));
    }
    if (rest.items.size() == 1 && !rest.items.front().network.empty()) {
      return TaskNetwork(std::move(rest.items.front().network.front()));
    }
    rest.order = OrderOfKept(network, new_place);
    return rest;
  }

  std::optional<TaskItem> RestOf(int node, const TaskItem& item, int depth,
                                 const Substitution& values, std::size_t* leaf) {
    if (!item.network.empty()) {
      return AsItem(RestOf(node, item.network.front(), depth, values, leaf), item.immediate);
    }
    const int child = plan_.nodes[node].children.at((*leaf)++);
    if (advance_.IsFinished(child)) return std::nullopt;
    TaskItem task = item;
    task.task = TaskOf(node, child, item, values);
    if (!advance_.IsBegun(child)) return task;
    if (depth + 1 <= keep_depth_) {
      return AsItem(RestOf(child, task.task, NetworkOf(child), depth + 1), false);
    }
    again_.insert(child);
    return task;
  }

  /// A network of one item is that item.
  static std::optional<TaskItem> AsItem(TaskNetwork network, bool immediate) {
    if (network.items.empty()) return std::nullopt;
    if (network.items.size() == 1) {
      TaskItem only = std::move(network.items.front());
      only.immediate |= immediate;
      return only;
    }
    TaskItem item;
    item.immediate = immediate;
    item.network.push_back(std::move(network));
    return item;
  }

  const TaskNetwork& NetworkOf(int node) const {
    const PlanNode& plan_node = plan_.nodes[node];
    return domain_.methods.at(plan_node.method).branches.at(plan_node.branch).subtasks;
  }

  /// By what the precondition bound when the task was decomposed, and by what was done since.
  Substitution ValuesOf(int node, const Datum& task, const TaskNetwork& network) const {
    Substitution values;
    if (node != 0) values.Unify(domain_.methods[plan_.nodes[node].method].head, task);
    const std::set<std::string> bound = VariablesBoundBy(PreconditionOf(node).condition);
    for (const auto& [variable, value] : plan_.nodes[node].bindings) {
      if (bound.count(variable) == 0) continue;
      values.Unify(MakeVariable(variable), RenameVariables(value, OfNode(node)));
    }
    const std::vector<const TaskItem*> leaves = LeavesOf(network);
    const std::vector<int>& children = plan_.nodes[node].children;
    HIRES_CHECK(leaves.size() == children.size(),
                NodeText(plan_, node) + " does not fit its method");
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (!advance_.IsBegun(children[i]) || HasCall(leaves[i]->task)) continue;
      values.Unify(leaves[i]->task, RenameVariables(plan_.nodes[children[i]].task, OfNode(node)));
    }
    return values;
  }

  /// A value that the precondition should have found, but that is not recorded, is taken from the
  /// plan; others are open.
  Datum TaskOf(int node, int child, const TaskItem& item, const Substitution& values) const {
    const Datum& last_known = plan_.nodes[child].task;
    if (HasCall(item.task)) return last_known;
    const Datum task = values.Apply(RenameOpen(item.task, values, OfNode(node)));
    std::set<std::string> variables;
    CollectVariables(item.task, &variables);
    const std::set<std::string> found = VariablesBoundBy(PreconditionOf(node).condition);
    const bool lacks_record =
        std::any_of(variables.begin(), variables.end(), [&](const std::string& variable) {
          return !values.IsBound(variable) && found.count(variable) > 0;
        });
    return lacks_record ? last_known : task;
  }

  const Precondition& PreconditionOf(int node) const {
    if (node == 0) return problem_.parameters;
    const PlanNode& plan_node = plan_.nodes[node];
    return domain_.methods.at(plan_node.method).branches.at(plan_node.branch).precondition;
  }

  /// Variables of different methods stand side by side now: those that are open get names by node.
  static Datum RenameOpen(const Datum& task, const Substitution& values,
                          const std::string& suffix) {
    Datum renamed = task;
    if (task.kind == Datum::Kind::kVariable && !values.IsBound(task.text)) renamed.text += suffix;
    for (Datum& item : renamed.items) item = RenameOpen(item, values, suffix);
    for (Datum& tail : renamed.tail) tail = RenameOpen(tail, values, suffix);
    return renamed;
  }

  const Domain& domain_;
  const Problem& problem_;
  const Plan& plan_;
  Advance advance_;
  int keep_depth_;
  std::set<int> again_;
};

bool IsBelow(const Plan& plan, int node, const std::set<int>& tops) {
  for (; node >= 0; node = plan.nodes[node].parent) {
    if (tops.count(node) > 0) return true;
  }
  return false;
}

/// Protections that are left when the executed steps that are not `again` to be done have been.
std::vector<Datum> OpenProtections(const Domain& domain, const Problem& problem, const Plan& plan,
                                   int executed, const std::set<int>& again,
                                   const Functions& functions) {
  StepReplay replay(domain, problem, functions, false);
  std::vector<Datum> open = problem.protections;
  for (int i = 0; i < executed; ++i) {
    const ReplayedStep taken = replay.Take(plan.steps[i]);
    if (IsBelow(plan, plan.steps[i].node, again)) continue;
    for (const Datum& atom : taken.unprotects) {
      const auto found = std::find(open.begin(), open.end(), atom);
      if (found != open.end()) open.erase(found);
    }
    open.insert(open.end(), taken.protects.begin(), taken.protects.end());
  }
  return open;
}

std::vector<Datum> ThoseThatHold(const std::vector<Datum>& atoms, const Domain& domain,
                                 const Problem& problem, const Functions& functions) {
  StepReplay now(domain, problem, functions, false);
  std::vector<Datum> holding;
  for (const Datum& atom : atoms) {
    const Formula formula = MakeAtom(atom);
    if (now.prover().Holds({formula, now.facts(), 0})) holding.push_back(atom);
  }
  return holding;
}

bool AreSame(const TaskNetwork& a, const TaskNetwork& b);

bool AreSame(const TaskItem& a, const TaskItem& b) {
  return a.task == b.task && a.immediate == b.immediate && a.network.size() == b.network.size() &&
         (a.network.empty() || AreSame(a.network.front(), b.network.front()));
}

bool AreSame(const TaskNetwork& a, const TaskNetwork& b) {
  return a.order == b.order &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(),
                    [](const TaskItem& x, const TaskItem& y) { return AreSame(x, y); });
}

bool AreSame(const Problem& a, const Problem& b) {
  return a.protections == b.protections &&
         a.parameters.condition.parts.size() == b.parameters.condition.parts.size() &&
         AreSame(a.tasks, b.tasks);
}

bool EndsAll(PlanOutcome outcome) {
  return outcome == PlanOutcome::kFound || outcome == PlanOutcome::kLimitTime ||
         outcome == PlanOutcome::kLimitMemory || outcome == PlanOutcome::kCancelled;
}

/// Adds an earlier try that found nothing to the one after it.
void AddEarlier(const PlanResult& earlier, std::size_t max_trace, PlanResult* result) {
  result->progress.expansions += earlier.progress.expansions;
  result->progress.inferences += earlier.progress.inferences;
  result->progress.bytes = std::max(result->progress.bytes, earlier.progress.bytes);
  result->exhausted = result->exhausted && earlier.exhausted;
  if (result->outcome == PlanOutcome::kNoPlan) result->outcome = earlier.outcome;
  result->trace.insert(result->trace.begin(), earlier.trace.begin(), earlier.trace.end());
  if (result->trace.size() <= max_trace) return;
  const auto too_many = static_cast<std::ptrdiff_t>(result->trace.size() - max_trace);
  result->trace.erase(result->trace.begin(), result->trace.begin() + too_many);
}

int DepthOf(const Plan& plan, int node) {
  int depth = 0;
  for (; plan.nodes[node].parent >= 0; node = plan.nodes[node].parent) ++depth;
  return depth;
}

void CheckExecuted(const Plan& plan, int executed) {
  HIRES_CHECK(0 <= executed && executed <= static_cast<int>(plan.steps.size()),
              "the plan has no " + std::to_string(executed) + " steps");
  HIRES_CHECK(!plan.nodes.empty(), "the plan has no decomposition");
}

}  // namespace

Problem RemainingProblem(const Domain& domain, const Problem& problem, const Plan& plan,
                         int executed, std::vector<Datum> facts, int keep_depth,
                         const Functions& functions) {
  CheckExecuted(plan, executed);
  HIRES_CHECK(keep_depth >= 0, "keep_depth is negative");
  Problem rest = problem;
  rest.facts = std::move(facts);
  if (keep_depth == 0) return rest;
  RemainingTasks remainder(domain, problem, plan, executed, keep_depth);
  rest.tasks = remainder.Build();
  rest.parameters = Precondition();
  rest.protections =
      ThoseThatHold(OpenProtections(domain, problem, plan, executed, remainder.again(), functions),
                    domain, rest, functions);
  return rest;
}

int DeepestKeepDepth(const Plan& plan, int executed) {
  CheckExecuted(plan, executed);
  const Advance advance(plan, executed);
  int deepest = 1;
  for (int i = 1; i < static_cast<int>(plan.nodes.size()); ++i) {
    if (!advance.IsBegun(i) || advance.IsFinished(i)) continue;
    deepest = std::max(deepest, DepthOf(plan, i));
  }
  return deepest;
}

Replanned Replan(const Domain& domain, const Problem& problem, const Plan& plan, int executed,
                 const std::vector<Datum>& facts, const PlanRequest& request,
                 const Functions& functions) {
  std::optional<Replanned> last;
  for (int depth = DeepestKeepDepth(plan, executed); depth >= 0; --depth) {
    Replanned next;
    next.kept_depth = depth;
    next.problem = RemainingProblem(domain, problem, plan, executed, facts, depth, functions);
    if (last && AreSame(last->problem, next.problem)) continue;
    next.result = FindPlans(domain, next.problem, request, functions);
    if (last) AddEarlier(last->result, request.max_trace, &next.result);
    last = std::move(next);
    if (EndsAll(last->result.outcome)) break;
  }
  return std::move(*last);
}

}  // namespace hires::planning
