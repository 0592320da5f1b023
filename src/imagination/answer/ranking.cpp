#include "hires/imagination/ranking.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "imagination/answer/ranking_key.h"

namespace hires::imagination {
namespace {

double DurationKey(const Evidence& evidence) {
  return evidence.median_rollout < 0 ? std::numeric_limits<double>::infinity()
                                     : evidence.duration.mean;
}

double CostKey(const Evidence& evidence) {
  HIRES_CHECK(evidence.cost || evidence.num_rollouts == 0, "ranked by cost, but nothing is priced");
  return evidence.cost ? evidence.cost->mean : 0.0;
}

void CheckPaired(const std::vector<Evidence>& alternatives, RankingRule rule) {
  if (rule == RankingRule::kCost) return;  // posteriors of their own
  for (const Evidence& evidence : alternatives) {
    HIRES_CHECK(evidence.num_rollouts == alternatives.front().num_rollouts,
                "alternatives are compared at different numbers of rollouts");
  }
}

Suitability SuitabilityOf(const Evidence& evidence, const Criteria& criteria) {
  if (criteria.rule != RankingRule::kThesis) return Judge(evidence.success, criteria.min_success);
  return IsOut(evidence) ? Suitability::kNotReached : Suitability::kReached;
}

/// A round of kCost: few enough to stop soon, enough for many workers.
constexpr int kSmallestRound = 16;
constexpr int kRoundsToDouble = 4;  // a round adds a quarter

std::vector<CostPosterior> PosteriorsOf(const std::vector<Evidence>& alternatives,
                                        const std::vector<int>& candidates) {
  std::vector<CostPosterior> posteriors;
  for (const int i : candidates) {
    const Evidence& evidence = alternatives[static_cast<std::size_t>(i)];
    HIRES_CHECK(evidence.cost, "ranked by cost, but nothing is priced");
    posteriors.push_back(evidence.cost->posterior);
  }
  return posteriors;
}

}  // namespace

bool IsOut(const Evidence& evidence) { return evidence.action_failed_share > 0.5; }

int NumSuccess(const Evidence& evidence) {
  int failures = 0;
  for (const auto& [failure, count] : evidence.failures) failures += count;
  return evidence.num_rollouts - failures;
}

Key KeyOf(const Evidence& evidence, const Criteria& criteria) {
  switch (criteria.rule) {
    case RankingRule::kRisk:
      return {-evidence.success.lower, -evidence.confidence_mean, DurationKey(evidence)};
    case RankingRule::kCost:
      return {static_cast<double>(SuitabilityOf(evidence, criteria)), CostKey(evidence),
              -evidence.confidence_mean};
    case RankingRule::kThesis:
      break;
  }
  return {IsOut(evidence) ? 1.0 : 0.0, -evidence.confidence_mean, DurationKey(evidence)};
}

RankingRule ParseRankingRule(const std::string& name) {
  const std::string lower = base::ToLower(name);
  for (const RankingRule rule : {RankingRule::kRisk, RankingRule::kCost, RankingRule::kThesis}) {
    if (lower == ToString(rule)) return rule;
  }
  throw base::ConfigError(
      base::UnknownName("ranking", name, {"cost", "risk", "thesis"}) +
      "; 'cost' weighs time and failures in seconds, 'risk' puts success first, "
      "'thesis' ranks as the dissertation does");
}

std::string ToString(RankingRule rule) {
  switch (rule) {
    case RankingRule::kRisk:
      return "risk";
    case RankingRule::kCost:
      return "cost";
    case RankingRule::kThesis:
      return "thesis";
  }
  HIRES_CHECK(false, "a ranking has no name");
  return {};
}

std::vector<int> Rank(const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  CheckPaired(alternatives, criteria.rule);
  std::vector<Key> keys;
  keys.reserve(alternatives.size());
  for (const Evidence& evidence : alternatives) keys.push_back(KeyOf(evidence, criteria));
  std::vector<int> order(alternatives.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  return order;
}

std::optional<int> Recommended(const std::vector<Evidence>& alternatives,
                               const Criteria& criteria) {
  const std::vector<int> order = Rank(alternatives, criteria);
  if (order.empty()) return std::nullopt;
  const Evidence& best = alternatives[order.front()];
  if (best.num_rollouts == 0) return std::nullopt;
  const bool is_good = SuitabilityOf(best, criteria) == Suitability::kReached;
  return is_good ? std::make_optional(order.front()) : std::nullopt;
}

bool AllFail(const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  CheckPaired(alternatives, criteria.rule);
  if (alternatives.empty() || alternatives.front().num_rollouts == 0) return false;
  return std::all_of(alternatives.begin(), alternatives.end(), [&](const Evidence& evidence) {
    return SuitabilityOf(evidence, criteria) == Suitability::kNotReached;
  });
}

std::vector<int> Candidates(const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  std::vector<int> candidates;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    const bool fails = SuitabilityOf(alternatives[i], criteria) == Suitability::kNotReached;
    if (!fails) candidates.push_back(static_cast<int>(i));
  }
  return candidates;
}

CostOdds CostOddsOf(const std::vector<Evidence>& alternatives, const Criteria& criteria, int best) {
  const std::vector<int> candidates = Candidates(alternatives, criteria);
  const BestOdds odds = OddsOf(PosteriorsOf(alternatives, candidates));
  const auto place = std::find(candidates.begin(), candidates.end(), best) - candidates.begin();
  return {odds.probability.at(static_cast<std::size_t>(place)),
          odds.regret[static_cast<std::size_t>(place)]};
}

std::optional<int> RolloutsToSettle(const std::vector<Evidence>& alternatives,
                                    const Criteria& criteria) {
  return RolloutsToSettle(PosteriorsOf(alternatives, Candidates(alternatives, criteria)),
                          kSettledProbability, kMostRollouts);
}

std::vector<int> NextRound(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                           int most) {
  std::vector<int> next(alternatives.size(), 0);
  const std::optional<int> best = Recommended(alternatives, criteria);
  if (AllFail(alternatives, criteria)) return next;
  if (best && CostOddsOf(alternatives, criteria, *best).regret <= criteria.max_regret) return next;
  const std::vector<int> candidates = Candidates(alternatives, criteria);
  std::vector<int> room;
  int played = 0;
  for (const int i : candidates) {
    const Evidence& evidence = alternatives[static_cast<std::size_t>(i)];
    played += evidence.num_rollouts;
    room.push_back(most - evidence.num_rollouts);
  }
  const int size = std::max(kSmallestRound, played / kRoundsToDouble);
  std::vector<int> round;
  if (best) {
    const auto place = std::find(candidates.begin(), candidates.end(), *best) - candidates.begin();
    round =
        AllocateRound(PosteriorsOf(alternatives, candidates), static_cast<int>(place), size, room);
  } else {
    const int share = 1 + (size - 1) / static_cast<int>(candidates.size());
    for (const int left : room) round.push_back(std::min(left, share));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    next[static_cast<std::size_t>(candidates[i])] = round[i];
  }
  return next;
}

std::optional<int> RolloutsToDecide(const std::vector<Evidence>& alternatives,
                                    const Criteria& criteria) {
  constexpr int kNever = std::numeric_limits<int>::max();
  int until_one_is_good = kNever;
  int until_all_fail = 0;
  for (const Evidence& evidence : alternatives) {
    if (SuitabilityOf(evidence, criteria) != Suitability::kOpen) continue;
    const int needed =
        RolloutsToDecide(evidence.success, criteria.min_success, kMostRollouts).value_or(kNever);
    const bool looks_good = evidence.success.share > criteria.min_success;
    if (looks_good) until_one_is_good = std::min(until_one_is_good, needed);
    until_all_fail = std::max(until_all_fail, looks_good ? kNever : needed);
  }
  const int needed = std::min(until_one_is_good, until_all_fail);
  return needed == kNever ? std::nullopt : std::make_optional(needed);
}

}  // namespace hires::imagination
