#include "hires/base/check.h"
#include "hires/imagination/ranking.h"
#include "imagination/answer/confidence_sequence.h"

// Whether more rollouts may still change an order, and an answer: see ranking.h.

namespace hires::imagination {
namespace {

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
class PairJudge {
 public:
  PairJudge(int num_rollouts, const Criteria& criteria, double alpha, double indifference)
      : num_rollouts_(num_rollouts),
        criteria_(criteria),
        alpha_(alpha),
        indifference_(indifference) {}

  bool IsSettled(Prefix a, Prefix b) const {
    if (criteria_.rule == RankingRule::kThesis) return ThesisSettled(a, b);
    return SettledBy({SuccessDifference, ConfidenceDifference, QuickerSign}, a, b);
  }

 private:
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

  bool ThesisSettled(Prefix a, Prefix b) const {
    const Verdict first = InOrOut(a);
    const Verdict second = InOrOut(b);
    if (first == Verdict::kOpen || second == Verdict::kOpen) return false;
    if (first != second) return first == Verdict::kFirstBetter;
    if (first == Verdict::kSecondBetter) return true;  // both are out of the running
    return SettledBy({ConfidenceDifference, QuickerSign}, a, b);
  }

  int num_rollouts_;
  const Criteria& criteria_;
  double alpha_;
  double indifference_;
};

double NumSequences(std::size_t num_alternatives, RankingRule rule) {
  const double n = static_cast<double>(num_alternatives);
  const double pairs = n * (n - 1.0) / 2.0;
  return rule == RankingRule::kThesis ? 2.0 * pairs + n : 3.0 * pairs;
}

using Prefixes = std::vector<const std::vector<RolloutResult>*>;

std::vector<Evidence> SumUpAll(const Prefixes& results, int num_rollouts) {
  std::vector<Evidence> evidence;
  evidence.reserve(results.size());
  for (const auto* of_one : results) {
    evidence.push_back(SumUp(*of_one, num_rollouts, IntervalKind::kConfidenceSequence));
  }
  return evidence;
}

void CheckSettleParams(int num_rollouts, RankingRule rule, const SettleParams& params) {
  HIRES_CHECK(rule != RankingRule::kCost, "by cost the expected regret decides (NextRound)");
  HIRES_CHECK(num_rollouts >= 1, "nothing can be settled without a rollout");
  HIRES_CHECK(params.alpha > 0.0 && params.alpha < 1.0, "alpha lies outside (0, 1)");
  HIRES_CHECK(params.indifference > 0.0 && params.indifference < 1.0,
              "indifference lies outside (0, 1)");
}

bool IsOrderSettled(const Prefixes& results, const std::vector<int>& order, int num_rollouts,
                    const Criteria& criteria, const SettleParams& params) {
  const PairJudge judge(num_rollouts, criteria,
                        params.alpha / NumSequences(results.size(), criteria.rule),
                        params.indifference);
  for (std::size_t i = 1; i < order.size(); ++i) {
    // The chain of neighbours settles the whole order; who is first must beat each other one.
    const auto& better = *results[params.only_best ? order[0] : order[i - 1]];
    if (!judge.IsSettled(better, *results[order[i]])) return false;
  }
  return true;
}

}  // namespace

bool Settled(const std::vector<std::vector<RolloutResult>>& results, int num_rollouts,
             const Criteria& criteria, const SettleParams& params) {
  Prefixes apart;
  apart.reserve(results.size());
  for (const auto& of_one : results) apart.push_back(&of_one);
  return Settled(apart, num_rollouts, criteria, params);
}

bool Settled(const Prefixes& results, int num_rollouts, const Criteria& criteria,
             const SettleParams& params) {
  CheckSettleParams(num_rollouts, criteria.rule, params);
  if (results.size() < 2) return true;
  const std::vector<int> order = Rank(SumUpAll(results, num_rollouts), criteria);
  return IsOrderSettled(results, order, num_rollouts, criteria, params);
}

bool Decided(const Prefixes& results, int num_rollouts, const Criteria& criteria,
             const SettleParams& params) {
  CheckSettleParams(num_rollouts, criteria.rule, params);
  const std::vector<Evidence> evidence = SumUpAll(results, num_rollouts);
  if (criteria.rule != RankingRule::kThesis) {
    if (AllFail(evidence, criteria)) return true;
    if (!Recommended(evidence, criteria)) return false;
  }
  return IsOrderSettled(results, Rank(evidence, criteria), num_rollouts, criteria, params);
}

}  // namespace hires::imagination
