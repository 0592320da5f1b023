// How often each rule recommends what costs more than necessary: alternatives with known durations,
// failures and penalties, played with invented rollouts.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include "hires/imagination/ranking.h"
#include "imagination/rollout_examples.h"

namespace hires::imagination::known_truth_test {
namespace {

using test_support::Fall;
using test_support::Success;

using Results = std::vector<RolloutResult>;

struct Truth {
  double duration{0.0};  ///< [s]
  double failing{0.0};   ///< share of falls
  int shaking{0};        ///< samples of 640, at most
};

/// One request.
struct Asked {
  std::vector<Truth> alternatives;
  double price{0.0};        ///< [s] of a fall
  bool shares_luck{false};  ///< what fells one alternative fells those that fall more often, too

  double CostOfOne(int alternative) const {
    const Truth& truth = alternatives[static_cast<std::size_t>(alternative)];
    return truth.duration + truth.failing * price;
  }
  double Least() const {
    double least = CostOfOne(0);
    for (std::size_t a = 1; a < alternatives.size(); ++a) {
      least = std::min(least, CostOfOne(static_cast<int>(a)));
    }
    return least;
  }
};

/// Two to four ways of 8 to 30 s; in three of ten requests nothing ever falls, else each way never
/// fells its load (three of ten) or in a share between 0.002 and 0.2, evenly by its logarithm.
Asked Draw(base::Rng rng) {
  Asked asked;
  asked.price = std::vector<double>{30.0, 120.0, 600.0}[static_cast<std::size_t>(rng.Index(3))];
  asked.shares_luck = rng.Bernoulli(0.5);
  const bool is_sturdy = rng.Bernoulli(0.3);
  const int count = 2 + rng.Index(3);
  for (int a = 0; a < count; ++a) {
    Truth truth{rng.Uniform(8.0, 30.0), 0.0, rng.Index(400)};
    const double failing = std::pow(10.0, rng.Uniform(-2.7, -0.7));
    if (!rng.Bernoulli(0.3) && !is_sturdy) truth.failing = failing;
    asked.alternatives.push_back(truth);
  }
  return asked;
}

std::vector<Results> Play(const Asked& asked, const base::Rng& seed, int count) {
  std::vector<Results> results;
  for (std::size_t a = 0; a < asked.alternatives.size(); ++a) {
    const Truth& truth = asked.alternatives[a];
    Results of_one;
    for (int i = 0; i < count; ++i) {
      base::Rng rng = seed.Fork(static_cast<std::uint64_t>(i) + (asked.shares_luck ? 0 : 1000 * a));
      const bool falls = rng.Uniform(0.0, 1.0) < truth.failing;
      const double duration = truth.duration * (1.0 + rng.Normal(0.0, 0.05));
      of_one.push_back(falls ? Fall(duration) : Success(duration, rng.Index(truth.shaking + 1)));
    }
    results.push_back(std::move(of_one));
  }
  return results;
}

enum class Way {
  kSampleMean,  ///< equal numbers of rollouts, the lowest mean cost: ranking `cost` of 0.3.0
  kPosterior,   ///< as many in all, split by NextRound, the lowest expected cost
  kStopping,    ///< the same, stopped at an expected regret of 2 s
  kRisk,
  kThesis
};
constexpr std::pair<Way, const char*> kWays[] = {{Way::kSampleMean, "cost of 0.3.0"},
                                                 {Way::kPosterior, "cost"},
                                                 {Way::kStopping, "cost, stops at 2 s"},
                                                 {Way::kRisk, "risk"},
                                                 {Way::kThesis, "thesis"}};
constexpr int kBudgets[] = {16, 64, 400};  // of each alternative in the mean
constexpr int kMost = 1600;                // of one alternative

struct Tally {
  int requests{0};
  int worse{0};
  int none{0};  ///< nothing was recommended
  double regret_sum{0.0};
  double rollouts_sum{0.0};
  int ranked{0}, ranked_and_worse{0};  ///< answers with P(best) of 0.95 and more

  double share_worse() const { return static_cast<double>(worse) / (requests - none); }
  double regret() const { return regret_sum / (requests - none); }  ///< [s] in the mean
  double rollouts() const { return rollouts_sum / requests; }
};

Criteria CriteriaFor(const Asked& asked, Way way) {
  return {way == Way::kRisk     ? RankingRule::kRisk
          : way == Way::kThesis ? RankingRule::kThesis
                                : RankingRule::kCost,
          0.5,
          {{{base::FailureCode::kObjectFell, asked.price},
            {base::FailureCode::kOther, 0.5 * asked.price}},
           300.0},
          way == Way::kStopping ? 2.0 : 0.0};
}

std::vector<Evidence> SumUpFirst(const std::vector<Results>& results,
                                 const std::vector<int>& counts, const Criteria& criteria) {
  std::vector<RolloutPrefix> request;
  for (std::size_t i = 0; i < results.size(); ++i) request.push_back({&results[i], counts[i]});
  return SumUpRequest(request, IntervalKind::kConfidenceSequence, criteria.prices);
}

/// Rounds until the budget of all is used up, or the answer is decided.
std::vector<int> PlayRounds(const std::vector<Results>& results, int budget,
                            const Criteria& criteria) {
  std::vector<int> counts(results.size(), 16);
  int left = static_cast<int>(results.size()) * (budget - 16);
  while (left > 0) {
    const auto more = NextRound(SumUpFirst(results, counts, criteria), criteria, kMost);
    if (std::accumulate(more.begin(), more.end(), 0) == 0) break;
    for (std::size_t i = 0; i < more.size(); ++i) {
      const int added = std::min(more[i], left);
      counts[i] += added;
      left -= added;
    }
  }
  return counts;
}

/// The alternative with the lowest mean cost of those that reach min_success.
std::optional<int> CheapestInTheMean(const std::vector<Results>& results,
                                     const std::vector<Evidence>& evidence,
                                     const Criteria& criteria) {
  std::optional<int> best;
  double lowest = 0.0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (Judge(evidence[i].success, criteria.min_success) != Suitability::kReached) continue;
    double sum = 0.0;
    for (int k = 0; k < evidence[i].num_rollouts; ++k) {
      sum += CostOf(results[i][static_cast<std::size_t>(k)], criteria.prices);
    }
    if (best && sum >= lowest) continue;
    best = static_cast<int>(i);
    lowest = sum;
  }
  return best;
}

void Ask(const Asked& asked, const std::vector<Results>& results, Way way, int budget,
         Tally* tally) {
  const Criteria criteria = CriteriaFor(asked, way);
  const bool is_adaptive = way == Way::kPosterior || way == Way::kStopping;
  const std::vector<int> counts = is_adaptive ? PlayRounds(results, budget, criteria)
                                              : std::vector<int>(results.size(), budget);
  const std::vector<Evidence> evidence = SumUpFirst(results, counts, criteria);
  ++tally->requests;
  tally->rollouts_sum +=
      1.0 * std::accumulate(counts.begin(), counts.end(), 0) / static_cast<double>(counts.size());
  const std::optional<int> best = way == Way::kSampleMean
                                      ? CheapestInTheMean(results, evidence, criteria)
                                      : Recommended(evidence, criteria);
  if (!best) return void(++tally->none);
  const double regret = asked.CostOfOne(*best) - asked.Least();
  tally->worse += regret > 0.0;
  tally->regret_sum += regret;
  if (!is_adaptive || CostOddsOf(evidence, criteria, *best).probability < kSettledProbability) {
    return;
  }
  ++tally->ranked;
  tally->ranked_and_worse += regret > 0.0;
}

/// HIRES_TRUTH_REQUESTS=300 for the table of docs/notes_imagination.md.
int NumRequests() {
  const char* wanted = std::getenv("HIRES_TRUTH_REQUESTS");
  return wanted != nullptr ? std::atoi(wanted) : 60;
}

using Tallies = std::map<std::pair<Way, int>, Tally>;

Tallies Simulate(int num_requests) {
  Tallies tallies;
  for (int request = 0; request < num_requests; ++request) {
    const base::Rng rng = base::Rng(2024).Fork(static_cast<std::uint64_t>(request));
    const Asked asked = Draw(rng.Fork(1));
    const std::vector<Results> results = Play(asked, rng.Fork(2), kMost);
    for (const auto& [way, name] : kWays) {
      for (const int budget : kBudgets) Ask(asked, results, way, budget, &tallies[{way, budget}]);
    }
  }
  return tallies;
}

TEST(KnownTruthTest, CostRecommendsTheDearerOneSeldomAndCheaply) {
  Tallies tallies = Simulate(NumRequests());
  fmt::print("{} requests\n", NumRequests());
  fmt::print("{:20} {:>6} {:>8} {:>8} {:>9} {:>5} {:>14}\n", "rule", "budget", "wrong", "regret",
             "rollouts", "none", "ranked: wrong");
  for (const auto& [way, name] : kWays) {
    for (const int budget : kBudgets) {
      const Tally& tally = tallies[{way, budget}];
      fmt::print("{:20} {:6} {:6.1f} % {:6.2f} s {:9.1f} {:5} {:7} of {}\n", name, budget,
                 100.0 * tally.share_worse(), tally.regret(), tally.rollouts(), tally.none,
                 tally.ranked_and_worse, tally.ranked);
    }
  }
  const auto regret = [&](Way way, int budget) { return tallies[{way, budget}].regret(); };
  for (const int budget : kBudgets) {
    EXPECT_LE(tallies[std::make_pair(Way::kPosterior, budget)].share_worse(),
              tallies[std::make_pair(Way::kSampleMean, budget)].share_worse())
        << budget;
    EXPECT_LE(regret(Way::kPosterior, budget), regret(Way::kSampleMean, budget) + 0.1) << budget;
    EXPECT_LT(regret(Way::kPosterior, budget), 0.6 * regret(Way::kRisk, budget)) << budget;
    EXPECT_LT(regret(Way::kRisk, budget), regret(Way::kThesis, budget)) << budget;
    const Tally& cost = tallies[{Way::kPosterior, budget}];
    EXPECT_LE(cost.ranked_and_worse, 0.05 * cost.ranked) << budget;
  }
  EXPECT_LT(regret(Way::kStopping, 400), 2.0) << "what it stops at";
  EXPECT_LT(tallies[std::make_pair(Way::kStopping, 400)].rollouts(), 200.0);
}

}  // namespace
}  // namespace hires::imagination::known_truth_test
