#include "planning/search/passes.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "planning/search/search.h"

namespace hires::planning {
namespace {

constexpr std::uint64_t kFirstBudget = 50'000;  // expansions; a twentieth of a second or so
constexpr std::uint64_t kGrowth = 4;

/// Plays searches one after the other, and counts what all of them took.
class Passes {
 public:
  Passes(const Program& program, TermTable* terms, const PlanRequest& request)
      : program_(program),
        terms_(terms),
        wanted_(request),
        request_(request),
        is_ordered_(!program.leaves_order_open()) {
    if (!request.stop) return;
    request_.stop = [this](const Progress& progress) { return wanted_.stop(Sum(progress)); };
  }

  PlanResult Run() { return wanted_.which == Which::kFirst ? FindFirst() : FindMore(); }

 private:
  /// One search that went to its end. False: its budget was spent.
  bool Play(const SearchMode& mode, PlanResult* result) {
    Search search(program_, terms_, request_, mode);
    *result = search.Run();
    Add(&search, result);
    return !search.is_spent();
  }

  void Add(Search* search, PlanResult* result) {
    result->progress = Sum(result->progress);
    before_ = result->progress;
    has_stopped_ = search->stopped() && !search->is_spent();
    gave_up_recursion_ = search->gave_up_recursion();
  }

  Progress Sum(Progress progress) const {
    progress.expansions += before_.expansions;
    progress.inferences += before_.inferences;
    progress.bytes = std::max(progress.bytes, before_.bytes);
    return progress;
  }

  bool IsAnswered(const PlanResult& result) const {
    return has_stopped_ || result.outcome == PlanOutcome::kFound;
  }

  PlanResult FindFirst() {
    PlanResult result;
    bool one_by_one = !is_ordered_;
    for (std::uint64_t budget = kFirstBudget;; budget *= kGrowth) {
      if (one_by_one) {
        one_by_one = !Play({0, false, budget, true}, &result);
        if (IsAnswered(result)) return result;
      }
      if (!Play({0, true, one_by_one ? budget : SearchLimits::kAnyNumber, is_ordered_}, &result))
        continue;
      if (result.outcome != PlanOutcome::kNoPlan || !gave_up_recursion_) return result;
      return FindFirstWithRecursion();
    }
  }

  PlanResult FindFirstWithRecursion() {
    PlanResult result;
    std::vector<int> bounds{1};
    for (std::uint64_t budget = kFirstBudget;; budget *= kGrowth) {
      for (auto bound = bounds.begin(); bound != bounds.end();) {
        const bool is_over = Play({*bound, true, budget, is_ordered_}, &result);
        if (IsAnswered(result)) return result;
        if (is_over && (result.outcome != PlanOutcome::kNoPlan || !gave_up_recursion_))
          return result;
        last_bound_ = std::max(last_bound_, *bound);
        bound = is_over ? bounds.erase(bound) : bound + 1;
      }
      bounds.push_back(2 * last_bound_);
    }
  }

  SearchMode Bounded(int most_repeats) const {
    return {most_repeats, true, SearchLimits::kAnyNumber, is_ordered_};
  }

  /// The cheapest plan, or all.
  PlanResult FindMore() {
    auto search = std::make_unique<Search>(program_, terms_, request_, Bounded(0));
    PlanResult result = search->Run();
    Add(search.get(), &result);
    for (int bound = 1;; bound *= 2) {
      if (has_stopped_ || search->has_enough() || !gave_up_recursion_) return result;
      if (bound / 2 >= request_.max_depth) return result;
      auto next = std::make_unique<Search>(program_, terms_, request_, Bounded(bound));
      next->BeginWith(search.get(), std::move(result.plans));
      search = std::move(next);
      result = search->Run();
      Add(search.get(), &result);
    }
  }

  const Program& program_;
  TermTable* terms_;
  const PlanRequest& wanted_;
  PlanRequest request_;
  const bool is_ordered_;  // all tasks
  Progress before_;        ///< of the searches that are over
  bool has_stopped_{false};
  bool gave_up_recursion_{false};
  int last_bound_{1};
};

}  // namespace

PlanResult FindHddlPlans(const Program& program, TermTable* terms, const PlanRequest& request) {
  return Passes(program, terms, request).Run();
}

}  // namespace hires::planning
