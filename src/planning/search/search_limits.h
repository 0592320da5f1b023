#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "hires/planning/planner.h"

namespace hires::planning {

/// How far a search may go: the caller's question whether to stop, depth and cost of a path. What
/// was given up for that reason decides between "there is no plan" and "a limit came first".
class SearchLimits {
 public:
  static constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

  /// @param request  Is referred to.
  /// @param budget  Expansions after which the search stops by itself, at the next question.
  explicit SearchLimits(const PlanRequest& request, std::uint64_t budget = kAnyNumber)
      : request_(request), budget_(budget) {}

  /// True once every 256 expansions: it is time to ask.
  bool CountExpansion() { return ++expansions_ % kQuestionEvery == 0; }
  std::uint64_t expansions() const { return expansions_; }

  /// Asks the caller. True: the search has to stop, now and for good.
  bool Ask(const Progress& progress);
  bool stopped() const { return is_spent_ || stop_ != Stop::kContinue; }
  bool is_spent() const { return is_spent_ && stop_ == Stop::kContinue; }  ///< its budget is
  std::size_t most_bytes() const { return most_bytes_; }                   ///< of all questions

  /// Whether a path ends here; remembers that one did.
  bool IsTooDeep(int depth);
  bool IsTooDear(double cost);
  bool was_too_deep() const { return too_deep_; }
  /// No path was given up, and the caller did not stop the search.
  bool none_reached() const { return !stopped() && !too_deep_ && !too_dear_; }

  PlanOutcome Outcome(bool found) const;

 private:
  static constexpr std::uint64_t kQuestionEvery = 256;

  const PlanRequest& request_;
  const std::uint64_t budget_;
  std::uint64_t expansions_{0};
  bool is_spent_{false};
  std::size_t most_bytes_{0};
  Stop stop_{Stop::kContinue};
  bool too_deep_{false};
  bool too_dear_{false};
};

}  // namespace hires::planning
