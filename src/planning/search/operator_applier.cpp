#include "planning/search/operator_applier.h"

#include <fmt/format.h>

#include <string>

#include "hires/base/error.h"
#include "planning/search/sorted_solutions.h"

namespace hires::planning {

OperatorApplier::OperatorApplier(const Program& program, const PlanRequest& request,
                                 SearchPath* path, SearchLimits* limits, const FoundPlans* plans,
                                 SearchTrace* trace)
    : program_(program),
      request_(request),
      path_(*path),
      limits_(*limits),
      plans_(*plans),
      trace_(*trace),
      effects_(path),
      update_(program, path),
      failure_word_(path->terms().Symbol("imagined_failure")) {}

bool OperatorApplier::Apply(std::uint32_t node) {
  const Term open = path_.Task(node);
  const CompiledOperator& applied = OperatorOf(open);
  const std::uint32_t variables = path_.bindings().Make(applied.num_slots);
  if (!Bind(applied, variables, open)) return false;
  const Term task = path_.Task(node);
  const auto refuse = [&](const auto& reason) {
    if (trace_.active()) trace_.Note(task, trace_.Where(applied), reason());
    return false;
  };
  if (IsExcluded(task)) {
    return refuse([] { return "the state says imagined_failure of this step"; });
  }
  const double cost = CostOf(applied, variables);
  const double sum = path_.cost() + cost;
  if (limits_.IsTooDear(sum) || plans_.IsTooDear(sum)) {
    return refuse([&] { return fmt::format("cost {} is too high", sum); });
  }
  effects_.Read(applied, variables);
  if (!update_.Apply(effects_, applied)) {
    return refuse([&] {
      return fmt::format("the protected fact {} would not hold",
                         path_.terms().ToString(update_.lost()));
    });
  }
  path_.Finish({node, &applied, variables, cost});
  return true;
}

const CompiledOperator& OperatorApplier::OperatorOf(Term task) const {
  const TermTable& terms = path_.terms();
  const CompiledOperator* applied = program_.FindOperator(terms.head(task));
  if (applied == nullptr) {
    program_.FailUnhandled(std::string(terms.text(terms.head(task))), terms.ToString(task));
  }
  return *applied;
}

/// By the head, then by the precondition.
bool OperatorApplier::Bind(const CompiledOperator& applied, std::uint32_t variables, Term task) {
  if (!path_.instances().Match(*applied.head, variables, task)) {
    if (trace_.active()) {
      trace_.Note(task, trace_.Where(applied), "the head does not match the step");
    }
    return false;
  }
  Prover& prover = path_.prover();
  if (trace_.active()) prover.set_tracing(&applied.variables);
  const bool found = FindBinding(applied.precondition, variables, applied.num_slots);
  prover.set_tracing(nullptr);
  if (!found && trace_.active() && !prover.interrupted()) {
    trace_.Note(task, trace_.Where(applied), "no binding satisfies " + prover.furthest());
  }
  return found;
}

/// One binding: the newest fact first, or the first in the order of a :sort-by.
bool OperatorApplier::FindBinding(const CompiledPrecondition& precondition, std::uint32_t variables,
                                  std::uint32_t slots) {
  Prover& prover = path_.prover();
  if (precondition.order == Precondition::Order::kSortBy) {
    const Bindings::Mark open = path_.bindings().Remember();
    SortedSolutions sorted;
    if (!sorted.Gather(precondition, variables, slots, &path_)) return false;
    path_.bindings().Undo(open);
    sorted.BindNext(&path_.bindings());
    return true;
  }
  const std::size_t floor = prover.num_choices();
  const Prover::Mark mark = prover.Remember();
  if (!prover.Solve(precondition.goals, variables, true)) return false;
  prover.Cut(floor);
  prover.Release(mark);
  return true;
}

bool OperatorApplier::IsExcluded(Term task) const {
  const State& state = path_.state();
  if (state.Candidates(failure_word_, nullptr, 0).oldest == State::kNone) return false;
  TermTable& terms = path_.terms();
  const std::string& name = terms.text(terms.head(task));
  const std::string plain = name.substr(name.find_first_not_of('!'));
  for (const std::string& spelling : {name, plain, "!" + plain}) {
    const Term call = terms.Pair(terms.Symbol(spelling), terms.tail(task));
    if (state.Holds(terms.FindPair(failure_word_, call))) return true;
  }
  return false;
}

double OperatorApplier::CostOf(const CompiledOperator& applied, std::uint32_t variables) const {
  if (applied.cost == nullptr) return applied.fixed_cost;
  const Term value = path_.instances().Evaluate(*applied.cost, variables);
  const double cost = value.IsNumber() ? path_.terms().number(value) : 1.0;
  if (cost < 0.0 && request_.which == Which::kBest) {
    throw base::ConfigError(fmt::format(
        "{}: cost {} is below 0; the cheapest plan can only be found where no step earns anything",
        trace_.Where(applied), cost));
  }
  return cost;
}

}  // namespace hires::planning
