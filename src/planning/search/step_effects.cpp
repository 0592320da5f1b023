#include "planning/search/step_effects.h"

namespace hires::planning {

StepEffects::StepEffects(SearchPath* path)
    : path_(*path), protection_word_(path->terms().Symbol(":protection")) {}

void StepEffects::Read(const CompiledOperator& applied, std::uint32_t variables) {
  deletes_.clear();
  adds_.clear();
  Collect(applied.deletes, variables, &deletes_);
  Collect(applied.adds, variables, &adds_);
}

bool StepEffects::IsProtection(Term atom) const {
  return atom.IsPair() && path_.terms().head(atom) == protection_word_;
}

Term StepEffects::Protected(Term protection) const {
  return path_.terms().head(path_.terms().tail(protection));
}

void StepEffects::Collect(const std::vector<CompiledEffect>& effects, std::uint32_t variables,
                          std::vector<Term>* atoms) {
  for (const CompiledEffect& effect : effects) {
    if (effect.kind == Effect::Kind::kForall) {
      CollectForAll(effect, variables, atoms);
      continue;
    }
    const Term term = path_.instances().Build(*effect.pattern, variables);
    if (effect.kind == Effect::Kind::kAtom) {
      atoms->push_back(term);
    } else if (effect.kind == Effect::Kind::kProtection) {
      TermTable& terms = path_.terms();
      atoms->push_back(terms.Pair(protection_word_, terms.Pair(term, Term())));
    } else {
      CollectList(term, atoms);
    }
  }
}

/// What a variable or call stands for in place of an atom: one, or a list of them.
void StepEffects::CollectList(Term list, std::vector<Term>* atoms) const {
  const TermTable& terms = path_.terms();
  if (list.IsPair() && terms.head(list).kind() == Term::Kind::kSymbol) {
    atoms->push_back(list);
    return;
  }
  for (; list.IsPair(); list = terms.tail(list)) atoms->push_back(terms.head(list));
}

void StepEffects::CollectForAll(const CompiledEffect& effect, std::uint32_t variables,
                                std::vector<Term>* atoms) {
  Prover& prover = path_.prover();
  const std::size_t floor = prover.num_choices();
  const Prover::Mark mark = prover.Remember();
  const Bindings::Mark bindings = path_.bindings().Remember();
  prover.HoldPairs(true);
  bool found = prover.Solve(effect.condition, variables, false);
  for (; found; found = prover.num_choices() > floor && prover.Next(floor)) {
    Collect(effect.effects, variables, atoms);
  }
  prover.HoldPairs(false);
  path_.bindings().Undo(bindings);
  prover.Release(mark);
}

}  // namespace hires::planning
