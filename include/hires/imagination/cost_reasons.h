#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/ranking.h"

namespace hires::imagination {

/// One alternative against another one by what they cost, as far as their posteriors tell.
struct CostComparison {
  int other{-1};                    ///< index of the alternative that it is compared with
  double time_saved{0.0};           ///< [s] mean duration of the other one less its own
  double failures_more{0.0};        ///< [s] expected penalty of its failures less the other's
  double failures_more_upper{0.0};  ///< [s] upper end of the 95 % interval, valid as the intervals
                                    ///< of success are
  bool neither_failed{false};
  double probability{0.0};  ///< that its expected cost is lower
};

/// @pre both are priced.
CostComparison CompareCosts(const Evidence& its, const Evidence& other);

/// The price at which another alternative would be recommended, all other prices staying.
struct TurningPrice {
  base::FailureCode code{base::FailureCode::kNone};
  double price{0.0};    ///< [s]
  bool is_below{true};  ///< it turns where the failure costs less than that; else more
  int other{-1};        ///< index of the alternative that would then be recommended
};

/// Of all prices that turn the answer the one nearest to what the failure costs, by ratio. None:
/// no price between 0 and kHighestPrice does.  @pre kCost, best == Recommended(...).
std::optional<TurningPrice> TurningPriceOf(const std::vector<Evidence>& alternatives,
                                           const Criteria& criteria, int best);

/// What stands behind a recommendation by cost.
struct CostReasons {
  double probability{1.0};           ///< P(best), see CostOddsOf
  double regret{0.0};                ///< [s] expected opportunity cost
  std::optional<int> until_settled;  ///< of a near tie, see RolloutsToSettle
  /// Of failures that occurred in alternatives that are good enough: those that were weighed; of
  /// the assumed failure (PseudoPenalty) where none did, but more than one is good enough.
  std::map<base::FailureCode, double> prices;
  std::optional<CostComparison> next;  ///< with the next one of the order, if it is good enough
  std::optional<TurningPrice> turning;
  /// All rollouts are of one and the same truth: how many there are says nothing of what may have
  /// stayed unseen.
  bool is_one_truth{false};

  bool IsClose() const { return probability < kSettledProbability; }
};

/// None where the rule is not kCost or nothing is recommended.
std::optional<CostReasons> CostReasonsOf(const std::vector<Evidence>& alternatives,
                                         const Criteria& criteria);

/// "a fall costs 600 s, no_path costs 60 s".
std::string PriceSentence(const CostReasons& reasons);

/// "slow would be taken if a fall cost less than 85 s".
std::string TurningSentence(const TurningPrice& turning, const std::vector<std::string>& names);

}  // namespace hires::imagination
