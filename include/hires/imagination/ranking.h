#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/evidence.h"

namespace hires::imagination {

inline constexpr int kMostRollouts{100000};  ///< of each alternative that may be asked for

struct CostReasons;  // cost_reasons.h

/// By what alternatives are ordered; a later criterion decides where the earlier ones are equal.
enum class RankingRule {
  kRisk,   ///< lower bound of success, then mean Eq. 6.1, then mean duration
  kCost,   ///< those that reach min_success first, then expected cost, then mean Eq. 6.1; each
           ///< alternative may have its own number of rollouts
  kThesis  ///< action failed in most rollouts: out; then mean Eq. 6.1, then mean duration
};

/// "risk", "cost" or "thesis".  @throws base::ConfigError naming what came and what is known.
RankingRule ParseRankingRule(const std::string& name);
std::string ToString(RankingRule rule);

/// What makes one alternative better than another, and good enough to be recommended.
struct Criteria {
  /// Without prices; config/imagination_client.yaml, which names them, says kCost.
  RankingRule rule{RankingRule::kRisk};
  /// Share of successes that the lower end of the interval must reach; in (0, 1). Not for kThesis.
  double min_success{0.5};
  Prices prices;  ///< needed by kCost (ReadPrices); else they only fill Evidence::cost
  /// [s] kCost alone: expected opportunity cost of the cheapest alternative at which rollouts stop.
  double max_regret{2.0};
};

/// Under kCost a recommendation with a lower probability of being the cheapest is a near tie.
inline constexpr double kSettledProbability{0.95};

/// Indices of the alternatives, best first. Full equals keep their order, an alternative without
/// any finished rollout is slower than every other. Under kThesis the ones that are out come last.
/// @pre all rest on the same number of rollouts (paired by index); for kCost instead they are
/// priced (SumUpRequest).
/// @throws std::logic_error
std::vector<int> Rank(const std::vector<Evidence>& alternatives, const Criteria& criteria);

/// The best alternative if it is good enough: its interval of success reaches min_success; under
/// kThesis, if it is not out. None before the first rollout.  @pre as Rank.
std::optional<int> Recommended(const std::vector<Evidence>& alternatives, const Criteria& criteria);

/// Whether no alternative is good enough, as far as these rollouts can tell: every interval lies
/// below min_success; under kThesis, every one is out. False before the first rollout.  @pre as
/// Rank.
bool AllFail(const std::vector<Evidence>& alternatives, const Criteria& criteria);

/// Under kCost: indices of the alternatives that reach min_success or may do so.
std::vector<int> Candidates(const std::vector<Evidence>& alternatives, const Criteria& criteria);

/// Of one candidate among all.
struct CostOdds {
  double probability{1.0};  ///< P(best): that it has the lowest expected cost
  double regret{0.0};       ///< [s] expected opportunity cost
};
CostOdds CostOddsOf(const std::vector<Evidence>& alternatives, const Criteria& criteria, int best);

/// About how many rollouts of each candidate would give one of them kSettledProbability; none: more
/// than kMostRollouts.  @pre kCost, at least one candidate.
std::optional<int> RolloutsToSettle(const std::vector<Evidence>& alternatives,
                                    const Criteria& criteria);

/// Under kCost: how many more rollouts each alternative gets before the next decision. Only zeros:
/// all alternatives fail, the expected regret of the recommended one is at most max_regret [EOC,
/// Branke, Chick, Schmidt 2007, Manage. Sci. 53:1916-1932], or there is no room. While none is
/// recommended, those that may reach min_success share the round equally, else see AllocateRound.
/// @param most  of each alternative in all.  @pre each has at least one rollout.
std::vector<int> NextRound(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                           int most);

/// One sentence for people with the numbers that decided, also where nothing is recommended; where
/// nothing is decided, with about how many rollouts would.
/// @param names  one per alternative, as people call them ("slow").
/// @param reasons  under kCost (see CostReasonsOf): P(best), expected regret, penalties, where the
///                 answer turns; without them it names the expected costs alone.
/// @pre names.size() == alternatives.size(), and as Rank.
std::string WhyRecommended(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                           const std::vector<std::string>& names,
                           const CostReasons* reasons = nullptr);

/// About how many rollouts of each alternative would likely take "undecided" away: until the first
/// one reaches min_success, or all lie below it. None: more than kMostRollouts.
/// @pre not kThesis, at least one alternative and one rollout.
std::optional<int> RolloutsToDecide(const std::vector<Evidence>& alternatives,
                                    const Criteria& criteria);

struct SettleParams {
  double alpha{0.05};         ///< chance that any claim made at any look is wrong; in (0, 1)
  double indifference{0.05};  ///< a difference in success, confidence or share of quicker rollouts
                              ///< below this counts as none; in (0, 1)
  bool only_best{false};      ///< true: who is first is enough, the order behind may stay open
};

/// Whether more rollouts may still change the order that Rank gives after the first `num_rollouts`
/// rollouts of each alternative; true means no, as far as these rollouts can tell.
///
/// Each pair is judged by its paired differences, criterion by criterion in the order of the rule.
/// A criterion settles the pair if a confidence sequence of the mean difference excludes 0 on the
/// side of the present order; it is passed over if the sequence lies within the indifference; in
/// all other cases the pair stays open. Judged are the neighbours in the present order (or the
/// first against each other one). A pair whose criteria were all passed over is settled: either
/// order costs less than the indifference. Durations have no bound, so the difference is taken of
/// their signs: who was quicker, 1 or -1, 0 for equal or both failed; the one that failed is
/// slower. Under kThesis being in or out must be certain for both (share of failed actions against
/// 1/2).
///
/// The error probability alpha is divided by the number of all sequences there are (every pair
/// with every criterion, every alternative where one is judged alone), so it covers all
/// alternatives and all looks together, however often this is called with growing prefixes of the
/// same rollouts. One alternative alone is always settled.
/// @param results  per alternative its rollouts in index order, each at least num_rollouts long.
/// @pre not kCost (see NextRound); num_rollouts >= 1; params within their ranges.
/// @throws std::logic_error if broken.
bool Settled(const std::vector<std::vector<RolloutResult>>& results, int num_rollouts,
             const Criteria& criteria, const SettleParams& params);

/// The same for rollouts that are kept apart.  @pre as above, and no nullptr.
bool Settled(const std::vector<const std::vector<RolloutResult>*>& results, int num_rollouts,
             const Criteria& criteria, const SettleParams& params);

/// Whether more rollouts may still change the answer: no, once all alternatives fail for certain,
/// or one is good enough and the order is settled. Under kThesis the order alone counts.  @pre as
/// above.
bool Decided(const std::vector<const std::vector<RolloutResult>*>& results, int num_rollouts,
             const Criteria& criteria, const SettleParams& params);

}  // namespace hires::imagination
