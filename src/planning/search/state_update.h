#pragma once

#include "hires/planning/term.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"
#include "planning/search/step_effects.h"

namespace hires::planning {

/// Carries out the effects of steps on facts and protections, unless a protected atom would not
/// hold any more.
class StateUpdate {
 public:
  StateUpdate(const Program& program, SearchPath* path) : program_(program), path_(*path) {}

  /// False where a protected atom would not hold; some effects may be carried out then.
  /// @throws ConfigError where an atom that is added is no fact.
  bool Apply(const StepEffects& effects, const CompiledOperator& applied);
  /// The protected atom for which Apply said no.
  Term lost() const { return lost_; }

 private:
  bool BreaksProtection(const StepEffects& effects);
  void Change(const StepEffects& effects, const CompiledOperator& applied);
  bool ProtectionsHold(const StepEffects& effects);
  bool Protect(const StepEffects& effects);
  bool IsLost(Term atom);
  [[noreturn]] void FailOn(const CompiledOperator& applied, Term added) const;

  const Program& program_;
  SearchPath& path_;
  Term lost_;
};

}  // namespace hires::planning
