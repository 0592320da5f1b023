#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/imagination/cost_reasons.h"
#include "imagination/answer/ranking_key.h"

namespace hires::imagination {
namespace {

/// "54 of 64"
std::string Successes(const Evidence& evidence) {
  return fmt::format("{} of {}", NumSuccess(evidence), evidence.num_rollouts);
}

std::string Rollouts(int count) { return count == 1 ? "rollout" : "rollouts"; }

/// "99.9 %", with all digits.
std::string Percent(double share) { return fmt::format("{:.13g} %", 100.0 * share); }

/// Code and subjects; words for people, whole sentences, stand elsewhere in the answer.
std::string ShortText(const base::Failure& failure) {
  const std::string code = base::ToString(failure.code);
  return failure.subjects.empty() ? code : code + ": " + base::Join(failure.subjects, ", ");
}

/// "object_fell 7, no_path 2", the most frequent first.
std::string Failures(const Evidence& evidence) {
  std::vector<std::pair<base::Failure, int>> sorted(evidence.failures.begin(),
                                                    evidence.failures.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> parts;
  for (const auto& [failure, count] : sorted) {
    parts.push_back(fmt::format("{} {}", ShortText(failure), count));
  }
  return base::Join(parts, ", ");
}

/// "64 of 64 rollouts succeeded (at least 94 %)": rounded down, so that it never promises too much.
std::string SuccessText(const Evidence& evidence) {
  return fmt::format("{} {} succeeded (at least {:.0f} %)", Successes(evidence),
                     Rollouts(evidence.num_rollouts), std::floor(100.0 * evidence.success.lower));
}

std::string FailureText(const std::string& name, const Evidence& evidence) {
  return fmt::format("{} failed in {} of {} ({})", name,
                     evidence.num_rollouts - NumSuccess(evidence), evidence.num_rollouts,
                     Failures(evidence));
}

/// Rounded up, so that it never condemns too much, and to as many digits as it takes to lie below
/// what is wanted.  @pre share < wanted
double RoundedUp(double share, double wanted) {
  for (double steps = 100.0; steps < 1e15; steps *= 10.0) {
    const double rounded = std::ceil(share * steps) / steps;
    if (rounded < wanted) return rounded;
  }
  return share;
}

/// "; at most 6 % succeed, wanted 50 %"
std::string WhyNotReached(const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  if (criteria.rule == RankingRule::kThesis) return "";
  double most = 0.0;
  for (const Evidence& evidence : alternatives) most = std::max(most, evidence.success.upper);
  return fmt::format("; at most {} succeed, wanted {}",
                     Percent(RoundedUp(most, criteria.min_success)), Percent(criteria.min_success));
}

std::string WhyAllFail(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                       const std::vector<std::string>& names) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    parts.push_back(FailureText(names[i], alternatives[i]));
  }
  return "nothing is recommended, all alternatives fail: " + base::Join(parts, "; ") +
         WhyNotReached(alternatives, criteria);
}

std::string WhatWouldDecide(const std::vector<Evidence>& alternatives, const Criteria& criteria) {
  const std::optional<int> needed = RolloutsToDecide(alternatives, criteria);
  if (!needed) {
    return fmt::format(
        "that is so near to what is wanted that not even {} rollouts would likely "
        "decide",
        kMostRollouts);
  }
  return fmt::format("if it goes on like this, about {} rollouts decide", *needed);
}

std::string WhyUndecided(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                         const std::vector<std::string>& names) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const SuccessInterval& success = alternatives[i].success;
    parts.push_back(fmt::format("{} succeeded in {} ({:.0f} to {:.0f} %)", names[i],
                                Successes(alternatives[i]), std::floor(100.0 * success.lower),
                                std::ceil(100.0 * success.upper)));
  }
  return fmt::format("nothing is recommended yet, wanted are {} of success: {}; {}",
                     Percent(criteria.min_success), base::Join(parts, "; "),
                     WhatWouldDecide(alternatives, criteria));
}

std::string WhyNone(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                    const std::vector<std::string>& names) {
  if (alternatives.empty()) return "nothing is recommended: there is no alternative";
  if (alternatives.front().num_rollouts == 0) {
    return "nothing is recommended: no rollout of every alternative has finished";
  }
  return AllFail(alternatives, criteria) ? WhyAllFail(alternatives, criteria, names)
                                         : WhyUndecided(alternatives, criteria, names);
}

/// What the first criterion says where it decided.
std::string WhyFirst(const Evidence& best, const Evidence& next, const std::string& next_name,
                     RankingRule rule) {
  if (rule != RankingRule::kThesis) {
    return SuccessText(best) + ", " + FailureText(next_name, next);
  }
  return fmt::format(
      "its action reached its goal in {:.0f} % of {} {}, that of {} only in {:.0f} %",
      100.0 * (1.0 - best.action_failed_share), best.num_rollouts, Rollouts(best.num_rollouts),
      next_name, 100.0 * (1.0 - next.action_failed_share));
}

/// What both have in common as far as the first criterion goes.
std::string Common(const Evidence& best, const std::string& next_name, RankingRule rule) {
  switch (rule) {
    case RankingRule::kRisk:
      return fmt::format("{} as with {}", SuccessText(best), next_name);
    case RankingRule::kCost:
      return SuccessText(best) + ", meets the required success rate, as does " + next_name;
    case RankingRule::kThesis:
      break;
  }
  return "its action reached its goal like that of " + next_name;
}

/// Two numbers with as many digits (at least `digits`, to 15) as it takes to see that they differ.
std::string Against(double a, double b, const std::string& unit, int digits = 3) {
  for (; digits < 15; ++digits) {
    const std::string left = fmt::format("{:.{}f}", a, digits);
    const std::string right = fmt::format("{:.{}f}", b, digits);
    if (left != right) return fmt::format("{}{} against {}{}", left, unit, right, unit);
  }
  return fmt::format("{}{} against {}{}", a, unit, b, unit);
}

/// By risk and by thesis: confidence, then duration.
std::string WhyLater(const Evidence& best, const Evidence& next, const Key& best_key,
                     const Key& next_key) {
  if (std::get<1>(best_key) != std::get<1>(next_key)) {
    return ", and its confidence is higher, " +
           Against(best.confidence_mean, next.confidence_mean, "");
  }
  if (std::get<2>(best_key) != std::get<2>(next_key)) {
    return fmt::format(" and with the same confidence {:.3f}, but quicker, {}",
                       best.confidence_mean, Against(best.duration.mean, next.duration.mean, " s"));
  }
  return ", and in nothing worse; it was named first";
}

std::string WhyCheaper(const Evidence& best, const Evidence& next, const Key& best_key,
                       const Key& next_key) {
  if (std::get<1>(best_key) != std::get<1>(next_key)) {
    return ", and its expected cost is lower, " +
           Against(best.cost->mean, next.cost->mean, " s", 1);
  }
  if (std::get<2>(best_key) != std::get<2>(next_key)) {
    return fmt::format(
        " and with the same expected cost {:.3f} s, but its confidence is higher, {}",
        best.cost->mean, Against(best.confidence_mean, next.confidence_mean, ""));
  }
  return ", and in nothing worse; it was named first";
}

std::string WhyBetter(const Evidence& best, const Evidence& next, const std::string& next_name,
                      const Criteria& criteria) {
  const Key best_key = KeyOf(best, criteria);
  const Key next_key = KeyOf(next, criteria);
  if (std::get<0>(best_key) != std::get<0>(next_key)) {
    return WhyFirst(best, next, next_name, criteria.rule);
  }
  return Common(best, next_name, criteria.rule) + (criteria.rule == RankingRule::kCost
                                                       ? WhyCheaper(best, next, best_key, next_key)
                                                       : WhyLater(best, next, best_key, next_key));
}

constexpr double kNoticeable = 0.1;  // [s]

/// The quickest alternative that is good enough, too, and whose interval of success overlaps that
/// of the best: a reader with little time might prefer it.
const Evidence* QuickerRival(const std::vector<Evidence>& alternatives, const Evidence& best,
                             const Criteria& criteria) {
  const Evidence* rival = nullptr;
  for (const Evidence& evidence : alternatives) {
    const bool is_rival =
        Judge(evidence.success, criteria.min_success) == Suitability::kReached &&
        evidence.success.upper >= best.success.lower &&
        evidence.duration.mean < (rival ? rival->duration.mean : best.duration.mean - kNoticeable);
    if (is_rival) rival = &evidence;
  }
  return rival;
}

/// What the lexical order of `risk` hides: a difference that decides may be far within chance.
std::string WhatSpeaksAgainst(const std::vector<Evidence>& alternatives, const Evidence& best,
                              const Criteria& criteria, const std::vector<std::string>& names) {
  if (criteria.rule != RankingRule::kRisk) return "";
  const Evidence* rival = QuickerRival(alternatives, best, criteria);
  if (!rival) return "";
  return fmt::format(
      "; but {} is {:.1f} s quicker, and the intervals of success overlap (ranking 'cost' "
      "weighs seconds against failures)",
      names[rival - alternatives.data()], best.duration.mean - rival->duration.mean);
}

/// The cheapest that would cost less and may succeed often enough, but is not known to.
std::string WhoIsNotGoodEnough(const std::vector<Evidence>& alternatives, const Evidence& best,
                               const Criteria& criteria, const std::vector<std::string>& names) {
  if (criteria.rule != RankingRule::kCost || !best.cost) return "";
  const Evidence* cheapest = nullptr;
  for (const Evidence& evidence : alternatives) {
    if (Judge(evidence.success, criteria.min_success) != Suitability::kOpen) continue;
    if (!evidence.cost || evidence.cost->mean >= (cheapest ? *cheapest : best).cost->mean) continue;
    cheapest = &evidence;
  }
  if (!cheapest) return "";
  return fmt::format(
      "; {} may cost less, {}, but is only known to succeed in {:.0f} % or more, "
      "wanted are {}",
      names[cheapest - alternatives.data()],
      Against(cheapest->cost->mean, best.cost->mean, " s", 1),
      std::floor(100.0 * cheapest->success.lower), Percent(criteria.min_success));
}

/// How certain it is that the recommended one is the cheapest.
std::string Odds(const CostReasons* reasons) {
  if (!reasons) return "";
  std::string text;
  if (reasons->IsClose()) {
    text = "; near tie: " +
           (reasons->until_settled
                ? fmt::format("about {} rollouts of each would settle it", *reasons->until_settled)
                : fmt::format("not even {} rollouts of each would settle it", kMostRollouts));
  }
  // Rounded down, so that it never promises too much.
  text += fmt::format("; P(best) {:.2f}, expected regret {:.1f} s",
                      std::floor(100.0 * reasons->probability) / 100.0, reasons->regret);
  return reasons->is_one_truth ? text + "; all rollouts share one ground truth" : text;
}

/// What the failures that were weighed cost, and where the answer would turn.
std::string WhatPricesSay(const CostReasons* reasons, const std::vector<std::string>& names) {
  if (!reasons) return "";
  const std::string prices = PriceSentence(*reasons);
  return (prices.empty() ? "" : "; " + prices) +
         (reasons->turning ? "; " + TurningSentence(*reasons->turning, names) : "");
}

}  // namespace

std::string WhyRecommended(const std::vector<Evidence>& alternatives, const Criteria& criteria,
                           const std::vector<std::string>& names, const CostReasons* reasons) {
  HIRES_CHECK(names.size() == alternatives.size(), "each alternative needs one name");
  const std::optional<int> best = Recommended(alternatives, criteria);
  if (!best) return WhyNone(alternatives, criteria, names);
  const Evidence& winner = alternatives[*best];
  if (alternatives.size() == 1) {
    return fmt::format("{}: the only alternative; {}", names[*best], SuccessText(winner));
  }
  const int next = Rank(alternatives, criteria)[1];
  return fmt::format("{}: {}{}", names[*best],
                     WhyBetter(winner, alternatives[next], names[next], criteria),
                     Odds(reasons) + WhatSpeaksAgainst(alternatives, winner, criteria, names) +
                         WhoIsNotGoodEnough(alternatives, winner, criteria, names) +
                         WhatPricesSay(reasons, names));
}

}  // namespace hires::imagination
