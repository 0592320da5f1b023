#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/proof/program.h"
#include "planning/search/decomposer.h"
#include "planning/search/explored.h"
#include "planning/search/found_plans.h"
#include "planning/search/operator_applier.h"
#include "planning/search/search_limits.h"
#include "planning/search/search_path.h"
#include "planning/search/search_trace.h"

namespace hires::planning {

/// What a search leaves out, so that it comes to an end, or to a plan, earlier.
struct SearchMode {
  static constexpr int kAnyNumber = std::numeric_limits<int>::max();

  /// How often a task may come up again below itself in the same state. Where the number is
  /// bounded, a search ends that would never stop going down (get_to -> get_to, drive), but plans
  /// may be missed (s -> s, b).
  int most_repeats{kAnyNumber};
  bool repeats_across_steps{true};  ///< otherwise only what comes up before a step was taken counts
  /// Whether a task may wait, once begun, while others go on of which the order says nothing.
  bool interleaves{true};
  std::uint64_t budget{SearchLimits::kAnyNumber};  ///< of expansions, about
  /// Whether bindings are left out with which the first step after a method could not be taken.
  /// @pre nothing can come in between: all is ordered, or nothing interleaves
  bool looks_ahead{false};
};

/// One search for plans: forward along one path, task by task, and back to the last place where
/// there was another way. Which way that is, Decomposer and OperatorApplier know.
class Search {
 public:
  /// @param keep_deepest  Whether the ends of the paths that lead furthest are put into words.
  Search(const Program& program, TermTable* terms, const PlanRequest& request,
         const SearchMode& mode = {}, bool keep_deepest = false);
  PlanResult Run();
  /// Keeps what an earlier search for the same found: it is not found again, and what is no cheaper
  /// is not sought where the cheapest is wanted. @param plans  its result's.
  void BeginWith(Search* earlier, std::vector<Plan> plans) {
    plans_.TakeOver(&earlier->plans_, std::move(plans));
  }
  bool gave_up_recursion() const { return gave_up_recursion_; }
  bool stopped() const { return limits_.stopped(); }
  bool is_spent() const { return limits_.is_spent(); }  ///< stopped as its budget was spent
  bool has_enough() const { return plans_.enough(); }

 private:
  /// A place where several tasks were ready; `node` is the one that was taken.
  struct TaskChoice {
    SearchPath::Moment moment;
    std::uint32_t node, focus;
  };
  using Choice = std::variant<MethodChoice, TaskChoice>;

  bool Forward();
  bool Backward();
  bool Process(std::uint32_t node);
  bool Decompose(std::uint32_t node, const std::vector<const CompiledMethod*>& methods);
  bool TryNext(MethodChoice* choice);
  bool TryNext(TaskChoice* choice);
  const std::vector<const CompiledMethod*>& MethodsOf(Term task);
  std::uint32_t FirstFixed();
  bool IsGivenUp(std::uint32_t node, Term task);
  bool GoalHolds();
  bool Ask();
  Progress CurrentProgress() const;

  const Program& program_;
  const SearchMode mode_;
  bool gave_up_recursion_{false};
  SearchPath path_;
  SearchLimits limits_;
  Explored explored_;
  SearchTrace trace_;
  FoundPlans plans_;
  Decomposer decomposer_;
  OperatorApplier applier_;
  std::vector<const CompiledMethod*> root_methods_;
  std::vector<Choice> choices_;
};

}  // namespace hires::planning
