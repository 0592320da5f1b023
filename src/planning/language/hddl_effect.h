#pragma once

#include <vector>

#include "hires/planning/domain.h"
#include "planning/language/hddl_formula.h"

namespace hires::planning::hddl {

/// What an action does.
struct HddlEffects {
  std::vector<Effect> deletes;
  std::vector<Effect> adds;
  std::vector<Datum> costs;          ///< numbers and variables, to be summed up
  std::vector<Formula> value_atoms;  ///< bind those variables to values of functions
};

/// Reads an effect: atoms, (not atom), (and ...), (forall (...) effect), (when condition effect),
/// nested in any way, and (increase (total-cost) amount) outside of forall and when.
/// @param scope  With the parameters of the action as variables.
/// @throws ConfigError as the reader of domains does.
HddlEffects ReadEffects(const Datum& datum, HddlScope* scope);

/// The expression of what an action costs: the sum, or what an action without costs has.
Datum CostOf(const HddlEffects& effects, const HddlVocabulary& vocabulary);

/// An amount in a file: a number that is not negative.
const Datum& RequireAmount(const HddlSpot& spot, const Datum& datum);

}  // namespace hires::planning::hddl
