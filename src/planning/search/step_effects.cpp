#include "planning/search/step_effects.h"

#include "hires/planning/domain.h"

namespace hires::planning {

/// What CollectAtoms asks, answered with terms.
class StepEffects::Values {
 public:
  Values(const StepEffects& owner, std::uint32_t variables, std::vector<Term>* atoms)
      : owner_(owner), path_(owner.path_), variables_(variables), atoms_(*atoms) {}

  Term Instantiate(const CompiledEffect& effect) {
    return path_.instances().Build(*effect.pattern, variables_);
  }

  Term Protection(Term atom) {
    TermTable& terms = path_.terms();
    return terms.Pair(owner_.protection_word_, terms.Pair(atom, Term()));
  }

  bool IsAtom(Term value) const { return owner_.IsAtom(value); }

  template <typename Visit>
  void ForEachItem(Term list, const Visit& visit) {
    for (; list.IsPair(); list = path_.terms().tail(list)) visit(path_.terms().head(list));
  }

  template <typename Visit>
  void ForEachBinding(const CompiledEffect& effect, const Visit& visit) {
    Prover& prover = path_.prover();
    const std::size_t floor = prover.num_choices();
    const Prover::Mark mark = prover.Remember();
    const Bindings::Mark bindings = path_.bindings().Remember();
    prover.HoldPairs(true);
    bool found = prover.Solve(effect.condition, variables_, false);
    for (; found; found = prover.num_choices() > floor && prover.Next(floor)) visit();
    prover.HoldPairs(false);
    path_.bindings().Undo(bindings);
    prover.Release(mark);
  }

  void Take(Term atom) { atoms_.push_back(atom); }

 private:
  const StepEffects& owner_;
  SearchPath& path_;
  const std::uint32_t variables_;
  std::vector<Term>& atoms_;
};

StepEffects::StepEffects(SearchPath* path)
    : path_(*path), protection_word_(path->terms().Symbol(kProtectionWord)) {}

void StepEffects::Read(const CompiledOperator& applied, std::uint32_t variables) {
  deletes_.clear();
  adds_.clear();
  Values deletes(*this, variables, &deletes_);
  CollectAtoms(applied.deletes, &deletes);
  Values adds(*this, variables, &adds_);
  CollectAtoms(applied.adds, &adds);
}

bool StepEffects::IsAtom(Term value) const {
  if (!value.IsPair()) return false;
  const Term head = path_.terms().head(value);
  return head.kind() == Term::Kind::kSymbol && !head.IsNil();
}

bool StepEffects::IsProtection(Term atom) const {
  const TermTable& terms = path_.terms();
  if (!atom.IsPair() || terms.head(atom) != protection_word_) return false;
  const Term rest = terms.tail(atom);
  return rest.IsPair() && terms.tail(rest).IsNil();
}

Term StepEffects::Protected(Term protection) const {
  return path_.terms().head(path_.terms().tail(protection));
}

bool StepEffects::IsFact(Term atom) const {
  return IsAtom(atom) && path_.terms().head(atom) != protection_word_ &&
         path_.terms().IsGround(atom);
}

}  // namespace hires::planning
