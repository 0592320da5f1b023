#include "planning/proof/bindings.h"

#include <utility>

namespace hires::planning {

std::uint32_t Bindings::Make(std::uint32_t count) {
  const std::uint32_t first = size();
  for (std::uint32_t i = 0; i < count; ++i) {
    values_.push_back(Term(Term::Kind::kVariable, first + i));
  }
  return first;
}

void Bindings::Bind(Term variable, Term value) {
  values_[variable.index()] = value;
  if (variable.index() < floor_) trail_.push_back(variable.index());
}

void Bindings::Undo(const Mark& mark) {
  while (trail_.size() > mark.trail) {
    const std::uint32_t variable = trail_.back();
    trail_.pop_back();
    if (variable < mark.variables) values_[variable] = Term(Term::Kind::kVariable, variable);
  }
  values_.resize(mark.variables);
  floor_ = mark.variables;
}

Term Bindings::Resolve(Term term) {
  term = Deref(term);
  if (terms_->IsGround(term) || term.IsVariable()) return term;
  // Along the list in a loop, into its items by recursion: lists are long, nesting is bounded.
  std::vector<Term> items;
  for (; term.IsPair() && !terms_->IsGround(term); term = Deref(terms_->tail(term))) {
    items.push_back(Resolve(terms_->head(term)));
  }
  for (std::size_t i = items.size(); i-- > 0;) term = terms_->Pair(items[i], term);
  return term;
}

bool Bindings::Occurs(Term variable, Term term) const {
  for (term = Deref(term); term.IsPair(); term = Deref(terms_->tail(term))) {
    if (terms_->IsGround(term)) return false;
    if (Occurs(variable, terms_->head(term))) return true;
  }
  return term == variable;
}

bool Bindings::Unify(Term a, Term b) {
  for (;;) {
    a = Deref(a);
    b = Deref(b);
    if (a == b) return true;
    if (a.IsVariable() || b.IsVariable()) {
      const bool bind_a = a.IsVariable() && (!b.IsVariable() || b.index() < a.index());
      if (!bind_a) std::swap(a, b);
      if (b.IsPair() && Occurs(a, b)) return false;
      Bind(a, b);
      return true;
    }
    if (!a.IsPair() || !b.IsPair()) return false;
    if (terms_->IsGround(a) && terms_->IsGround(b)) return false;  // equal ones are the same
    if (!Unify(terms_->head(a), terms_->head(b))) return false;
    a = terms_->tail(a);
    b = terms_->tail(b);
  }
}

}  // namespace hires::planning
