#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/ranking.h"

namespace hires::imagination {

/// One alternative against another one by what they cost, rollout by rollout: those of one index
/// have the same seed. All means [s] are of those rollouts.
struct CostComparison {
  int other{-1};                    ///< index of the alternative that it is compared with
  double time_saved{0.0};           ///< CostOfTime of the other one less its own
  double failures_more{0.0};        ///< price of its failures less those of the other one
  double failures_more_upper{0.0};  ///< upper end of the 95 % interval, valid at every number of
                                    ///< rollouts; failures that were not seen are weighed in it
  bool neither_failed{false};
  double probability{0.0};  ///< that it costs less than the other one, see CompareCosts

  /// It is the quicker one, and its failures are no reason to take the other one.
  bool IsAlike() const {
    return time_saved > 0.0 && (neither_failed || failures_more_upper < time_saved);
  }
};

/// The probability takes seconds as they were measured. Rollouts in which the failure of one is
/// dearer than that of the other are Dirichlet distributed with half a rollout of each kind added
/// (Jeffreys), each kind with its mean difference of prices; of a kind that was never seen, with
/// the dearest failure that either had, or else with the dearest of all.
/// @pre 1 <= num_rollouts, and as many results; prices are not empty.
CostComparison CompareCosts(const std::vector<RolloutResult>& results,
                            const std::vector<RolloutResult>& other, int num_rollouts,
                            const Prices& prices);

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
  /// Of failures that occurred in alternatives that are good enough: those that were weighed; of
  /// a fall where none did, but more than one is good enough.
  std::map<base::FailureCode, double> prices;
  std::optional<CostComparison> next;  ///< with the next one of the order, if it is good enough
  std::optional<TurningPrice> turning;
  /// All rollouts are of one and the same truth: how many there are says nothing of what may have
  /// stayed unseen.
  bool is_one_truth{false};
};

/// None where the rule is not kCost or nothing is recommended.
/// @param results  per alternative the rollouts behind its evidence, or more.
std::optional<CostReasons> CostReasonsOf(
    const std::vector<const std::vector<RolloutResult>*>& results,
    const std::vector<Evidence>& alternatives, const Criteria& criteria);

/// "a fall costs 600 s, no_path costs 60 s".
std::string PriceSentence(const CostReasons& reasons);

/// "slow would be taken if a fall cost less than 85 s".
std::string TurningSentence(const TurningPrice& turning, const std::vector<std::string>& names);

}  // namespace hires::imagination
