#include "planning/search/decomposer.h"

#include <algorithm>

namespace hires::planning {

Decomposer::Decomposer(const Program& program, bool loop_check, SearchPath* path,
                       const SearchLimits* limits, Explored* explored, SearchTrace* trace)
    : program_(program),
      loop_check_(loop_check),
      path_(*path),
      limits_(*limits),
      explored_(*explored),
      trace_(*trace) {}

MethodChoice Decomposer::Begin(std::uint32_t node,
                               const std::vector<const CompiledMethod*>& methods) {
  MethodChoice choice{path_.Now(), node, &methods};
  choice.method = NextFitting(choice, 0);
  if (choice.method >= methods.size() && trace_.active()) {
    trace_.Note(path_.Task(node), "", "its arguments fit the head of no method");
  }
  return choice;
}

bool Decomposer::Next(MethodChoice* choice) {
  for (;;) {
    if (choice->num_variants > choice->variant + 1) {
      if (NextVariant(choice)) return true;
      continue;
    }
    choice->num_variants = choice->variant = 0;
    if (NextBinding(choice) || NextMethod(choice)) {
      if (UseSolution(choice)) return true;
    } else if (limits_.stopped() || choice->method >= choice->methods->size()) {
      return false;
    }
  }
}

bool Decomposer::HasMore(const MethodChoice& choice) const {
  return choice.num_variants > choice.variant + 1 || choice.sorted.has_next() ||
         path_.prover().num_choices() > choice.moment.choices ||
         NextFitting(choice, choice.method + 1) < choice.methods->size();
}

std::uint32_t Decomposer::NextFitting(const MethodChoice& choice, std::uint32_t from) const {
  const Term task = path_.network().node(choice.node).task;
  const auto& methods = *choice.methods;
  while (from < methods.size() && !path_.instances().CouldMatch(*methods[from]->head, task)) ++from;
  return from;
}

// --- bindings ---

/// Another binding by the method at hand.
bool Decomposer::NextBinding(MethodChoice* choice) {
  if (choice->branch == MethodChoice::kNotEntered) return false;
  path_.UndoSteps(choice->moment);
  if (NextSolution(choice)) return true;
  return !limits_.stopped() && !choice->solved && NextBranch(choice);
}

/// The first binding by the next method that fits.
bool Decomposer::NextMethod(MethodChoice* choice) {
  if (limits_.stopped()) return false;
  if (choice->branch != MethodChoice::kNotEntered) {
    choice->method = NextFitting(*choice, choice->method + 1);
  }
  if (choice->method >= choice->methods->size()) return false;
  path_.ReturnTo(choice->moment);
  return EnterMethod(choice) && NextBranch(choice);
}

bool Decomposer::EnterMethod(MethodChoice* choice) {
  const CompiledMethod& method = choice->current_method();
  choice->solved = false;
  choice->sorted.Clear();
  choice->tried.clear();
  choice->branch = static_cast<std::uint32_t>(method.branches.size());  // as if all had been tried
  choice->variables = path_.bindings().Make(method.num_slots);
  const Term task = path_.Task(choice->node);
  if (!path_.instances().Match(*method.head, choice->variables, task)) {
    if (trace_.active()) {
      trace_.Note(task, trace_.Where(method, 0), "the head does not match the task");
    }
    return false;
  }
  choice->entered = path_.bindings().Remember();
  choice->branch = MethodChoice::kNotEntered;
  return true;
}

/// The first binding of the next branch that has one.
bool Decomposer::NextBranch(MethodChoice* choice) {
  const CompiledMethod& method = choice->current_method();
  Prover& prover = path_.prover();
  choice->branch = choice->branch == MethodChoice::kNotEntered ? 0 : choice->branch + 1;
  for (; choice->branch < method.branches.size(); ++choice->branch) {
    if (trace_.active()) prover.set_tracing(&method.variables);
    choice->solved = Solve(choice);
    prover.set_tracing(nullptr);
    if (choice->solved) return true;
    if (prover.interrupted()) return false;
    if (trace_.active()) {
      trace_.Note(path_.network().node(choice->node).task, trace_.Where(method, choice->branch),
                  prover.furthest().empty() ? "the precondition has no binding"
                                            : "no binding satisfies " + prover.furthest());
    }
  }
  return false;
}

/// The first binding of the branch.
bool Decomposer::Solve(MethodChoice* choice) {
  const CompiledBranch& branch = choice->current_branch();
  const CompiledPrecondition& precondition =
      looks_ahead_ ? branch.with_first_step : branch.precondition;
  Bindings& bindings = path_.bindings();
  Prover& prover = path_.prover();
  bindings.Undo(choice->entered);
  if (precondition.order == Precondition::Order::kSortBy) {
    const std::uint32_t slots = choice->current_method().num_slots;
    if (!choice->sorted.Gather(precondition, choice->variables, slots, &path_)) return false;
    choice->moment.pairs = path_.terms().Mark();  // the solutions have to stay
    bindings.Undo(choice->entered);
    choice->sorted.BindNext(&bindings);
    return true;
  }
  const bool first = precondition.order == Precondition::Order::kFirst;
  if (!prover.Solve(precondition.goals, choice->variables, first)) return false;
  if (first) prover.Cut(choice->moment.choices);
  return true;
}

/// Another binding of the same branch.
bool Decomposer::NextSolution(MethodChoice* choice) {
  if (!choice->solved) return false;
  if (choice->sorted.gathered()) {
    if (!choice->sorted.has_next()) return false;
    path_.bindings().Undo(choice->entered);
    choice->sorted.BindNext(&path_.bindings());
    return true;
  }
  const std::size_t floor = choice->moment.choices;
  return path_.prover().num_choices() > floor && path_.prover().Next(floor);
}

// --- reductions ---

/// Lays out the reduction for the binding just found, unless it has been tried already.
bool Decomposer::UseSolution(MethodChoice* choice) {
  const CompiledNetwork& subtasks = *choice->current_branch().subtasks;
  tasks_.clear();
  BuildTasks(subtasks, choice->variables);
  const bool others =
      choice->sorted.gathered() || path_.prover().num_choices() > choice->moment.choices;
  if (others || !choice->tried.empty()) {
    // With the task itself: its open variables may be bound, and other tasks share them.
    std::uint64_t key = path_.terms().Hash(path_.Task(choice->node));
    for (const Term task : tasks_) key = key * 0x9e3779b97f4a7c15ULL + path_.terms().Hash(task);
    std::vector<std::uint64_t>& tried = choice->tried;
    if (std::find(tried.begin(), tried.end(), key) != tried.end()) return false;
    tried.push_back(key);
  }
  const bool free = program_.immediate_reductions() && choice->node != Network::kRoot &&
                    !subtasks.first_is_immediate;
  choice->num_variants = free ? subtasks.num_first : 0;
  choice->variant = 0;
  if (choice->num_variants > 1) choice->solution = path_.Now();
  return Reduce(choice);
}

/// The same reduction, with another of its first tasks going on at once.
bool Decomposer::NextVariant(MethodChoice* choice) {
  ++choice->variant;
  path_.ReturnTo(choice->solution);
  tasks_.clear();
  BuildTasks(*choice->current_branch().subtasks, choice->variables);
  return Reduce(choice);
}

void Decomposer::BuildTasks(const CompiledNetwork& network, std::uint32_t variables) {
  for (const CompiledNetwork::Item& item : network.items) {
    if (item.network != nullptr) {
      BuildTasks(*item.network, variables);
    } else {
      tasks_.push_back(path_.instances().Build(*item.task, variables));
    }
  }
}

/// Lays out `tasks_`. False where that leads back to where the path has been.
bool Decomposer::Reduce(MethodChoice* choice) {
  const CompiledMethod& method = choice->current_method();
  const int immediate = choice->num_variants > 0 ? static_cast<int>(choice->variant) : -1;
  path_.Decompose({choice->node, &method, choice->branch, choice->variables, path_.num_steps()},
                  tasks_, immediate);
  // Why it led nowhere was noted when the search was there before.
  if (!loop_check_ || !path_.WasHere()) return !explored_.IsFutile();
  if (trace_.active()) {
    trace_.Note(path_.network().node(choice->node).task, trace_.Where(method, choice->branch),
                "leads back to a state and tasks that this path has been through");
  }
  return false;
}

}  // namespace hires::planning
