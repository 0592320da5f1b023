#pragma once

#include <cstdint>

#include "planning/proof/atom_goals.h"
#include "planning/proof/bindings.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/proof_stack.h"
#include "planning/proof/solution_collector.h"

namespace hires::planning {

/// Goals that are logical words and calls: and, or, not, imply, =, assign, assign*, eval, setof.
/// Each function moves the stack to what has to be proven next and says false where there is no way
/// on. Those named Next take up the choice on top of the stack.
class LogicalGoals {
 public:
  LogicalGoals(const Program& program, TermTable* terms, Instantiator* instances,
               Bindings* bindings, ProofStack* stack, AtomGoals* atoms,
               SolutionCollector* collector);

  bool And(const Goal* goal);
  bool Or(const Goal* goal);
  bool Imply(const Goal* goal);
  bool Not(const Goal* goal);
  bool Equal(const Goal* goal);
  bool Assign(const Goal* goal);
  bool AssignEach(const Goal* goal);
  bool Eval(const Goal* goal);
  bool Collect(const Goal* goal);

  bool NextDisjunct();
  bool NextValue();  ///< of an assign*
  bool AfterNot();   ///< the negated goal has no proof

 private:
  using Choice = ProofStack::Choice;

  bool NothingToBind(const Goal* goal) const;
  bool EnterDisjunct(const Goal* goal, std::uint32_t disjunct);

  const Program& program_;
  TermTable& terms_;
  Instantiator& instances_;
  Bindings& bindings_;
  ProofStack& stack_;
  AtomGoals& atoms_;
  SolutionCollector& collector_;
};

}  // namespace hires::planning
