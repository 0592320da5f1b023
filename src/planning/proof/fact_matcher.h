#pragma once

#include <cstdint>

#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/state.h"

namespace hires::planning {

/// A goal that facts may answer. Bound variables in the arguments have been replaced.
struct AtomView {
  const Term* arguments{nullptr};
  Term predicate;
  std::uint32_t count{0};
};

/// Which facts of the current state answer an atom, by age.
class FactMatcher {
 public:
  FactMatcher(TermTable* terms, Bindings* bindings, const State* state)
      : terms_(*terms), bindings_(*bindings), state_(*state) {}

  bool IsGround(AtomView atom) const {
    for (std::uint32_t i = 0; i < atom.count; ++i) {
      if (!terms_.IsGround(atom.arguments[i])) return false;
    }
    return true;
  }
  /// @pre `atom` is ground.
  bool Holds(AtomView atom) const;
  /// Whether any fact unifies with `atom`; binds nothing.
  bool HoldsForSome(AtomView atom);

  /// A walk over the facts that have the atom's arguments where these are ground.
  struct Walk {
    std::uint32_t fact{State::kNone};  ///< to be tried next, or State::kNone
    std::uint8_t key{0};               ///< links of the chain that is walked
    bool newest_first{false};
    bool done() const { return fact == State::kNone; }
  };
  Walk Begin(AtomView atom, bool newest_first) const {
    const State::Chain chain = state_.Candidates(atom.predicate, atom.arguments, atom.count);
    const std::uint32_t first = newest_first ? chain.newest : chain.oldest;
    return {FirstAgreeing(atom, first, chain.key, newest_first), chain.key, newest_first};
  }
  Walk Next(AtomView atom, const Walk& walk) const {
    const std::uint32_t next = Beside(walk.fact, walk.key, walk.newest_first);
    return {FirstAgreeing(atom, next, walk.key, walk.newest_first), walk.key, walk.newest_first};
  }
  /// Binds the open arguments to those of the fact; false where one variable stands for two terms.
  bool Unify(AtomView atom, std::uint32_t fact) {
    const Term* known = state_.Arguments(fact);
    for (std::uint32_t i = 0; i < atom.count; ++i) {
      const Term wanted = atom.arguments[i];
      if (wanted != known[i] && !bindings_.Unify(wanted, known[i])) return false;
    }
    return true;
  }

 private:
  std::uint32_t Beside(std::uint32_t fact, std::uint8_t key, bool newest_first) const {
    return newest_first ? state_.Previous(fact, key) : state_.Next(fact, key);
  }
  std::uint32_t FirstAgreeing(AtomView atom, std::uint32_t fact, std::uint8_t key,
                              bool newest_first) const;

  TermTable& terms_;
  Bindings& bindings_;
  const State& state_;
};

}  // namespace hires::planning
