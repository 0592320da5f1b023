#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/fact_history.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"
#include "hires/planning/reference_prover.h"
#include "hires/planning/substitution.h"

namespace hires::planning {

/// What a step did when it was taken again.
struct ReplayedStep {
  const Operator* op{nullptr};     ///< null: no operator has this name and shape
  ValueMap values;                 ///< of the operator's variables
  std::vector<Literal> support;    ///< facts that its precondition was proven with
  std::vector<Datum> reads;        ///< see PlanStep::reads
  std::vector<Datum> deletes;      ///< atoms that held before and do not hold after it
  std::vector<Datum> adds;         ///< atoms that it adds or keeps, in the order of the operator
  std::vector<Datum> protects;     ///< atoms that it protects
  std::vector<Datum> unprotects;   ///< atoms of which it ends one protection
  double cost{0.0};                ///< by the operator's expression
  std::vector<std::string> wrong;  ///< violated rules, one sentence each; empty: it may be taken
};

/// Takes the steps of a plan one after the other, from the facts of a problem, by the definition of
/// the operators. A step that breaks a rule is told so and has its effects nevertheless, as far as
/// they are known.
class StepReplay {
 public:
  /// The arguments must live as long as this.
  /// @param explain  Fill in `support` and `reads`.
  StepReplay(const Domain& domain, const Problem& problem, const Functions& functions,
             bool explain);

  /// @throws ConfigError where an expression of the operator cannot be evaluated.
  ReplayedStep Take(const PlanStep& step);
  /// Goes on after step `index`, whether it could be taken or not.
  void Skip(int index) { moment_ = index + 1; }

  int moment() const { return moment_; }  ///< steps taken so far
  const FactHistory& facts() const { return facts_; }
  ReferenceProver& prover() { return prover_; }
  /// Atoms protected now, with how often.
  const std::map<std::string, std::pair<Datum, int>>& protections() const { return protections_; }

 private:
  class EffectValues;
  /// Effects with all variables replaced, before anything is changed.
  struct Changes {
    std::vector<Datum> atoms;
    std::vector<Datum> protections;
  };

  const Operator* FindOperator(const Datum& task, ValueMap* known) const;
  void CheckExclusion(const PlanStep& step, ReplayedStep* taken) const;
  void ProvePrecondition(const PlanStep& step, const ValueMap& known, ReplayedStep* taken);
  void Resolve(const std::vector<Effect>& effects, ReplayedStep* taken, Changes* changes);
  void Change(const Changes& deletes, const Changes& adds, ReplayedStep* taken);
  void ChangeProtections(const Changes& deletes, const Changes& adds, ReplayedStep* taken);
  void CheckProtections(ReplayedStep* taken);

  const Domain& domain_;
  bool explain_;
  FactHistory facts_;
  ReferenceProver prover_;
  std::map<std::string, std::pair<Datum, int>> protections_;  ///< by text
  int moment_{0};
};

}  // namespace hires::planning
