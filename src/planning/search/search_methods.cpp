// Decomposing tasks: methods, their branches, bindings and reductions.
#include <algorithm>

#include "planning/proof/mix.h"
#include "planning/search/search.h"

namespace hires::planning {

bool Search::PushMethodFrame(std::uint32_t node,
                             const std::vector<const CompiledMethod*>& methods) {
  Frame& frame = frames_.emplace_back();
  frame.moment = Now();
  frame.node = node;
  frame.methods = &methods;
  frame.branch = kNotEntered;
  frame.method = NextFitting(frame, 0);
  return NextWay(&frame);
}

std::uint32_t Search::NextFitting(const Frame& frame, std::uint32_t from) const {
  const Term task = network_.node(frame.node).task;
  while (from < frame.methods->size() &&
         !instances_.CouldMatch(*(*frame.methods)[from]->head, task))
    ++from;
  return from;
}

/// The next decomposition of the frame's task: another first task of the same reduction, another
/// binding of the same branch, another branch while none had a binding, another method. The frame
/// goes when it has no other.
bool Search::NextWay(Frame* frame) {
  for (;;) {
    if (frame->num_variants > frame->variant + 1) {
      ++frame->variant;
      Return(frame->solution);
      bindings_.Undo(frame->solution.bindings);
      terms_.Release(frame->solution.pairs);
      prover_.Release(frame->solution.prover);
      BuildTasks(*frame);
      if (Reduce(frame)) return true;
      continue;
    }
    frame->num_variants = frame->variant = 0;
    if (frame->branch != kNotEntered) {
      Return(frame->moment);
      if (NextSolution(frame)) {
        if (UseSolution(frame)) return true;
        continue;
      }
      if (stop_ != Stop::kContinue) return false;
      if (!frame->solved && NextBranch(frame)) {
        if (UseSolution(frame)) return true;
        continue;
      }
      if (stop_ != Stop::kContinue) return false;
      frame->method = NextFitting(*frame, frame->method + 1);
    }
    if (frame->method >= frame->methods->size()) {
      frames_.pop_back();
      return false;
    }
    Return(frame->moment);
    bindings_.Undo(frame->moment.bindings);
    terms_.Release(frame->moment.pairs);
    prover_.Release(frame->moment.prover);
    if (EnterMethod(frame) && NextBranch(frame)) {
      if (UseSolution(frame)) return true;
    }
    if (stop_ != Stop::kContinue) return false;
  }
}

bool Search::EnterMethod(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  frame->solved = false;
  frame->sorted = false;
  frame->solutions.clear();
  frame->tried.clear();
  frame->branch = static_cast<std::uint32_t>(method.branches.size());  // as if all had been tried
  frame->variables = bindings_.Make(method.num_slots);
  const Term task = bindings_.Resolve(network_.node(frame->node).task);
  if (!instances_.Match(*method.head, frame->variables, task)) {
    if (tracing()) Note(task, Where(method, 0), "the head does not match the task");
    return false;
  }
  frame->entered = bindings_.Remember();
  frame->branch = kNotEntered;
  return true;
}

/// The first binding of the next branch that has one.
bool Search::NextBranch(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  frame->branch = frame->branch == kNotEntered ? 0 : frame->branch + 1;
  for (; frame->branch < method.branches.size(); ++frame->branch) {
    bindings_.Undo(frame->entered);
    const CompiledPrecondition& precondition = method.branches[frame->branch].precondition;
    if (tracing()) prover_.set_tracing(&method.variables);
    bool found = false;
    if (precondition.order == Precondition::Order::kSortBy) {
      found = GatherSorted(frame, precondition, method.num_slots);
    } else {
      const bool first = precondition.order == Precondition::Order::kFirst;
      found = prover_.Solve(precondition.goals, frame->variables, first);
      if (found && first) prover_.Cut(frame->moment.choices);
    }
    prover_.set_tracing(nullptr);
    if (found) {
      frame->solved = true;
      return true;
    }
    if (prover_.interrupted()) return false;
    if (tracing()) {
      Note(network_.node(frame->node).task, Where(method, frame->branch),
           prover_.furthest().empty() ? "the precondition has no binding"
                                      : "no binding satisfies " + prover_.furthest());
    }
  }
  return false;
}

/// Another binding of the same branch.
bool Search::NextSolution(Frame* frame) {
  if (!frame->solved) return false;
  if (frame->sorted) {
    const std::size_t width = (*frame->methods)[frame->method]->num_slots;
    if (frame->next_solution * width >= frame->solutions.size()) return false;
    bindings_.Undo(frame->entered);
    const Term* values = &frame->solutions[frame->next_solution++ * width];
    for (std::uint32_t i = 0; i < width; ++i) {
      bindings_.Unify(Term(Term::Kind::kVariable, frame->variables + i), values[i]);
    }
    return true;
  }
  return prover_.num_choices() > frame->moment.choices && prover_.Next(frame->moment.choices);
}

/// All bindings of a :sort-by, in order; binds the first.
bool Search::GatherSorted(Frame* frame, const CompiledPrecondition& precondition,
                          std::uint32_t slots) {
  struct Entry {
    Term key;
    std::size_t first;
  };
  std::vector<Entry> entries;
  std::vector<Term> values;
  const std::size_t floor = prover_.num_choices();
  prover_.HoldPairs(true);
  bool found = prover_.Solve(precondition.goals, frame->variables, false);
  for (; found; found = prover_.num_choices() > floor && prover_.Next(floor)) {
    entries.push_back(
        {instances_.Evaluate(*precondition.sort_key, frame->variables), values.size()});
    for (std::uint32_t i = 0; i < slots; ++i) {
      values.push_back(bindings_.Resolve(Term(Term::Kind::kVariable, frame->variables + i)));
    }
  }
  prover_.HoldPairs(false);
  if (entries.empty() || prover_.interrupted()) return false;
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return !precondition.comparison->function(&terms_, {a.key, b.key}).IsNil();
  });
  frame->solutions.clear();
  for (const Entry& entry : entries) {
    frame->solutions.insert(frame->solutions.end(), values.begin() + entry.first,
                            values.begin() + entry.first + slots);
  }
  frame->moment.pairs = terms_.Mark();  // the solutions have to stay
  frame->sorted = frame->solved = true;
  frame->next_solution = 0;
  return NextSolution(frame);
}

/// Lays out the reduction for the binding just found, unless it has been tried already.
bool Search::UseSolution(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  const CompiledBranch& branch = method.branches[frame->branch];
  BuildTasks(*frame);
  const bool others = frame->sorted || prover_.num_choices() > frame->moment.choices;
  if (others || !frame->tried.empty()) {
    // With the task itself: its open variables may be bound, and other tasks share them.
    std::uint64_t key = terms_.Hash(bindings_.Resolve(network_.node(frame->node).task));
    for (const Term task : tasks_) key = key * 0x9e3779b97f4a7c15ULL + terms_.Hash(task);
    if (std::find(frame->tried.begin(), frame->tried.end(), key) != frame->tried.end()) {
      return false;
    }
    frame->tried.push_back(key);
  }
  const bool free = program_.immediate_reductions() && frame->node != Network::kRoot &&
                    !branch.subtasks->first_is_immediate;
  frame->num_variants = free ? branch.subtasks->num_first : 0;
  frame->variant = 0;
  if (frame->num_variants > 1) frame->solution = Now();
  return Reduce(frame);
}

void Search::BuildTasks(const Frame& frame) {
  tasks_.clear();
  const CompiledMethod& method = *(*frame.methods)[frame.method];
  BuildTasks(*method.branches[frame.branch].subtasks, frame.variables);
}

void Search::BuildTasks(const CompiledNetwork& network, std::uint32_t variables) {
  for (const CompiledNetwork::Item& item : network.items) {
    if (item.network != nullptr) {
      BuildTasks(*item.network, variables);
    } else {
      tasks_.push_back(instances_.Build(*item.task, variables));
    }
  }
}

/// Lays out `tasks_`.
bool Search::Reduce(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  const CompiledNetwork& subtasks = *method.branches[frame->branch].subtasks;
  decompositions_.push_back({frame->node, &method, frame->branch, frame->variables, steps_.size()});
  const std::uint32_t node = frame->node;
  network_.Decompose(node, &subtasks, tasks_,
                     frame->num_variants > 0 ? static_cast<int>(frame->variant) : -1);
  if (request_.loop_check && WasHere()) {
    if (tracing()) {
      Note(network_.node(node).task, Where(method, frame->branch),
           "leads back to a state and tasks that this path has been through");
    }
    return false;
  }
  if (!HasMore(*frame)) frames_.pop_back();
  return true;
}

bool Search::WasHere() {
  if (!network_.all_ground()) return false;
  // In SHOP2 the age of facts decides which binding comes first, and :first takes no other.
  const bool ages_count = program_.domain().language == Domain::Language::kShop2;
  const std::uint64_t state = ages_count ? state_.ordered_hash() : state_.hash();
  return !visited_.Insert(Mix(Mix(state, network_.hash()), protections_.hash()));
}

bool Search::HasMore(const Frame& frame) const {
  return frame.num_variants > frame.variant + 1 ||
         (frame.sorted && frame.next_solution * (*frame.methods)[frame.method]->num_slots <
                              frame.solutions.size()) ||
         prover_.num_choices() > frame.moment.choices ||
         NextFitting(frame, frame.method + 1) < frame.methods->size();
}

}  // namespace hires::planning
