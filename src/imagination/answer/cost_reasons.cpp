#include "hires/imagination/cost_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "imagination/answer/confidence_sequence.h"

namespace hires::imagination {
namespace {

using base::FailureCode;

/// Rollouts in which the failure of one was dearer than that of the other.
struct Dearer {
  int count{0};
  double sum{0.0};  // [s] of the differences

  void Add(double difference) {
    ++count;
    sum += difference;
  }
  double MeanOr(double unseen) const { return count > 0 ? sum / count : unseen; }
};

double Share(double a, double b, double x) {
  return boost::math::cdf(boost::math::beta_distribution<>(a, b), std::clamp(x, 0.0, 1.0));
}

/// That the failures of one cost less than `saved` more than those of the other: the share of
/// rollouts that tell them apart is one beta distribution, whose midpoints of equal weight are
/// summed up, and to whom those fall is another one.
double ProbabilityOf(double saved, const Dearer& its, const Dearer& others, int num_rollouts,
                     double unseen) {
  const double own_price = its.MeanOr(unseen), other_price = others.MeanOr(unseen);
  if (own_price + other_price <= 0.0) return saved > 0.0 ? 1.0 : saved < 0.0 ? 0.0 : 0.5;
  constexpr int kMidpoints = 200;
  const int apart = its.count + others.count;
  const boost::math::beta_distribution<> share_apart(apart + 1.0, num_rollouts - apart + 0.5);
  double sum = 0.0;
  for (int i = 0; i < kMidpoints; ++i) {
    const double share = boost::math::quantile(share_apart, (i + 0.5) / kMidpoints);
    const double bound = (saved / share + other_price) / (own_price + other_price);
    sum += Share(its.count + 0.5, others.count + 0.5, bound);
  }
  return sum / kMidpoints;
}

double HighestPrice(const Prices& prices) {
  double highest = 0.0;
  for (const auto& [code, price] : prices.of) highest = std::max(highest, price);
  return highest;
}

std::map<FailureCode, int> CountsOf(const Evidence& evidence) {
  std::map<FailureCode, int> counts;
  for (const auto& [failure, count] : evidence.failures) counts[failure.code] += count;
  return counts;
}

bool IsGoodEnough(const Evidence& evidence, const Criteria& criteria) {
  return Judge(evidence.success, criteria.min_success) == Suitability::kReached;
}

/// How far it is from one price to another, by ratio; from or to nothing it is far.
double Distance(double price, double other) {
  return std::abs(std::log(std::max(price, 1e-3)) - std::log(std::max(other, 1e-3)));
}

/// "a fall"; other codes as tables call them.
std::string NameOf(FailureCode code) {
  return code == FailureCode::kObjectFell ? "a fall" : base::ToString(code);
}

/// "600 s", "2.5 s".
std::string PriceText(double price) {
  const bool is_whole = price >= 100.0 || price == std::round(price);
  return fmt::format("{:.{}f} s", price, is_whole ? 0 : 1);
}

}  // namespace

CostComparison CompareCosts(const std::vector<RolloutResult>& results,
                            const std::vector<RolloutResult>& other, int num_rollouts,
                            const Prices& prices) {
  HIRES_CHECK(num_rollouts >= 1 && !prices.empty(), "nothing was played, or nothing is priced");
  const double highest = HighestPrice(prices);
  MeanSequence more(-highest - 1e-9, highest + 1e-9, kAlpha);  // prices may all be 0
  Dearer its, others;
  double saved = 0.0, dearest_seen = 0.0;
  bool failed = false;
  for (int i = 0; i < num_rollouts; ++i) {
    const base::Failure own_failure = FailureOf(results[i]), other_failure = FailureOf(other[i]);
    const double own_price = PriceOf(own_failure.code, prices);
    const double other_price = PriceOf(other_failure.code, prices);
    saved += CostOfTime(other[i].duration, prices) - CostOfTime(results[i].duration, prices);
    failed = failed || own_failure || other_failure;
    dearest_seen = std::max({dearest_seen, own_price, other_price});
    more.Add(own_price - other_price);
    if (own_price > other_price) its.Add(own_price - other_price);
    if (other_price > own_price) others.Add(other_price - own_price);
  }
  CostComparison comparison;
  comparison.time_saved = saved / num_rollouts;
  comparison.failures_more = (its.sum - others.sum) / num_rollouts;
  comparison.failures_more_upper = std::max(comparison.failures_more, more.Bounds().upper);
  comparison.neither_failed = !failed;
  comparison.probability = ProbabilityOf(comparison.time_saved, its, others, num_rollouts,
                                         failed ? dearest_seen : highest);
  return comparison;
}

std::optional<TurningPrice> TurningPriceOf(const std::vector<Evidence>& alternatives,
                                           const Criteria& criteria, int best) {
  const Evidence& winner = alternatives[best];
  std::optional<TurningPrice> nearest;
  double nearest_distance = 0.0;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    const Evidence& other = alternatives[i];
    if (static_cast<int>(i) == best || !IsGoodEnough(other, criteria)) continue;
    std::map<FailureCode, int> more = CountsOf(other);  // than the winner has
    for (const auto& [code, count] : CountsOf(winner)) more[code] -= count;
    for (const auto& [code, count] : more) {
      if (count == 0) continue;
      const double present = PriceOf(code, criteria.prices);
      const double price =
          present - (other.cost->mean - winner.cost->mean) * winner.num_rollouts / count;
      if (price < 0.0 || price > kHighestPrice) continue;
      const double distance = Distance(price, present);
      if (nearest && distance >= nearest_distance) continue;
      nearest = TurningPrice{code, price, count > 0, static_cast<int>(i)};
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::optional<CostReasons> CostReasonsOf(
    const std::vector<const std::vector<RolloutResult>*>& results,
    const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  if (criteria.rule != RankingRule::kCost) return std::nullopt;
  const std::optional<int> best = Recommended(alternatives, criteria);
  if (!best) return std::nullopt;
  CostReasons reasons;
  for (const Evidence& evidence : alternatives) {
    if (!IsGoodEnough(evidence, criteria)) continue;
    for (const auto& [code, count] : CountsOf(evidence)) {
      reasons.prices[code] = PriceOf(code, criteria.prices);
    }
  }
  if (alternatives.size() < 2) return reasons;
  const int next = Rank(alternatives, criteria)[1];
  if (IsGoodEnough(alternatives[next], criteria)) {
    reasons.next = CompareCosts(*results[*best], *results[next], alternatives[*best].num_rollouts,
                                criteria.prices);
    reasons.next->other = next;
    // Where nothing failed it is a fall that may have stayed unseen.
    if (reasons.prices.empty()) {
      reasons.prices[FailureCode::kObjectFell] = PriceOf(FailureCode::kObjectFell, criteria.prices);
    }
  }
  reasons.turning = TurningPriceOf(alternatives, criteria, *best);
  return reasons;
}

std::string PriceSentence(const CostReasons& reasons) {
  std::vector<std::string> parts;
  for (const auto& [code, price] : reasons.prices) {
    parts.push_back(fmt::format("{} costs {}", NameOf(code), PriceText(price)));
  }
  return base::Join(parts, ", ");
}

std::string TurningSentence(const TurningPrice& turning, const std::vector<std::string>& names) {
  return fmt::format("{} would be taken if {} cost {} than {}", names[turning.other],
                     NameOf(turning.code), turning.is_below ? "less" : "more",
                     PriceText(turning.price));
}

}  // namespace hires::imagination
