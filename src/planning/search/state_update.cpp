#include "planning/search/state_update.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"

namespace hires::planning {

bool StateUpdate::Apply(const StepEffects& effects, const CompiledOperator& applied) {
  if (BreaksProtection(effects)) return false;
  Change(effects, applied);
  return (path_.protections().empty() || ProtectionsHold(effects)) && Protect(effects);
}

/// Without changing anything: a protected fact would go for good.
bool StateUpdate::BreaksProtection(const StepEffects& effects) {
  const std::vector<Term>& deletes = effects.deletes();
  const std::vector<Term>& adds = effects.adds();
  if (path_.protections().empty() || std::any_of(deletes.begin(), deletes.end(), [&](Term atom) {
        return effects.IsProtection(atom);  // it might be the one that protects
      })) {
    return false;
  }
  return std::any_of(deletes.begin(), deletes.end(), [&](Term atom) {
    return IsLost(atom) && std::find(adds.begin(), adds.end(), atom) == adds.end();
  });
}

/// Deletes, then adds (the last one listed first, so it is the oldest).
void StateUpdate::Change(const StepEffects& effects, const CompiledOperator& applied) {
  for (const Term atom : effects.deletes()) {
    if (effects.IsProtection(atom)) {
      path_.protections().Remove(effects.Protected(atom));
    } else {
      path_.state().Remove(atom);
    }
  }
  const std::vector<Term>& adds = effects.adds();
  for (std::size_t i = adds.size(); i-- > 0;) {
    const bool is_protection = effects.IsProtection(adds[i]);
    if (!effects.IsFact(is_protection ? effects.Protected(adds[i]) : adds[i])) {
      FailOn(applied, adds[i]);
    }
    if (!is_protection) path_.state().Add(adds[i]);
  }
}

bool StateUpdate::ProtectionsHold(const StepEffects& effects) {
  for (const Term atom : effects.deletes()) {
    if (!path_.state().Holds(atom) && IsLost(atom)) return false;
  }
  return path_.protections().AllOf([&](Term atom) {
    lost_ = atom;
    return program_.Axioms(path_.terms().head(atom)).empty() || path_.prover().Proves(atom);
  });
}

bool StateUpdate::Protect(const StepEffects& effects) {
  const std::vector<Term>& adds = effects.adds();
  for (std::size_t i = adds.size(); i-- > 0;) {
    if (!effects.IsProtection(adds[i])) continue;
    lost_ = effects.Protected(adds[i]);
    if (!path_.state().Holds(lost_) && !path_.prover().Proves(lost_)) return false;
    path_.protections().Add(lost_);
  }
  return true;
}

/// A protected fact that no axiom could bring back.
bool StateUpdate::IsLost(Term atom) {
  if (path_.protections().Count(atom) == 0) return false;
  if (!program_.Axioms(path_.terms().head(atom)).empty()) return false;
  lost_ = atom;
  return true;
}

void StateUpdate::FailOn(const CompiledOperator& applied, Term added) const {
  throw base::ConfigError(
      fmt::format("{}:{}: operator {} adds {}, which is no fact without variables; bind them in "
                  "its precondition",
                  program_.domain().source, applied.source->place.line, applied.source->head.Head(),
                  path_.terms().ToString(added)));
}

}  // namespace hires::planning
