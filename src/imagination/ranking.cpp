#include "hires/imagination/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/imagination/confidence_sequence.h"

namespace hires::imagination {
namespace {

bool IsOut(const Evidence& evidence) { return evidence.action_failed_share > 0.5; }

double DurationKey(const Evidence& evidence) {
  return evidence.median_rollout < 0 ? std::numeric_limits<double>::infinity()
                                     : evidence.duration.mean;
}

/// Smaller is better, field by field: the first criterion, confidence, duration.
using Key = std::tuple<double, double, double>;

Key KeyOf(const Evidence& evidence, RankingRule rule) {
  const double first =
      rule == RankingRule::kRisk ? -evidence.success.lower : (IsOut(evidence) ? 1.0 : 0.0);
  return {first, -evidence.confidence_mean, DurationKey(evidence)};
}

void CheckPaired(const std::vector<Evidence>& alternatives) {
  for (const Evidence& evidence : alternatives) {
    HIRES_CHECK(evidence.num_rollouts == alternatives.front().num_rollouts,
                "alternatives are compared at different numbers of rollouts");
  }
}

int NumSuccess(const Evidence& evidence) {
  int failures = 0;
  for (const auto& [failure, count] : evidence.failures) failures += count;
  return evidence.num_rollouts - failures;
}

// ---------------------------------------------------------------- words

/// "54 of 64"
std::string Successes(const Evidence& evidence) {
  return fmt::format("{} of {}", NumSuccess(evidence), evidence.num_rollouts);
}

std::string Rollouts(int count) { return count == 1 ? "rollout" : "rollouts"; }

/// "object_fell 7, no_path 2", the most frequent first.
std::string Failures(const Evidence& evidence) {
  std::vector<std::pair<base::Failure, int>> sorted(evidence.failures.begin(),
                                                    evidence.failures.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> parts;
  for (const auto& [failure, count] : sorted) {
    parts.push_back(fmt::format("{} {}", base::ToString(failure), count));
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

std::string WhyNone(const std::vector<Evidence>& alternatives,
                    const std::vector<std::string>& names) {
  if (alternatives.empty()) return "nothing is recommended: there is no alternative";
  if (alternatives.front().num_rollouts == 0) {
    return "nothing is recommended: no rollout of every alternative has finished";
  }
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    parts.push_back(FailureText(names[i], alternatives[i]));
  }
  return "nothing is recommended, all alternatives fail: " + base::Join(parts, "; ");
}

/// What the first criterion says where it decided.
std::string WhyFirst(const Evidence& best, const Evidence& next, const std::string& next_name,
                     RankingRule rule) {
  if (rule == RankingRule::kRisk) {
    return SuccessText(best) + ", " + FailureText(next_name, next);
  }
  return fmt::format(
      "its action reached its goal in {:.0f} % of {} {}, that of {} only in {:.0f} %",
      100.0 * (1.0 - best.action_failed_share), best.num_rollouts, Rollouts(best.num_rollouts),
      next_name, 100.0 * (1.0 - next.action_failed_share));
}

/// What both have in common as far as the first criterion goes.
std::string Common(const Evidence& best, const std::string& next_name, RankingRule rule) {
  if (rule == RankingRule::kThesis) return "its action reached its goal like that of " + next_name;
  return fmt::format("{} as with {}", SuccessText(best), next_name);
}

/// Two numbers with as many digits (3 to 15) as it takes to see that they differ.
std::string Against(double a, double b, const std::string& unit) {
  for (int digits = 3; digits < 15; ++digits) {
    const std::string left = fmt::format("{:.{}f}", a, digits);
    const std::string right = fmt::format("{:.{}f}", b, digits);
    if (left != right) return fmt::format("{}{} against {}{}", left, unit, right, unit);
  }
  return fmt::format("{}{} against {}{}", a, unit, b, unit);
}

std::string WhyBetter(const Evidence& best, const Evidence& next, const std::string& next_name,
                      RankingRule rule) {
  const Key best_key = KeyOf(best, rule);
  const Key next_key = KeyOf(next, rule);
  if (std::get<0>(best_key) != std::get<0>(next_key)) return WhyFirst(best, next, next_name, rule);
  const std::string common = Common(best, next_name, rule);
  if (std::get<1>(best_key) != std::get<1>(next_key)) {
    return fmt::format("{}, and its confidence is higher, {}", common,
                       Against(best.confidence_mean, next.confidence_mean, ""));
  }
  if (std::get<2>(best_key) != std::get<2>(next_key)) {
    return fmt::format("{} and with the same confidence {:.3f}, but quicker, {}", common,
                       best.confidence_mean, Against(best.duration.mean, next.duration.mean, " s"));
  }
  return fmt::format("{}, and in nothing worse; it was named first", common);
}

// ---------------------------------------------------------------- is the order settled?

using Prefix = const std::vector<RolloutResult>&;

/// Paired difference, positive where the first is better; in [-1, 1].
using Difference = double (*)(const RolloutResult&, const RolloutResult&);

double SuccessDifference(const RolloutResult& a, const RolloutResult& b) {
  return (FailureOf(a) ? 0.0 : 1.0) - (FailureOf(b) ? 0.0 : 1.0);
}

double ConfidenceDifference(const RolloutResult& a, const RolloutResult& b) {
  return RolloutConfidence(a) - RolloutConfidence(b);
}

double QuickerSign(const RolloutResult& a, const RolloutResult& b) {
  if (ActionFailed(a) || ActionFailed(b)) return double(ActionFailed(b)) - double(ActionFailed(a));
  return double(a.duration < b.duration) - double(b.duration < a.duration);
}

enum class Verdict { kFirstBetter, kSecondBetter, kEqual, kOpen };

/// Judges pairs and alternatives with the error probability that is theirs.
class Judge {
 public:
  Judge(int num_rollouts, double alpha, double indifference)
      : num_rollouts_(num_rollouts), alpha_(alpha), indifference_(indifference) {}

  Verdict Compare(Prefix a, Prefix b, Difference difference) const {
    MeanSequence sequence(-1.0, 1.0, alpha_);
    for (int i = 0; i < num_rollouts_; ++i) sequence.Add(difference(a[i], b[i]));
    if (sequence.Above(0.0)) return Verdict::kFirstBetter;
    if (sequence.Below(0.0)) return Verdict::kSecondBetter;
    const bool is_equal = sequence.Above(-indifference_) && sequence.Below(indifference_);
    return is_equal ? Verdict::kEqual : Verdict::kOpen;
  }

  /// kFirstBetter: in; kSecondBetter: out; else kOpen.
  Verdict InOrOut(Prefix results) const {
    MeanSequence failed_share(0.0, 1.0, alpha_);
    for (int i = 0; i < num_rollouts_; ++i) failed_share.Add(ActionFailed(results[i]) ? 1.0 : 0.0);
    if (failed_share.Below(0.5)) return Verdict::kFirstBetter;
    return failed_share.Above(0.5) ? Verdict::kSecondBetter : Verdict::kOpen;
  }

  /// Whether the order of a before b is certain as far as the named criteria go.
  bool SettledBy(const std::vector<Difference>& criteria, Prefix a, Prefix b) const {
    for (const Difference criterion : criteria) {
      const Verdict verdict = Compare(a, b, criterion);
      if (verdict != Verdict::kEqual) return verdict == Verdict::kFirstBetter;
    }
    return true;
  }

  bool RiskSettled(Prefix a, Prefix b) const {
    return SettledBy({SuccessDifference, ConfidenceDifference, QuickerSign}, a, b);
  }

  bool ThesisSettled(Prefix a, Prefix b) const {
    const Verdict first = InOrOut(a);
    const Verdict second = InOrOut(b);
    if (first == Verdict::kOpen || second == Verdict::kOpen) return false;
    if (first != second) return first == Verdict::kFirstBetter;
    if (first == Verdict::kSecondBetter) return true;  // both out: nobody will take either
    return SettledBy({ConfidenceDifference, QuickerSign}, a, b);
  }

 private:
  int num_rollouts_;
  double alpha_;
  double indifference_;
};

double NumSequences(std::size_t num_alternatives, RankingRule rule) {
  const double n = static_cast<double>(num_alternatives);
  const double pairs = n * (n - 1.0) / 2.0;
  return rule == RankingRule::kRisk ? 3.0 * pairs : 2.0 * pairs + n;
}

std::vector<int> RankPrefixes(const std::vector<const std::vector<RolloutResult>*>& results,
                              int num_rollouts, RankingRule rule) {
  std::vector<Evidence> evidence;
  evidence.reserve(results.size());
  for (const auto* of_one : results) evidence.push_back(SumUp(*of_one, num_rollouts));
  return Rank(evidence, rule);
}

void CheckSettleParams(int num_rollouts, const SettleParams& params) {
  HIRES_CHECK(num_rollouts >= 1, "nothing can be settled without a rollout");
  HIRES_CHECK(params.alpha > 0.0 && params.alpha < 1.0, "alpha lies outside (0, 1)");
  HIRES_CHECK(params.indifference > 0.0 && params.indifference < 1.0,
              "indifference lies outside (0, 1)");
}

}  // namespace

RankingRule ParseRankingRule(const std::string& name) {
  const std::string lower = base::ToLower(name);
  if (lower == "risk") return RankingRule::kRisk;
  if (lower == "thesis") return RankingRule::kThesis;
  throw base::ConfigError(base::UnknownName("ranking", name, {"risk", "thesis"}) +
                          "; 'risk' puts success first, 'thesis' ranks as the dissertation does");
}

std::string ToString(RankingRule rule) { return rule == RankingRule::kRisk ? "risk" : "thesis"; }

std::vector<int> Rank(const std::vector<Evidence>& alternatives, RankingRule rule) {
  CheckPaired(alternatives);
  std::vector<Key> keys;
  keys.reserve(alternatives.size());
  for (const Evidence& evidence : alternatives) keys.push_back(KeyOf(evidence, rule));
  std::vector<int> order(alternatives.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  return order;
}

std::optional<int> Recommended(const std::vector<Evidence>& alternatives, RankingRule rule) {
  const std::vector<int> order = Rank(alternatives, rule);
  if (order.empty()) return std::nullopt;
  const Evidence& best = alternatives[order.front()];
  if (best.num_rollouts == 0) return std::nullopt;
  const bool fails = rule == RankingRule::kRisk ? NumSuccess(best) == 0 : IsOut(best);
  return fails ? std::nullopt : std::make_optional(order.front());
}

std::string WhyRecommended(const std::vector<Evidence>& alternatives, RankingRule rule,
                           const std::vector<std::string>& names) {
  HIRES_CHECK(names.size() == alternatives.size(), "each alternative needs one name");
  const std::optional<int> best = Recommended(alternatives, rule);
  if (!best) return WhyNone(alternatives, names);
  const Evidence& winner = alternatives[*best];
  if (alternatives.size() == 1) {
    return fmt::format("{}: the only alternative; {}", names[*best], SuccessText(winner));
  }
  const int next = Rank(alternatives, rule)[1];
  return fmt::format("{}: {}", names[*best],
                     WhyBetter(winner, alternatives[next], names[next], rule));
}

bool Settled(const std::vector<std::vector<RolloutResult>>& results, int num_rollouts,
             RankingRule rule, const SettleParams& params) {
  std::vector<const std::vector<RolloutResult>*> apart;
  apart.reserve(results.size());
  for (const auto& of_one : results) apart.push_back(&of_one);
  return Settled(apart, num_rollouts, rule, params);
}

bool Settled(const std::vector<const std::vector<RolloutResult>*>& results, int num_rollouts,
             RankingRule rule, const SettleParams& params) {
  CheckSettleParams(num_rollouts, params);
  if (results.size() < 2) return true;
  const std::vector<int> order = RankPrefixes(results, num_rollouts, rule);
  const Judge judge(num_rollouts, params.alpha / NumSequences(results.size(), rule),
                    params.indifference);
  for (std::size_t i = 1; i < order.size(); ++i) {
    // The chain of neighbours settles the whole order; who is first must beat each other one.
    const auto& better = *results[params.only_best ? order[0] : order[i - 1]];
    const auto& worse = *results[order[i]];
    const bool settled = rule == RankingRule::kRisk ? judge.RiskSettled(better, worse)
                                                    : judge.ThesisSettled(better, worse);
    if (!settled) return false;
  }
  return true;
}

}  // namespace hires::imagination
