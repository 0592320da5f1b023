#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/functions.h"
#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/program.h"

namespace hires::planning {

/// Patterns and terms: the variables of a clause are slots of a frame, which begins at a number
/// among the bindings. Makes the instance of a pattern in a frame, and matches one with a term.
class Instantiator {
 public:
  Instantiator(TermTable* terms, Bindings* bindings) : terms_(*terms), bindings_(*bindings) {}

  static Term Variable(std::uint32_t frame, std::uint32_t slot) {
    return Term(Term::Kind::kVariable, frame + slot);
  }
  /// Bound variables are replaced, unbound ones left, functions evaluated.
  Term Build(const Pattern& pattern, std::uint32_t frame);
  /// Binds what makes both equal; where there is nothing, some may have been bound.
  bool Match(const Pattern& pattern, std::uint32_t frame, Term term);
  /// Without binding anything: constants and shapes agree. True also where Match may say no.
  bool CouldMatch(const Pattern& pattern, Term term) const;
  Term Evaluate(const Expression& expression, std::uint32_t frame);

  std::size_t bytes() const { return items_.capacity() * sizeof(Term); }

 private:
  TermTable& terms_;
  Bindings& bindings_;
  std::vector<Term> items_;  ///< of the lists that are being built
};

}  // namespace hires::planning
