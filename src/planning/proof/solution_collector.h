#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "planning/proof/bindings.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/proof_stack.h"

namespace hires::planning {

/// Goals whose solutions are all found before any is used: setof and bagof, and, where all bindings
/// are wanted, `and` and `or`, whose solutions are then taken up last one first. Collections nest.
class SolutionCollector {
 public:
  SolutionCollector(const Program& program, TermTable* terms, Instantiator* instances,
                    Bindings* bindings, ProofStack* stack);

  /// From now on solutions of `goal` are gathered; the caller goes on with its body.
  void Start(const Goal* goal);
  /// Solutions come from this disjunct of `goal`, if it is the one whose solutions are gathered:
  /// equal ones of two disjuncts are two solutions.
  void SetPart(const Goal* goal, std::uint32_t disjunct);
  /// Notes the solution just found. `choice`: that of the collection.
  /// @throws ConfigError where it leaves a variable unbound that belongs to the goal alone.
  void Record(const ProofStack::Choice& choice);
  /// There are no more solutions: goes on with the list of them, or with the last one. False where
  /// there was none.
  bool Finish();
  bool NextTuple();  ///< goes on with the solution before
  void Clear();      ///< gives up all collections

 private:
  using Choice = ProofStack::Choice;
  struct Collection {
    const Goal* goal;
    std::uint32_t frame;
    std::vector<std::uint32_t> unbound;  ///< slots to be recorded
    std::vector<Term> values;
    std::unordered_set<std::uint64_t> seen;
    std::uint32_t part{0};  ///< disjunct that is being solved
  };
  std::vector<std::uint32_t> Unbound(const Goal* goal);
  Collection TakeNewest();

  const Program& program_;
  TermTable& terms_;
  Instantiator& instances_;
  Bindings& bindings_;
  ProofStack& stack_;
  std::vector<Collection> collections_;
};

}  // namespace hires::planning
