#include "planning/proof/fact_matcher.h"

namespace hires::planning {

bool FactMatcher::Holds(AtomView atom) const {
  Term list;
  for (std::uint32_t i = atom.count; i-- > 0;) {
    list = terms_.FindPair(atom.arguments[i], list);
    if (list.IsNil()) return false;
  }
  return state_.Holds(terms_.FindPair(atom.predicate, list));
}

bool FactMatcher::HoldsForSome(AtomView atom) {
  const Bindings::Mark mark = bindings_.Remember();
  for (Walk walk = Begin(atom, true); !walk.done(); walk = Next(atom, walk)) {
    const bool matches = Unify(atom, walk.fact);
    bindings_.Undo(mark);
    if (matches) return true;
  }
  return false;
}

/// From `fact` on along its chain, the first that has the atom's arguments where these are ground.
std::uint32_t FactMatcher::FirstAgreeing(AtomView atom, std::uint32_t fact, std::uint8_t key,
                                         bool newest_first) const {
  for (; fact != State::kNone; fact = Beside(fact, key, newest_first)) {
    if (state_.Arity(fact) != atom.count) continue;
    const Term* known = state_.Arguments(fact);
    bool agrees = true;
    for (std::uint32_t i = 0; i < atom.count && agrees; ++i) {
      const Term wanted = atom.arguments[i];
      agrees = wanted == known[i] || !terms_.IsGround(wanted);
    }
    if (agrees) return fact;
  }
  return State::kNone;
}

}  // namespace hires::planning
