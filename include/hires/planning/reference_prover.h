#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "hires/planning/datum_evaluator.h"
#include "hires/planning/domain.h"
#include "hires/planning/fact_history.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"
#include "hires/planning/substitution.h"

namespace hires::planning {

/// What is asked of the prover.
struct ProofQuestion {
  const Formula& formula;
  const FactHistory& facts;
  int moment{0};        ///< of `facts`
  ValueMap known{};     ///< values of the formula's variables before the proof begins
  ValueMap expected{};  ///< values they must have at the end, as far as they get any; a goal such
                        ///< as `not` that comes before a variable is bound does not see them
  bool newest_first{false};  ///< facts in the order of :first; else oldest first
  bool explain{false};       ///< fill in `support` and `reads` of the proof
  bool reads_all{false};     ///< `reads` has positive goals too, not only what cannot be a link
};

/// Why a formula holds.
struct Proof {
  ValueMap values;               ///< of the formula's variables, as far as they are bound
  std::vector<Literal> support;  ///< facts it was proven with, also by axioms, each once, and atoms
                                 ///< that no fact matches where it needed that, with the variables
                                 ///< that were left
  std::vector<Datum> reads;      ///< see PlanStep::reads
};

/// Finds the proofs of conditions, one after the other: the slow road that checks the fast one. It
/// shares nothing with the search but the domain.
///
/// Facts come before axioms. Of an axiom, the first branch that has a proof is the only one used.
/// `not` holds by failure; `forall` and `exists` are tests that bind nothing; (imply a b) is
/// (or (not a) b); `setof` fails where there is nothing to collect.
class ReferenceProver {
 public:
  struct Limits {
    int max_axiom_depth{10'000};  ///< axioms within axioms
    int max_nesting{250};         ///< not, imply, forall and setof within each other
  };

  /// `domain` and `functions` must live as long as this.
  ReferenceProver(const Domain& domain, const Functions& functions);
  ReferenceProver(const Domain& domain, const Functions& functions, const Limits& limits);

  /// @throws ConfigError naming the file and the place: an expression that cannot be evaluated, an
  ///   unbound variable as a goal, axioms that call each other without end.
  std::optional<Proof> FirstProof(const ProofQuestion& question);
  /// @param reads  With `explain`: everything that was asked on the way is added here.
  std::vector<Proof> AllProofs(const ProofQuestion& question, std::vector<Datum>* reads = nullptr);
  bool Holds(const ProofQuestion& question);

  DatumEvaluator& evaluator() { return evaluator_; }
  const Limits& limits() const { return limits_; }
  const std::string& source() const { return domain_.source; }
  const std::vector<const Axiom*>& AxiomsFor(const std::string& predicate) const;

 private:
  std::vector<Proof> Find(const ProofQuestion& question, std::size_t at_most,
                          std::vector<Datum>* reads);

  const Domain& domain_;
  Limits limits_;
  DatumEvaluator evaluator_;
  std::unordered_map<std::string, std::vector<const Axiom*>> axioms_;  ///< by predicate
};

/// An atom as a formula.
Formula MakeAtom(Datum atom);

/// The names of all variables of `formula`.
std::set<std::string> VariablesOf(const Formula& formula);

/// Those that a proof of it can bind: not the ones that stand only under a `not` and its like.
std::set<std::string> VariablesBoundBy(const Formula& formula);

/// "source:line:column: " for messages.
std::string At(const std::string& source, Place place);

}  // namespace hires::planning
