#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/failure.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/expected_regret.h"
#include "hires/imagination/rollout_result.h"
#include "hires/imagination/success_interval.h"

namespace hires::imagination {

inline constexpr double kHighestPrice = 1e5;  ///< [s] about a day

inline constexpr double kPenaltyOfTipping = 900.0;  ///< [s] of robot_tips, where a file has none

/// What failures cost, as seconds of the robot's and of people's time: config/prices.yaml.
struct Prices {
  std::map<base::FailureCode, double> of;  ///< [s] per code, >= 0; empty: nothing is priced
  double time_limit{300.0};  ///< [s] a rollout counts as no longer than this (RolloutParams)
  double late{0.0};          ///< [s] for each second beyond the deadline, >= 0
  double not_done{0.0};      ///< [s] of a task that nobody begins, >= 0; no rollout costs that
  double deadline{std::numeric_limits<double>::infinity()};  ///< [s] after the action's begin

  bool empty() const { return of.empty(); }
  double Highest() const;  ///< [s] what a rollout costs at most, however late it is
};

/// Whether an imagined rollout may end with this code: those of things, of the way and of
/// imagination itself; not those of a robot's drivers and of plans.
bool EndsRollouts(base::FailureCode code);

/// @throws base::ConfigError naming file and key: a word that is no failure code, a code that ends
/// no rollout, a code without its price, a price out of range. A file of an earlier version without
/// robot_tips gets kPenaltyOfTipping, with one warning.
Prices ReadPrices(base::ParamReader in);

/// The same where all failures, lateness included, cost `factor` times as much.  @pre factor >= 0.
Prices Scaled(Prices prices, double factor);

/// [s] an action that takes so long: its duration, at most the time limit, and what it is late.
double CostOfTime(double duration, const Prices& prices);

/// [s] of one failure. A code that has no price of its own (see EndsRollouts) costs as `other`;
/// kNone costs nothing.  @pre prices are not empty.
double PriceOf(base::FailureCode code, const Prices& prices);

/// [s] CostOfTime plus the price of the rollout's failure.  @pre prices are not empty.
double CostOf(const RolloutResult& result, const Prices& prices);

/// Expected cost of one alternative, as far as its rollouts tell [s].
struct ExpectedCost {
  double mean{0.0};   ///< posterior.Mean()
  double lower{0.0};  ///< lower end of the 95 % interval
  double upper{0.0};  ///< upper end of the 95 % interval
  CostPosterior posterior;
};

/// The first `num_rollouts` rollouts of one alternative.
struct RolloutPrefix {
  const std::vector<RolloutResult>* results;
  int num_rollouts;  ///< 0 .. results->size()
};

/// [s] penalty of the one pseudo-failure that each alternative of a request is given: the mean over
/// all failures of the request; without failures that of dropping the payload, or `other` where no
/// rollout watched one.  @pre prices are not empty.
double PseudoPenalty(const std::vector<RolloutPrefix>& request, const Prices& prices);

/// If few failed, all alike and no cheaper than dropping the payload, the 95 % interval adds one of
/// the mean duration (an asymptotic confidence sequence [Waudby-Smith et al. 2024, Ann. Stat.
/// 52:2613-2640], cut at the time limit) and the penalty times one of the probability of failing
/// (EstimateSuccess). Else it is a MeanSequence of costs. It never reaches below the shortest
/// duration that was observed, and is valid at every number of rollouts, as far as `kind` is.
/// @return none: no prices, or no rollout.
std::optional<ExpectedCost> EstimateCost(const RolloutPrefix& rollouts, const Prices& prices,
                                         double pseudo_penalty,
                                         IntervalKind kind = IntervalKind::kConfidenceSequence);

}  // namespace hires::imagination
