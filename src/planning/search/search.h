#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/proof/program.h"
#include "planning/search/decomposer.h"
#include "planning/search/found_plans.h"
#include "planning/search/operator_applier.h"
#include "planning/search/search_limits.h"
#include "planning/search/search_path.h"
#include "planning/search/search_trace.h"

namespace hires::planning {

/// One search for plans: forward along one path, task by task, and back to the last place where
/// there was another way. Which way that is, Decomposer and OperatorApplier know.
class Search {
 public:
  /// @param left_recursion  Whether a task may come up again below itself before a step was taken.
  ///   Without, a search ends that would never stop going down (get_to -> get_to, drive), but plans
  ///   may be missed (s -> s, b); gave_up_recursion() says whether there was such a task.
  /// @param keep_deepest  Whether the ends of the paths that lead furthest are put into words.
  Search(const Program& program, TermTable* terms, const PlanRequest& request,
         bool left_recursion = true, bool keep_deepest = false);
  PlanResult Run();
  /// Keeps what an earlier search for the same found: it is not found again, and what is no cheaper
  /// is not sought where the cheapest is wanted. @param plans  its result's.
  void BeginWith(Search* earlier, std::vector<Plan> plans) {
    plans_.TakeOver(&earlier->plans_, std::move(plans));
  }
  bool gave_up_recursion() const { return gave_up_recursion_; }
  bool stopped() const { return limits_.stopped(); }
  bool has_enough() const { return plans_.enough(); }

 private:
  /// A place where several tasks were ready; `node` is the one that was taken.
  struct TaskChoice {
    SearchPath::Moment moment;
    std::uint32_t node;
  };
  using Choice = std::variant<MethodChoice, TaskChoice>;

  bool Forward();
  bool Backward();
  bool Process(std::uint32_t node);
  bool Decompose(std::uint32_t node, const std::vector<const CompiledMethod*>& methods);
  bool TryNext(MethodChoice* choice);
  bool TryNext(TaskChoice* choice);
  const std::vector<const CompiledMethod*>& MethodsOf(Term task);
  bool IsGivenUp(std::uint32_t node, Term task);
  bool GoalHolds();
  bool Ask();
  Progress CurrentProgress() const;

  const Program& program_;
  const bool left_recursion_;
  bool gave_up_recursion_{false};
  SearchPath path_;
  SearchLimits limits_;
  SearchTrace trace_;
  FoundPlans plans_;
  Decomposer decomposer_;
  OperatorApplier applier_;
  std::vector<const CompiledMethod*> root_methods_;
  std::vector<Choice> choices_;
};

}  // namespace hires::planning
