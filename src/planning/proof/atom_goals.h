#pragma once

#include <cstdint>

#include "planning/proof/fact_matcher.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/proof_stack.h"

namespace hires::planning {

/// Goals that are atoms: proven by facts first, then by axioms. Each function moves the stack to
/// what has to be proven next and says false where there is no way on. Those named Next take up the
/// choice on top of the stack, which goes when it has no other way.
class AtomGoals {
 public:
  AtomGoals(const Program& program, TermTable* terms, Instantiator* instances, Bindings* bindings,
            FactMatcher* facts, ProofStack* stack);

  bool Call(const Goal* goal);          ///< (predicate arguments...)
  bool CallVariable(const Goal* goal);  ///< a variable that stands for an atom
  /// The atom whose arguments stand on the stack from `arguments` to its top, then `next`.
  bool Call(Term predicate, std::uint32_t arguments, const Goal* next);
  /// An atom without axioms, in place: whether it holds for any values of its open variables.
  bool HoldsForSome(const Goal* goal);
  bool HasAxioms(Term predicate) const { return !program_.Axioms(predicate).empty(); }

  bool NextFact();
  bool NextAxiom();
  bool NextBranch();

 private:
  using Choice = ProofStack::Choice;

  std::uint32_t BuildArguments(const Goal* goal);
  AtomView Atom(Term predicate, std::uint32_t arguments, std::uint32_t count) const {
    return {stack_.arguments().data() + arguments, predicate, count};
  }
  bool EnterAxioms(Term predicate, std::uint32_t arguments, std::uint32_t count, bool once);
  bool TryAxiom(const CompiledAxiom& axiom, std::uint32_t arguments, std::uint32_t count);
  bool EnterBranch(const CompiledAxiom& axiom, std::uint32_t branch, std::uint32_t frame);

  const Program& program_;
  TermTable& terms_;
  Instantiator& instances_;
  Bindings& bindings_;
  FactMatcher& facts_;
  ProofStack& stack_;
};

}  // namespace hires::planning
