// Carrying out primitive tasks: conditions, effects, costs and protections.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "hires/base/error.h"
#include "planning/search/search.h"

namespace hires::planning {

bool Search::Apply(std::uint32_t node) {
  const Term task = bindings_.Resolve(network_.node(node).task);
  const CompiledOperator* applied = program_.FindOperator(terms_.head(task));
  if (applied == nullptr) {
    throw base::ConfigError(fmt::format("{}: step {} has no operator in domain '{}'",
                                        program_.domain().source, terms_.ToString(task),
                                        program_.domain().name));
  }
  const std::uint32_t variables = bindings_.Make(applied->num_slots);
  if (!instances_.Match(*applied->head, variables, task)) {
    if (tracing()) Note(task, Where(*applied), "the head does not match the step");
    return false;
  }
  if (tracing()) prover_.set_tracing(&applied->variables);
  const bool found = FindBinding(applied->precondition, variables, applied->num_slots);
  prover_.set_tracing(nullptr);
  if (!found) {
    if (tracing() && !prover_.interrupted()) {
      Note(task, Where(*applied), "no binding satisfies " + prover_.furthest());
    }
    return false;
  }
  const Term ground = bindings_.Resolve(network_.node(node).task);
  if (IsExcluded(ground)) {
    if (tracing()) Note(ground, Where(*applied), "the state says imagined_failure of this step");
    return false;
  }
  const double cost = CostOf(*applied, variables);
  if (TooDear(cost_ + cost)) {
    if (tracing()) Note(ground, Where(*applied), fmt::format("cost {} is too high", cost_ + cost));
    return false;
  }
  deletes_.clear();
  adds_.clear();
  Collect(applied->deletes, variables, &deletes_);
  Collect(applied->adds, variables, &adds_);
  if (BreaksProtection() || !Change(*applied)) {
    if (tracing()) {
      Note(ground, Where(*applied),
           fmt::format("the protected fact {} would not hold", terms_.ToString(lost_)));
    }
    return false;
  }
  cost_ += cost;
  steps_.push_back({node, applied, variables, cost});
  network_.Finish(node);
  return true;
}

/// One binding: the newest fact first, or the first in the order of a :sort-by.
bool Search::FindBinding(const CompiledPrecondition& precondition, std::uint32_t variables,
                         std::uint32_t slots) {
  const std::size_t floor = prover_.num_choices();
  const Prover::Mark mark = prover_.Remember();
  if (precondition.order == Precondition::Order::kSortBy) {
    Frame frame;
    frame.variables = variables;
    frame.moment = Now();
    frame.entered = bindings_.Remember();
    if (!GatherSorted(&frame, precondition, slots)) return false;
    return true;
  }
  if (!prover_.Solve(precondition.goals, variables, true)) return false;
  prover_.Cut(floor);
  prover_.Release(mark);
  return true;
}

bool Search::IsExcluded(Term task) const {
  if (state_.Candidates(failure_word_, nullptr, 0).oldest == State::kNone) return false;
  const std::string& name = terms_.text(terms_.head(task));
  const std::string plain = name.substr(name.find_first_not_of('!'));
  for (const std::string& spelling : {name, plain, "!" + plain}) {
    const Term call = terms_.Pair(terms_.Symbol(spelling), terms_.tail(task));
    if (state_.Holds(terms_.FindPair(failure_word_, call))) return true;
  }
  return false;
}

double Search::CostOf(const CompiledOperator& applied, std::uint32_t variables) {
  if (applied.cost == nullptr) return applied.fixed_cost;
  const Term value = instances_.Evaluate(*applied.cost, variables);
  const double cost = value.IsNumber() ? terms_.number(value) : 1.0;
  if (cost < 0.0 && request_.which == Which::kBest) {
    throw base::ConfigError(fmt::format(
        "{}: cost {} is below 0; the cheapest plan can only be found where no step earns anything",
        Where(applied), cost));
  }
  return cost;
}

bool Search::TooDear(double cost) {
  if (cost > request_.max_cost) {
    too_dear_ = true;
    return true;
  }
  return request_.which == Which::kBest && cost >= best_cost_;
}

/// The atoms an operator adds or deletes, in the order of the file.
void Search::Collect(const std::vector<CompiledEffect>& effects, std::uint32_t variables,
                     std::vector<Term>* atoms) {
  for (const CompiledEffect& effect : effects) {
    switch (effect.kind) {
      case Effect::Kind::kForall:
        CollectForAll(effect, variables, atoms);
        break;
      case Effect::Kind::kAtom:
        atoms->push_back(instances_.Build(*effect.pattern, variables));
        break;
      case Effect::Kind::kProtection:
        atoms->push_back(terms_.Pair(
            protection_word_, terms_.Pair(instances_.Build(*effect.pattern, variables), Term())));
        break;
      case Effect::Kind::kList: {
        Term list = instances_.Build(*effect.pattern, variables);
        if (list.IsPair() && terms_.head(list).kind() == Term::Kind::kSymbol) {  // an atom alone
          atoms->push_back(list);
          break;
        }
        for (; list.IsPair(); list = terms_.tail(list)) atoms->push_back(terms_.head(list));
        break;
      }
    }
  }
}

void Search::CollectForAll(const CompiledEffect& effect, std::uint32_t variables,
                           std::vector<Term>* atoms) {
  const std::size_t floor = prover_.num_choices();
  const Prover::Mark mark = prover_.Remember();
  const Bindings::Mark bindings = bindings_.Remember();
  prover_.HoldPairs(true);
  bool found = prover_.Solve(effect.condition, variables, false);
  for (; found; found = prover_.num_choices() > floor && prover_.Next(floor)) {
    Collect(effect.effects, variables, atoms);
  }
  prover_.HoldPairs(false);
  bindings_.Undo(bindings);
  prover_.Release(mark);
}

bool Search::IsProtection(Term atom) const {
  return atom.IsPair() && terms_.head(atom) == protection_word_;
}

void Search::RequireGround(const CompiledOperator& applied, Term atom) const {
  if (atom.IsPair() && terms_.IsGround(atom) && terms_.head(atom).kind() == Term::Kind::kSymbol) {
    return;
  }
  throw base::ConfigError(fmt::format(
      "{}: operator {} adds {}, which is no fact without variables; bind them in its precondition",
      Where(applied), terms_.ToString(terms_.Symbol(applied.source->head.Head())),
      terms_.ToString(atom)));
}

/// Without changing anything: a protected fact would go for good.
bool Search::BreaksProtection() {
  if (protections_.empty() || std::any_of(deletes_.begin(), deletes_.end(), [this](Term atom) {
        return IsProtection(atom);  // it might be the one that protects
      })) {
    return false;
  }
  return std::any_of(deletes_.begin(), deletes_.end(), [this](Term atom) {
    return IsLost(atom) && std::find(adds_.begin(), adds_.end(), atom) == adds_.end();
  });
}

/// A protected fact that no axiom could bring back. Keeps it for the trace.
bool Search::IsLost(Term atom) {
  if (protections_.Count(atom) == 0 || !program_.Axioms(terms_.head(atom)).empty()) return false;
  lost_ = atom;
  return true;
}

/// Deletes, then adds (the last one listed first, so it is the oldest), then protections.
bool Search::Change(const CompiledOperator& applied) {
  for (const Term atom : deletes_) {
    if (IsProtection(atom)) {
      protections_.Remove(terms_.head(terms_.tail(atom)));
    } else {
      state_.Remove(atom);
    }
  }
  for (std::size_t i = adds_.size(); i-- > 0;) {
    RequireGround(applied, adds_[i]);
    if (!IsProtection(adds_[i])) state_.Add(adds_[i]);
  }
  return (protections_.empty() || ProtectionsHold()) && Protect();
}

bool Search::ProtectionsHold() {
  for (const Term atom : deletes_) {
    if (!state_.Holds(atom) && IsLost(atom)) return false;
  }
  return protections_.AllOf([&](Term atom) {
    lost_ = atom;
    return program_.Axioms(terms_.head(atom)).empty() || prover_.Proves(atom);
  });
}

bool Search::Protect() {
  for (std::size_t i = adds_.size(); i-- > 0;) {
    if (!IsProtection(adds_[i])) continue;
    lost_ = terms_.head(terms_.tail(adds_[i]));
    if (!state_.Holds(lost_) && !prover_.Proves(lost_)) return false;
    protections_.Add(lost_);
  }
  return true;
}

}  // namespace hires::planning
