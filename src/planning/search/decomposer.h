#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/program.h"
#include "planning/search/explored.h"
#include "planning/search/search_limits.h"
#include "planning/search/search_path.h"
#include "planning/search/search_trace.h"
#include "planning/search/sorted_solutions.h"

namespace hires::planning {

/// A place on the path where a task was decomposed, and how far its ways have been tried.
struct MethodChoice {
  static constexpr std::uint32_t kNotEntered = 0xffffffffu;

  SearchPath::Moment moment;  ///< before
  std::uint32_t node;
  const std::vector<const CompiledMethod*>* methods;
  std::uint32_t method{0};             ///< that is being tried; methods->size(): none left
  std::uint32_t branch{kNotEntered};   ///< of that method
  bool solved{false};                  ///< the branch had a binding
  std::uint32_t variables{0};          ///< where the method's begin
  Bindings::Mark entered{};            ///< when the head had been matched
  SortedSolutions sorted{};            ///< of a branch with :sort-by
  std::vector<std::uint64_t> tried{};  ///< reductions of the branch, by hash
  std::uint32_t variant{0};            ///< which of the first tasks goes on at once
  std::uint32_t num_variants{0};
  SearchPath::Moment solution{};  ///< when the binding had been found, where there are variants

  const CompiledMethod& current_method() const { return *(*methods)[method]; }
  const CompiledBranch& current_branch() const { return current_method().branches[branch]; }
};

/// Breaks tasks down by methods: another first task of the same reduction, another binding of the
/// same branch, another branch while none had a binding, another method.
class Decomposer {
 public:
  Decomposer(const Program& program, bool loop_check, SearchPath* path, const SearchLimits* limits,
             Explored* explored, SearchTrace* trace);

  /// From now on bindings are left out with which the first step could not be taken at once.
  void LookAhead() { looks_ahead_ = true; }

  /// Nothing is tried yet. @param methods  Are referred to.
  MethodChoice Begin(std::uint32_t node, const std::vector<const CompiledMethod*>& methods);
  /// Goes back to the choice and on by the next way that lays out subtasks. False: there is none,
  /// or the search was told to stop.
  bool Next(MethodChoice* choice);
  /// Whether Next might find another way.
  bool HasMore(const MethodChoice& choice) const;

 private:
  bool NextBinding(MethodChoice* choice);
  bool NextMethod(MethodChoice* choice);
  bool EnterMethod(MethodChoice* choice);
  bool NextBranch(MethodChoice* choice);
  bool Solve(MethodChoice* choice);
  bool NextSolution(MethodChoice* choice);
  bool UseSolution(MethodChoice* choice);
  bool NextVariant(MethodChoice* choice);
  bool Reduce(MethodChoice* choice);
  std::uint32_t NextFitting(const MethodChoice& choice, std::uint32_t from) const;
  void BuildTasks(const CompiledNetwork& network, std::uint32_t variables);

  const Program& program_;
  const bool loop_check_;
  SearchPath& path_;
  const SearchLimits& limits_;
  Explored& explored_;
  SearchTrace& trace_;
  bool looks_ahead_{false};
  std::vector<Term> tasks_;  ///< of the reduction at hand, nested ones in place
};

}  // namespace hires::planning
