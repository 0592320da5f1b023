#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hires/planning/datum.h"
#include "hires/planning/domain.h"

namespace hires::test_support {

/// What an exhaustive enumeration of a small planning problem gives.
struct BruteForceResult {
  std::map<std::string, int> plans;  ///< "(!a x) (!b y)" -> number of plans with these steps
  std::multiset<double> costs;       ///< one for each plan
  bool complete{true};               ///< false: gave up, there are more
  int num_plans() const;
};

/// Plans a small problem by trying everything, straight from the definition of SHOP2 and as simply
/// as possible: states, tasks and bindings are copied at every step. The slow road to which the
/// search is compared.
///
/// Its choices are which ready task comes next, which method, which binding of its precondition.
/// Tasks that are decomposed go on at once with one of their first subtasks, so that an
/// interleaving of primitive steps is found once and not for every moment at which its tasks might
/// have been decomposed. A plan is a sequence of steps with its decomposition: the same steps of
/// other subtasks or by other branches are another plan; when it turned out that a task needs no
/// step makes no difference.
///
/// In an HDDL domain nothing goes on at once: a task may be decomposed at any moment at which it is
/// ready.
///
/// Knows the formulas sequence, and, not, imply, forall and atom (with flat terms), the effects
/// atom and protection, all task networks; std::logic_error for others.
class BruteForce {
 public:
  /// @param max_nodes  Gives up after so many tasks decomposed or applied.
  BruteForce(const planning::Domain& domain, const planning::Problem& problem, int max_nodes);

  BruteForceResult Run();

 private:
  using Datum = planning::Datum;
  using Bindings = std::map<std::string, Datum>;

  struct State {
    std::vector<Datum> facts;  ///< oldest first
    std::vector<Datum> protections;
  };
  struct Task {
    Datum task;
    bool immediate{false};
    std::string path;     ///< place in the decomposition: "/1/0" is the first item of the second
    std::set<int> after;  ///< tasks that must be finished before
  };
  struct TreeNode {
    Datum task;
    std::string how;  ///< method and branch
  };
  struct Node {
    State state;
    std::map<int, Task> tasks;  ///< all that is left to do
    std::vector<int> ready;     ///< those that wait for nothing, in the order they became so
    std::map<std::string, TreeNode> tree;
    std::string steps;
    std::string paths;  ///< of the steps
    double cost{0.0};
  };

  static Datum Substitute(const Datum& datum, const Bindings& bindings);
  static bool Unify(const Datum& a, const Datum& b, Bindings* bindings);
  static Datum Rename(Datum datum, int number);
  static Datum WithoutNumbers(Datum datum);
  static planning::Formula Rename(planning::Formula formula, int number);
  static std::vector<Bindings> Prove(const planning::Formula& formula, const State& state,
                                     const Bindings& bindings);
  static std::vector<Bindings> ProveAll(const std::vector<planning::Formula>& parts,
                                        std::size_t from, const State& state,
                                        const Bindings& bindings);
  static std::vector<Bindings> ProveAtom(const Datum& atom, const State& state,
                                         const Bindings& bindings);
  static bool HoldsForAll(const planning::Formula& forall, const State& state,
                          const Bindings& bindings);

  static std::vector<int> Flatten(const planning::TaskNetwork& network, const std::string& path,
                                  std::vector<Task>* leaves);
  static void Order(const planning::TaskNetwork& network, const std::vector<std::vector<int>>& of,
                    std::vector<Task>* leaves);
  std::vector<std::vector<Task>> ForceImmediate(const std::vector<Task>& leaves) const;
  static void Finish(int id, Node* node);
  static void BindTasks(const Bindings& bindings, Node* node);
  static bool ChangeState(const planning::Operator& op, const Bindings& bindings, State* state);

  void Visit(const Node& node);
  void Note(const Node& node);
  void Try(const Node& node, int id);
  void Apply(const Node& node, int id, const planning::Operator& op);
  void Decompose(const Node& node, int id, const planning::Method& method);
  void Replace(Node node, int id, const std::vector<Task>& leaves);

  const planning::Domain& domain_;
  const planning::Problem& problem_;
  const int max_nodes_;
  int nodes_{0};
  int next_number_{0};  ///< of variables and tasks
  std::set<std::string> seen_;
  BruteForceResult result_;
};

inline int BruteForceResult::num_plans() const {
  int sum = 0;
  for (const auto& plan : plans) sum += plan.second;
  return sum;
}

// ---------------------------------------------------------------------------- terms and formulas

inline planning::Datum BruteForce::Substitute(const Datum& datum, const Bindings& bindings) {
  if (datum.kind == Datum::Kind::kVariable) {
    const auto found = bindings.find(datum.text);
    return found == bindings.end() ? datum : Substitute(found->second, bindings);
  }
  Datum result = datum;
  for (Datum& item : result.items) item = Substitute(item, bindings);
  return result;
}

inline bool BruteForce::Unify(const Datum& a, const Datum& b, Bindings* bindings) {
  const Datum left = Substitute(a, *bindings);
  const Datum right = Substitute(b, *bindings);
  if (left == right) return true;
  if (left.kind == Datum::Kind::kVariable) return bindings->emplace(left.text, right).second;
  if (right.kind == Datum::Kind::kVariable) return bindings->emplace(right.text, left).second;
  if (!left.IsList() || !right.IsList() || left.items.size() != right.items.size()) return false;
  for (std::size_t i = 0; i < left.items.size(); ++i) {
    if (!Unify(left.items[i], right.items[i], bindings)) return false;
  }
  return true;
}

/// Gives the variables of one use of an operator or a method names of their own.
inline planning::Datum BruteForce::Rename(Datum datum, int number) {
  if (datum.kind == Datum::Kind::kVariable) datum.text += "~" + std::to_string(number);
  for (Datum& item : datum.items) item = Rename(item, number);
  return datum;
}

/// Undoes Rename for variables that nothing was bound to.
inline planning::Datum BruteForce::WithoutNumbers(Datum datum) {
  if (datum.kind == Datum::Kind::kVariable) datum.text.resize(datum.text.find('~'));
  for (Datum& item : datum.items) item = WithoutNumbers(item);
  return datum;
}

inline planning::Formula BruteForce::Rename(planning::Formula formula, int number) {
  formula.term = Rename(formula.term, number);
  for (planning::Formula& part : formula.parts) part = Rename(part, number);
  return formula;
}

/// All bindings, those with the newest facts first.
inline std::vector<BruteForce::Bindings> BruteForce::Prove(const planning::Formula& formula,
                                                           const State& state,
                                                           const Bindings& bindings) {
  using Kind = planning::Formula::Kind;
  const auto if_true = [&bindings](bool value) {
    return value ? std::vector<Bindings>{bindings} : std::vector<Bindings>{};
  };
  const auto holds = [&](const planning::Formula& part) {
    return !Prove(part, state, bindings).empty();
  };
  switch (formula.kind) {
    case Kind::kSequence:
    case Kind::kAnd:
      return ProveAll(formula.parts, 0, state, bindings);
    case Kind::kNot:
      return if_true(!holds(formula.parts[0]));
    case Kind::kImply:
      return if_true(!holds(formula.parts[0]) || holds(formula.parts[1]));
    case Kind::kForall:
      return if_true(HoldsForAll(formula, state, bindings));
    case Kind::kAtom:
      return ProveAtom(formula.term, state, bindings);
    default:
      throw std::logic_error("BruteForce does not know this kind of formula");
  }
}

inline std::vector<BruteForce::Bindings> BruteForce::ProveAll(
    const std::vector<planning::Formula>& parts, std::size_t from, const State& state,
    const Bindings& bindings) {
  if (from == parts.size()) return {bindings};
  std::vector<Bindings> all;
  for (const Bindings& first : Prove(parts[from], state, bindings)) {
    const std::vector<Bindings> rest = ProveAll(parts, from + 1, state, first);
    all.insert(all.end(), rest.begin(), rest.end());
  }
  return all;
}

inline std::vector<BruteForce::Bindings> BruteForce::ProveAtom(const Datum& atom,
                                                               const State& state,
                                                               const Bindings& bindings) {
  std::vector<Bindings> all;
  for (auto fact = state.facts.rbegin(); fact != state.facts.rend(); ++fact) {
    Bindings extended = bindings;
    if (Unify(atom, *fact, &extended)) all.push_back(extended);
  }
  return all;
}

inline bool BruteForce::HoldsForAll(const planning::Formula& forall, const State& state,
                                    const Bindings& bindings) {
  const std::vector<Bindings> all = Prove(forall.parts[0], state, bindings);
  return std::all_of(all.begin(), all.end(), [&](const Bindings& each) {
    return !Prove(forall.parts[1], state, each).empty();
  });
}

// ------------------------------------------------------------------------------- task networks

/// Appends the tasks of a network, nested ones included, and gives their indices.
inline std::vector<int> BruteForce::Flatten(const planning::TaskNetwork& network,
                                            const std::string& path, std::vector<Task>* leaves) {
  std::vector<std::vector<int>> of;  // leaves of each item
  std::vector<int> all;
  for (const planning::TaskItem& item : network.items) {
    const std::string here = path + "/" + std::to_string(of.size());
    if (item.network.empty()) {
      of.push_back({static_cast<int>(leaves->size())});
      leaves->push_back({item.task, item.immediate, here, {}});
    } else {
      of.push_back(Flatten(item.network[0], here, leaves));
    }
    all.insert(all.end(), of.back().begin(), of.back().end());
  }
  Order(network, of, leaves);
  return all;
}

inline void BruteForce::Order(const planning::TaskNetwork& network,
                              const std::vector<std::vector<int>>& of, std::vector<Task>* leaves) {
  std::set<std::pair<int, int>> before(network.order.begin(), network.order.end());
  const int size = static_cast<int>(of.size());
  for (int via = 0; via < size; ++via) {  // the order is transitive, over empty items too
    for (int a = 0; a < size; ++a) {
      for (int b = 0; b < size; ++b) {
        if (before.count({a, via}) && before.count({via, b})) before.emplace(a, b);
      }
    }
  }
  for (const auto& [a, b] : before) {
    for (const int leaf : of[b]) (*leaves)[leaf].after.insert(of[a].begin(), of[a].end());
  }
}

/// The reductions with one first task made immediate, one for each that could be; or the reduction
/// as it is where a first task is immediate already.
inline std::vector<std::vector<BruteForce::Task>> BruteForce::ForceImmediate(
    const std::vector<Task>& leaves) const {
  if (domain_.language == planning::Domain::Language::kHddl) return {leaves};
  std::vector<std::vector<Task>> all;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (!leaves[i].after.empty()) continue;
    if (leaves[i].immediate) return {leaves};
    all.push_back(leaves);
    all.back()[i].immediate = true;
  }
  if (all.empty()) all.push_back(leaves);  // nothing to do
  return all;
}

/// Task `id` is done: those that waited for nothing else get ready.
inline void BruteForce::Finish(int id, Node* node) {
  node->tasks.erase(id);
  node->ready.erase(std::remove(node->ready.begin(), node->ready.end(), id), node->ready.end());
  for (auto& [other, task] : node->tasks) {
    if (task.after.erase(id) != 0 && task.after.empty()) node->ready.push_back(other);
  }
}

inline void BruteForce::BindTasks(const Bindings& bindings, Node* node) {
  for (auto& entry : node->tasks) entry.second.task = Substitute(entry.second.task, bindings);
  for (auto& entry : node->tree) entry.second.task = Substitute(entry.second.task, bindings);
}

/// The tasks of a reduction take the place of task `id`.
inline void BruteForce::Replace(Node node, int id, const std::vector<Task>& leaves) {
  const int first = next_number_;
  next_number_ += static_cast<int>(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    Task task{leaves[i].task, leaves[i].immediate, leaves[i].path, {}};
    for (const int before : leaves[i].after) task.after.insert(first + before);
    for (auto& [other, waiting] : node.tasks) {
      if (waiting.after.count(id)) waiting.after.insert(first + static_cast<int>(i));
    }
    node.tasks.emplace(first + static_cast<int>(i), task);
    node.tree[task.path].task = task.task;
  }
  Finish(id, &node);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (leaves[i].after.empty()) node.ready.push_back(first + static_cast<int>(i));
  }
  Visit(node);
}

// -------------------------------------------------------------------------------------- search

inline BruteForce::BruteForce(const planning::Domain& domain, const planning::Problem& problem,
                              int max_nodes)
    : domain_(domain), problem_(problem), max_nodes_(max_nodes) {}

inline BruteForceResult BruteForce::Run() {
  Node root;
  for (const Datum& fact : problem_.facts) {
    auto& facts = root.state.facts;
    if (std::find(facts.begin(), facts.end(), fact) == facts.end()) facts.push_back(fact);
  }
  std::vector<Task> leaves;
  Flatten(problem_.tasks, "", &leaves);
  for (const Task& leaf : leaves) {
    root.tree[leaf.path].task = leaf.task;
    if (leaf.after.empty()) root.ready.push_back(next_number_);
    root.tasks.emplace(next_number_++, leaf);
  }
  Visit(root);
  return result_;
}

inline void BruteForce::Visit(const Node& node) {
  if (++nodes_ > max_nodes_) result_.complete = false;
  if (!result_.complete) return;
  if (node.ready.empty()) return Note(node);
  for (const int id : node.ready) {
    if (node.tasks.at(id).immediate) return Try(node, id);
  }
  for (const int id : node.ready) Try(node, id);
}

inline void BruteForce::Note(const Node& node) {
  std::string key = node.paths;
  for (const auto& [path, entry] : node.tree) {
    key += path + " " + ToString(WithoutNumbers(entry.task)) + " " + entry.how + "\n";
  }
  if (!seen_.insert(key).second) return;
  ++result_.plans[node.steps];
  result_.costs.insert(node.cost);
}

inline void BruteForce::Try(const Node& node, int id) {
  const std::string name(node.tasks.at(id).task.Head());
  for (const planning::Operator& op : domain_.operators) {
    if (op.head.Head() == name) Apply(node, id, op);
  }
  for (const planning::Method& method : domain_.methods) {
    if (method.head.Head() == name) Decompose(node, id, method);
  }
}

inline void BruteForce::Apply(const Node& node, int id, const planning::Operator& op) {
  const int number = next_number_++;
  Bindings head;
  if (!Unify(Rename(op.head, number), node.tasks.at(id).task, &head)) return;
  const std::vector<Bindings> all =
      Prove(Rename(op.precondition.condition, number), node.state, head);
  if (all.empty()) return;
  Bindings bindings = all.front();
  planning::Operator renamed = op;
  for (planning::Effect& effect : renamed.deletes) effect.term = Rename(effect.term, number);
  for (planning::Effect& effect : renamed.adds) effect.term = Rename(effect.term, number);
  Node next = node;
  if (!ChangeState(renamed, bindings, &next.state)) return;
  const Datum step = Substitute(node.tasks.at(id).task, bindings);
  next.paths += node.tasks.at(id).path + "\n";
  next.steps += (next.steps.empty() ? "" : " ") + ToString(step);
  next.cost +=
      op.cost.kind == Datum::Kind::kReal ? op.cost.real : static_cast<double>(op.cost.integer);
  Finish(id, &next);
  BindTasks(bindings, &next);
  Visit(next);
}

/// False where a protected atom would be lost.
inline bool BruteForce::ChangeState(const planning::Operator& op, const Bindings& bindings,
                                    State* state) {
  using Kind = planning::Effect::Kind;
  const auto erase = [](std::vector<Datum>* from, const Datum& atom) {
    const auto found = std::find(from->begin(), from->end(), atom);
    if (found != from->end()) from->erase(found);
  };
  for (const planning::Effect& effect : op.deletes) {
    erase(effect.kind == Kind::kProtection ? &state->protections : &state->facts,
          Substitute(effect.term, bindings));
  }
  std::vector<Datum> protections;  // come into force when all is done
  for (auto effect = op.adds.rbegin(); effect != op.adds.rend(); ++effect) {
    const Datum atom = Substitute(effect->term, bindings);
    if (effect->kind == Kind::kProtection) {
      protections.push_back(atom);
    } else if (std::find(state->facts.begin(), state->facts.end(), atom) == state->facts.end()) {
      state->facts.push_back(atom);
    }
  }
  for (const Datum& atom : state->protections) {
    if (ProveAtom(atom, *state, {}).empty()) return false;
  }
  state->protections.insert(state->protections.end(), protections.begin(), protections.end());
  return true;
}

inline void BruteForce::Decompose(const Node& node, int id, const planning::Method& method) {
  const int number = next_number_++;
  Bindings head;
  if (!Unify(Rename(method.head, number), node.tasks.at(id).task, &head)) return;
  const std::string path = node.tasks.at(id).path;
  for (const planning::Branch& branch : method.branches) {
    const std::vector<Bindings> all =
        Prove(Rename(branch.precondition.condition, number), node.state, head);
    if (all.empty()) continue;
    const bool first_only = branch.precondition.order == planning::Precondition::Order::kFirst;
    std::set<std::string> seen;  // bindings that lead to the same task and subtasks are one
    for (std::size_t i = 0; i < (first_only ? 1 : all.size()); ++i) {
      std::vector<Task> leaves;
      Flatten(branch.subtasks, path, &leaves);
      std::string key = ToString(Substitute(node.tasks.at(id).task, all[i]));
      for (Task& leaf : leaves) {
        leaf.task = Substitute(Rename(leaf.task, number), all[i]);
        key += ToString(leaf.task);
      }
      if (!seen.insert(key).second) continue;
      Node next = node;
      BindTasks(all[i], &next);
      next.tree.at(path).how = std::to_string(&method - domain_.methods.data()) + "." +
                               std::to_string(&branch - method.branches.data());
      for (const std::vector<Task>& reduction : ForceImmediate(leaves)) {
        Replace(next, id, reduction);
      }
    }
    return;  // if-then-else
  }
}

/// All plans of a problem; see BruteForce.
inline BruteForceResult PlanByBruteForce(const planning::Domain& domain,
                                         const planning::Problem& problem, int max_nodes = 5'000) {
  return BruteForce(domain, problem, max_nodes).Run();
}

}  // namespace hires::test_support
