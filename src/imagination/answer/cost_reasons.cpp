#include "hires/imagination/cost_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

using base::FailureCode;

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

CostComparison CompareCosts(const Evidence& its, const Evidence& other) {
  HIRES_CHECK(its.cost && other.cost, "nothing was played, or nothing is priced");
  const CostPosterior& own = its.cost->posterior;
  const CostPosterior& others = other.cost->posterior;
  CostComparison comparison;
  comparison.time_saved = others.duration - own.duration;
  comparison.failures_more =
      own.FailureProbability() * own.penalty - others.FailureProbability() * others.penalty;
  comparison.failures_more_upper =
      std::max(comparison.failures_more, (1.0 - its.success.lower) * own.penalty -
                                             (1.0 - other.success.upper) * others.penalty);
  comparison.neither_failed = own.failures + others.failures == 0.0;
  comparison.probability = OddsOf({own, others}).probability.front();
  return comparison;
}

std::optional<TurningPrice> TurningPriceOf(const std::vector<Evidence>& alternatives,
                                           const Criteria& criteria, int best) {
  std::map<FailureCode, int> request;
  int failures = 0;
  for (const Evidence& evidence : alternatives) {
    for (const auto& [code, count] : CountsOf(evidence)) {
      request[code] += count;
      failures += count;
    }
  }
  // Expected cost is linear in each price: this many seconds for each.
  const auto slope = [&](const Evidence& evidence, FailureCode code) {
    const CostPosterior& posterior = evidence.cost->posterior;
    return posterior.FailureProbability() *
           (CountsOf(evidence)[code] + 1.0 * request[code] / failures) / (posterior.failures + 1.0);
  };
  const Evidence& winner = alternatives[best];
  std::optional<TurningPrice> nearest;
  double nearest_distance = 0.0;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    const Evidence& other = alternatives[i];
    if (static_cast<int>(i) == best || !IsGoodEnough(other, criteria)) continue;
    for (const auto& [code, count] : request) {
      const double steeper = slope(winner, code) - slope(other, code);
      if (steeper == 0.0) continue;
      const double present = PriceOf(code, criteria.prices);
      const double price = present + (other.cost->mean - winner.cost->mean) / steeper;
      if (price < 0.0 || price > kHighestPrice) continue;
      const double distance = Distance(price, present);
      if (nearest && distance >= nearest_distance) continue;
      nearest = TurningPrice{code, price, steeper < 0.0, static_cast<int>(i)};
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::optional<CostReasons> CostReasonsOf(const std::vector<Evidence>& alternatives,
                                         const Criteria& criteria) {
  if (criteria.rule != RankingRule::kCost) return std::nullopt;
  const std::optional<int> best = Recommended(alternatives, criteria);
  if (!best) return std::nullopt;
  CostReasons reasons;
  const CostOdds odds = CostOddsOf(alternatives, criteria, *best);
  reasons.probability = odds.probability;
  reasons.regret = odds.regret;
  if (reasons.IsClose()) reasons.until_settled = RolloutsToSettle(alternatives, criteria);
  for (const Evidence& evidence : alternatives) {
    if (!IsGoodEnough(evidence, criteria)) continue;
    for (const auto& [code, count] : CountsOf(evidence)) {
      reasons.prices[code] = PriceOf(code, criteria.prices);
    }
  }
  if (alternatives.size() < 2) return reasons;
  const int next = Rank(alternatives, criteria)[1];
  if (IsGoodEnough(alternatives[next], criteria)) {
    reasons.next = CompareCosts(alternatives[*best], alternatives[next]);
    reasons.next->other = next;
    if (reasons.prices.empty()) {
      const double assumed = alternatives[next].cost->posterior.penalty;
      const double fall = PriceOf(FailureCode::kObjectFell, criteria.prices);
      reasons.prices[assumed == fall ? FailureCode::kObjectFell : FailureCode::kOther] = assumed;
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
