#pragma once

#include <string>
#include <vector>

#include "execution/facts.h"
#include "hires/planning/domain.h"
#include "hires/planning/operator_data.h"

namespace hires::execution {

/// The operator of a step; null where the domain has none.
const planning::Operator* OperatorOf(const planning::Domain& domain, const Datum& task);

/// What may hold or not while a step runs.
struct Disturbance {
  /// Its effects, and whatever value of what it replaces: driving from a to b, the robot may be
  /// seen at c: (robotat ?from).
  std::vector<Datum> effects;
  /// What it gives back in the end (planning::OperatorEntry::disturbs).
  std::vector<Datum> passing;

  bool Touches(const Datum& atom) const {
    return CanMatchAny(effects, atom) || CanMatchAny(passing, atom);
  }
};
Disturbance DisturbanceOf(const planning::Domain& domain, const planning::OperatorData& operators,
                          const planning::PlanStep& step);

/// What holds of that which a step will touch: to be noted when it begins.
std::vector<Datum> TouchedBy(const Disturbance& disturbance, const Facts& facts);

/// The state when a step is done that changes just what was planned.
void ApplyEffects(const planning::PlanStep& step, Facts* facts);
/// The same of one that has not begun. Where the state is not as foreseen (an arm is in another
/// posture), it changes what its operator changes of any state.
void ApplyEffects(const planning::PlanStep& step, const Disturbance& disturbance, Facts* facts);
/// The same of one that runs; `before`: what TouchedBy said when it began.
void ApplyEffects(const planning::PlanStep& step, const Disturbance& disturbance,
                  const std::vector<Datum>& before, Facts* facts);
/// The state before a step that runs.
void TakeBack(const Disturbance& disturbance, const std::vector<Datum>& before, Facts* facts);

}  // namespace hires::execution
