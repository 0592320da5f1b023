#pragma once

#include <optional>
#include <vector>

namespace hires::imagination {

/// Posterior of the expected cost of one alternative, C = T + p c [s]: the mean duration T is
/// normal, the probability p of failing at all is Beta(failures + 1/2, rollouts - failures + 1/2)
/// (one Jeffreys prior, whatever the failure codes), the mean penalty c of a failure is taken as
/// known. Different alternatives are independent: common random numbers correlate costs positively,
/// so that the variance of a difference is overestimated and rollouts stop late rather than early;
/// in return each alternative may have its own number of rollouts.
struct CostPosterior {
  double duration{0.0};     ///< [s] mean over all rollouts
  double duration_sd{0.0};  ///< [s] standard error of that mean, >= 0
  double penalty{0.0};      ///< [s] mean penalty of a failure, >= 0
  double failures{0.0};     ///< 0 .. rollouts
  double rollouts{1.0};     ///< positive

  double FailureProbability() const { return (failures + 0.5) / (rollouts + 1.0); }
  double Mean() const { return duration + FailureProbability() * penalty; }
  double Variance() const;  ///< [s^2]
};

/// Per alternative.
struct BestOdds {
  std::vector<double> probability;  ///< that it has the lowest expected cost
  std::vector<double> regret;       ///< [s] expected opportunity cost (linear loss):
                                    ///< E[max(0, C - the lowest of the others)]
};

/// @pre at least one alternative.
BestOdds OddsOf(const std::vector<CostPosterior>& alternatives);

/// Splits a round of about `size` rollouts so that the expected opportunity cost of `best` falls
/// most: totals proportional to sqrt(s^2 eta), with s^2 the variance of one rollout and eta_i =
/// phi(d_i / w_i) / w_i for a rival at distance d_i, w_i the standard deviation of the difference;
/// their sum for the best [linear loss: Chick, Inoue 2001, Oper. Res. 49:732-743; cf. OCBA, Chen et
/// al. 2000, Discrete Event Dyn. Syst. 10:251-270].
/// @param room  per alternative, at most so many more.
/// @return per alternative; all 0 only where there is no room.
std::vector<int> AllocateRound(const std::vector<CostPosterior>& alternatives, int best, int size,
                               const std::vector<int>& room);

/// About how many rollouts of each alternative would make one of them the cheapest with at least
/// `probability`, if durations and failures continue at their rates; none: more than `most`.
std::optional<int> RolloutsToSettle(const std::vector<CostPosterior>& alternatives,
                                    double probability, int most);

}  // namespace hires::imagination
