#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/atom_goals.h"
#include "planning/proof/bindings.h"
#include "planning/proof/fact_matcher.h"
#include "planning/proof/goal_trace.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/logical_goals.h"
#include "planning/proof/program.h"
#include "planning/proof/proof_stack.h"
#include "planning/proof/solution_collector.h"
#include "planning/proof/state.h"

namespace hires::planning {

/// Proves conditions in the current state by facts and axioms, one solution after the other, with
/// the order of solutions that SHOP3 has:
/// - "all bindings" (methods): facts oldest first, then axioms, the last one first;
/// - "one binding" (operators, :first): facts newest first, then axioms, the first one first;
/// - an explicit `and`, an `or`, and the body of an axiom with several goals are solved for all
///   bindings on their own; "all bindings" then takes these the other way round.
/// Solutions are found when they are asked for; proofs that can only repeat a solution are skipped.
///
/// This is the loop alone, with the questions whether to go on: what each kind of goal asks of the
/// stack is said by AtomGoals and LogicalGoals.
class Prover {
 public:
  Prover(const Program& program, TermTable* terms, Bindings* bindings, Instantiator* instances,
         const State* state);

  /// Asked at least every 4096 inferences; true gives up (Solve and Next say no from then on).
  void set_interrupt(std::function<bool()> interrupt) { interrupt_ = std::move(interrupt); }
  /// Keeps the furthest goal that was tried, for people; `names` are those of the frame's
  /// variables, null keeps nothing.
  void set_tracing(const std::vector<std::string>* names) { trace_.set_names(names); }

  /// The first solution of `goals`, whose variables begin at `frame`. Alternatives stay on the
  /// stack above what num_choices() was before; Next asks for them, Cut drops them.
  bool Solve(const Goal* goals, std::uint32_t frame, bool newest_first);
  bool Next(std::size_t floor);  ///< @pre num_choices() > floor
  void Cut(std::size_t floor) { stack_.CutTo(floor); }
  std::size_t num_choices() const { return stack_.num_choices(); }
  /// One proof of a ground atom; leaves nothing behind.
  bool Proves(Term atom);

  /// What the stacks hold, to be dropped when nothing above is needed any more.
  using Mark = ProofStack::Mark;
  Mark Remember() const { return stack_.Remember(); }
  void Release(const Mark& mark) { stack_.Release(mark); }
  /// While held, pairs that proofs made stay (the caller keeps terms across solutions).
  void HoldPairs(bool hold) { stack_.HoldPairs(hold); }

  std::uint64_t inferences() const { return inferences_; }
  bool interrupted() const { return interrupted_; }
  /// The furthest goal of the last Solve with its bindings so far: "goal 3 (on ?x b2)".
  const std::string& furthest() const { return trace_.furthest(); }
  std::size_t bytes() const { return stack_.bytes(); }

 private:
  bool Run(std::size_t floor);
  bool Step();
  bool Leave();
  bool Backtrack(std::size_t floor);
  bool Resume();
  bool AskedToStop();

  TermTable& terms_;
  Bindings& bindings_;
  ProofStack stack_;
  FactMatcher facts_;
  SolutionCollector collector_;
  AtomGoals atoms_;
  LogicalGoals logic_;
  GoalTrace trace_;
  std::function<bool()> interrupt_;
  std::uint64_t inferences_{0};
  bool interrupted_{false};
};

}  // namespace hires::planning
