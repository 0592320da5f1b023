#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// All bindings of a condition with :sort-by, in the order of their keys; equal keys stay in the
/// order in which the prover found them.
class SortedSolutions {
 public:
  /// Finds and sorts them. The clause's variables stand from `variables` on, `count` of them. False
  /// where there is none, or where the search was told to stop. What was there before stays then.
  bool Gather(const CompiledPrecondition& precondition, std::uint32_t variables,
              std::uint32_t count, SearchPath* path);
  void Clear();

  bool gathered() const { return num_solutions_ > 0; }
  bool has_next() const { return next_ < num_solutions_; }
  /// Binds the variables to the next solution. @pre has_next(), and they are as in Gather.
  void BindNext(Bindings* bindings);

 private:
  std::vector<Term> values_;  ///< count_ for each solution
  std::size_t num_solutions_{0};
  std::size_t next_{0};
  std::uint32_t variables_{0};
  std::uint32_t count_{0};
};

}  // namespace hires::planning
