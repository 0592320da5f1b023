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

  /// Until a search went to its end and left nothing out for its recursion, or enough is found. The
  /// one without repeats has half of the time at least.
  PlanResult Run() {
    PlanResult result;
    bool one_by_one = !is_ordered_ && wanted_.which == Which::kFirst;
    std::vector<SearchMode> modes{ModeOf(0, true)};
    bool is_recursive = false;
    for (std::uint64_t budget = kFirstBudget;; budget *= kGrowth) {
      if (one_by_one) {
        one_by_one = !Play({0, true, false, budget, true}, &result);
        if (is_answered_) return result;
      }
      const std::uint64_t share = budget / std::max<std::size_t>(modes.size() - 1, 1);
      for (auto mode = modes.begin(); mode != modes.end();) {
        const bool is_main = mode->most_repeats == 0 && mode->repeats_across_steps;
        mode->budget = is_main ? budget : share;
        const bool is_over = Play(*mode, &result);
        if (is_answered_ || (is_over && is_whole_)) return result;
        is_recursive = is_recursive || !is_whole_;
        mode = is_over ? modes.erase(mode) : mode + 1;
      }
      const bool is_deepest = next_.most_repeats / 2 > request_.max_depth;
      if (is_deepest && modes.empty()) return result;
      if (is_recursive && !is_deepest) {
        modes.push_back(next_);
        next_ = ModeOf(std::max(1, 2 * next_.most_repeats), true);
      }
    }
  }

 private:
  /// One search, in addition to what was found. False: its budget was spent.
  bool Play(const SearchMode& mode, PlanResult* result) {
    auto search = std::make_unique<Search>(program_, terms_, request_, mode);
    if (last_) search->BeginWith(last_.get(), std::move(result->plans));
    last_.reset();
    *result = search->Run();
    result->progress = Sum(result->progress);
    before_ = result->progress;
    const bool is_spent = search->is_spent();
    is_answered_ = search->has_enough() || (search->stopped() && !is_spent);
    is_whole_ = !search->gave_up_recursion();
    last_ = std::move(search);
    return !is_spent;
  }

  SearchMode ModeOf(int most_repeats, bool across_steps) const {
    return {most_repeats, across_steps, true, 0, is_ordered_};
  }

  Progress Sum(Progress progress) const {
    progress.expansions += before_.expansions;
    progress.inferences += before_.inferences;
    progress.bytes = std::max(progress.bytes, before_.bytes);
    return progress;
  }

  const Program& program_;
  TermTable* terms_;
  const PlanRequest& wanted_;
  PlanRequest request_;
  const bool is_ordered_;  // all tasks
  Progress before_;        ///< of the searches that are over
  /// What is played next besides, where tasks come up below themselves: at first what lets them
  /// once steps were taken, then more and more repeats.
  SearchMode next_{ModeOf(0, false)};
  std::unique_ptr<Search> last_;
  bool is_answered_{false};  // enough was found, or the caller wants no more
  bool is_whole_{false};     // the last search left nothing out for its recursion
};

}  // namespace

PlanResult FindHddlPlans(const Program& program, TermTable* terms, const PlanRequest& request) {
  return Passes(program, terms, request).Run();
}

}  // namespace hires::planning
