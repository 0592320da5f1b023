#pragma once

#include <cstdint>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// What one step takes away and adds, in the order of the file. A protection stands among the atoms
/// as (:protection atom); what variables stood for may be none.
class StepEffects {
 public:
  explicit StepEffects(SearchPath* path);

  /// Those of an operator whose variables stand from `variables` on, bound by its precondition.
  void Read(const CompiledOperator& applied, std::uint32_t variables);
  const std::vector<Term>& deletes() const { return deletes_; }
  const std::vector<Term>& adds() const { return adds_; }

  /// (:protection x)
  bool IsProtection(Term atom) const;
  /// @pre IsProtection(protection).
  Term Protected(Term protection) const;
  /// (predicate arguments...) without variables.
  bool IsFact(Term atom) const;

 private:
  class Values;

  bool IsAtom(Term value) const;

  SearchPath& path_;
  const Term protection_word_;
  std::vector<Term> deletes_, adds_;
};

}  // namespace hires::planning
