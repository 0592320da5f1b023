#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/prices.h"
#include "hires/imagination/rollout_result.h"
#include "hires/imagination/success_interval.h"

namespace hires::imagination {

/// Weights of Eq. 6.1.
struct ConfidenceCoefficients {
  double topple{100.0};
  double shaking{10.0};
  double notopple{1.0};
};

/// Dissertation, Eq. 6.1: (a_t + a_s + a_n) / (100 a_t + 10 a_s + a_n), in (0, 1]; 0 when there is
/// no sample.
double Confidence(const OutcomeCounts& counts, const ConfidenceCoefficients& coefficients = {});

/// Eq. 6.1 of one rollout; 0 when its action failed (see ActionFailed), 1 when it succeeded and
/// there was nothing to watch.
double RolloutConfidence(const RolloutResult& result);

/// The smallest value with at least `percent` % of the values at or below it: definition 1 of
/// [Hyndman, Fan 1996, Am. Stat. 50:361-365].
/// @pre there are some; 0 <= percent <= 100.
double Quantile(const std::vector<double>& ascending, int percent);

/// All that is known about one parametrisation of an action from its first n rollouts.
/// Each quantile is of a rollout that was really played (see Quantile), and duration.p50 is the
/// duration of median_rollout.
struct Evidence {
  double confidence_pooled{0.0};    ///< Eq. 6.1 on the summed counts; 0 when more than half of the
                                    ///< rollouts failed to act, else 1 if nothing was watched
  double confidence_mean{0.0};      ///< mean of Eq. 6.1 per rollout, 0 for one whose action failed
  SuccessInterval success;          ///< goal reached and nothing fell; timed out counts as failed
  double fall_share{0.0};           ///< rollouts in which something fell
  double action_failed_share{0.0};  ///< rollouts whose action failed (see ActionFailed)
  OutcomeCounts counts;             ///< of all rollouts
  int falls{0};
  struct {
    double mean{0.0}, sd{0.0}, p50{0.0}, p95{0.0};
  } duration;  ///< [s], of rollouts whose action did not fail; sd divides by their number
  std::vector<double> durations;  ///< [s] of the same rollouts, ascending
  struct {
    double p50{0.0}, p95{0.0};
  } max_tilt;                        ///< [rad], of rollouts with samples
  std::vector<double> max_tilts;     ///< [rad] of the same rollouts, ascending
  std::optional<ExpectedCost> cost;  ///< none: nothing is priced, or nothing was played
  int num_rollouts{0};
  std::map<base::Failure, int> failures;    ///< failure -> rollouts
  std::map<std::string, int> first_causes;  ///< what began it -> rollouts; those with a cause alone
  int worst_rollout{-1};  ///< index of the one that leaned most among those that failed, else among
                          ///< all; the first of equals; -1 when there is none
  int first_failed{-1};   ///< index of the first one that is no success; -1 when there is none
  int median_rollout{-1};  ///< index of the finished rollout with the median duration, the first
                           ///< of equals; -1 when there is none
};

/// Why one of another process cannot be used: durations or tilts that are not finite, not in
/// ascending order, or more than its rollouts; empty if it can.
std::string DefectOf(const Evidence& evidence);

/// @param results  the first n rollouts of one alternative, in index order, where n was fixed
/// beforehand; nothing is priced.
Evidence SumUp(const std::vector<RolloutResult>& results);

/// The same of the first `num_rollouts` of `results` alone.
/// @param kind  what fits how that number came about.
/// @pre 0 <= num_rollouts <= results.size().
Evidence SumUp(const std::vector<RolloutResult>& results, int num_rollouts,
               IntervalKind kind = IntervalKind::kClopperPearson, const Prices& prices = {});

/// All alternatives of one request: where nothing or little failed, the penalty of a failure is
/// that of the request (PseudoPenalty).
std::vector<Evidence> SumUpRequest(const std::vector<RolloutPrefix>& request, IntervalKind kind,
                                   const Prices& prices);

}  // namespace hires::imagination
