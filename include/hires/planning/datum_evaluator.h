#pragma once

#include <string>

#include "hires/planning/datum.h"
#include "hires/planning/functions.h"
#include "hires/planning/substitution.h"
#include "hires/planning/term.h"

namespace hires::planning {

/// Evaluates a domain's expressions on data as they are written, one at a time.
class DatumEvaluator {
 public:
  /// @param functions  Must live as long as this.
  /// @param source     File of the domain, for messages.
  DatumEvaluator(const Functions& functions, std::string source);

  /// The value of `expression` with the variables that `values` knows.
  /// @throws ConfigError where it cannot be evaluated.
  Datum Evaluate(const Datum& expression, const Substitution& values);

  /// As above for a cost; nil, the cost of an operator that names none, counts 1.
  /// @throws ConfigError also where the value is no number.
  double EvaluateCost(const Datum& expression, const Substitution& values);

  /// `pattern` with known variables replaced and every `(call f arguments...)` in it evaluated.
  Datum Instantiate(const Datum& pattern, const Substitution& values);

 private:
  class Slots;

  Term ToTerm(const Datum& datum, Slots* slots);
  Datum ToDatum(Term term, const Slots& slots) const;

  const Functions& functions_;
  std::string source_;
  TermTable terms_;
};

/// Holds `(call f ...)` somewhere.
bool HasCall(const Datum& pattern);

}  // namespace hires::planning
