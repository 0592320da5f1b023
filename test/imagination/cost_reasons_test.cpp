#include "hires/imagination/cost_reasons.h"

#include <gmock/gmock.h>

#include <cmath>

#include "imagination/rollout_examples.h"

namespace hires::imagination::cost_reasons_test {
namespace {

using test_support::Fall;
using test_support::InventAll;
using test_support::NoPath;
using test_support::Success;
using test_support::Times;
using test_support::operator+;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Results = std::vector<RolloutResult>;

/// A fall costs so much [s], all else 50 s.
Criteria ByCost(double price_of_fall) {
  return {RankingRule::kCost,
          0.5,
          {{{base::FailureCode::kObjectFell, price_of_fall}, {base::FailureCode::kOther, 50.0}},
           300.0}};
}

struct Answered {
  std::vector<Evidence> evidence;
  std::optional<CostReasons> reasons;
  std::string why;
};

std::vector<Evidence> SumUpAll(const std::vector<Results>& results, const Criteria& criteria) {
  std::vector<RolloutPrefix> request;
  for (const Results& of_one : results) {
    request.push_back({&of_one, static_cast<int>(of_one.size())});
  }
  return SumUpRequest(request, IntervalKind::kClopperPearson, criteria.prices);
}

Answered Ask(const std::vector<Results>& results, const Criteria& criteria,
             const std::vector<std::string>& names = {"fast", "slow"}) {
  Answered answered;
  answered.evidence = SumUpAll(results, criteria);
  answered.reasons = CostReasonsOf(answered.evidence, criteria);
  answered.why = WhyRecommended(answered.evidence, criteria, names,
                                answered.reasons ? &*answered.reasons : nullptr);
  return answered;
}

CostComparison Compare(const Results& a, const Results& b, double price_of_fall = 600.0) {
  const auto evidence = Ask({a, b}, ByCost(price_of_fall)).evidence;
  return CompareCosts(evidence[0], evidence[1]);
}

// ---------------------------------------------------------------- two alternatives

TEST(CompareCostsTest, SecondsAndFailuresAreThoseOfThePosteriors) {
  const CostComparison with = Compare(Times(60, Success(20.0)) + Times(4, Fall(20.0)),
                                      Times(62, Success(30.0)) + Times(2, NoPath()));
  EXPECT_NEAR(with.time_saved, (62 * 30.0 - 64 * 20.0) / 64.0, 1e-12);
  // Four falls of 600 s and two of 50 s: the pseudo-failure costs 2500 / 6 s.
  const double pseudo = 2500.0 / 6.0;
  EXPECT_NEAR(with.failures_more,
              4.5 / 65.0 * (2400.0 + pseudo) / 5.0 - 2.5 / 65.0 * (100.0 + pseudo) / 3.0, 1e-9);
  EXPECT_GT(with.failures_more_upper, with.failures_more);
  EXPECT_FALSE(with.neither_failed);
}

TEST(CompareCostsTest, EqualsAreAsLikelyOneAsTheOther) {
  const CostComparison with = Compare(Times(16, Success()), Times(16, Success()));
  EXPECT_NEAR(with.probability, 0.5, 1e-9);
  EXPECT_TRUE(with.neither_failed);
}

TEST(CompareCostsTest, ProbabilitiesOfBothAddUpToOne) {
  for (int seed = 0; seed < 50; ++seed) {
    const base::Rng rng = base::Rng(8).Fork(seed);
    const Results a = InventAll({0.1, 0.05, 20.0}, rng.Fork(1), 32);
    const Results b = InventAll({0.05, 0.1, 24.0}, rng.Fork(2), 32);
    EXPECT_NEAR(Compare(a, b).probability + Compare(b, a).probability, 1.0, 1e-6);
  }
}

TEST(CompareCostsTest, MoreFlawlessRolloutsRaiseTheProbabilityOfTheQuickerOne) {
  double last = 0.5;
  for (int n = 16; n <= 1024; n *= 2) {
    const double now = Compare(Times(n, Success(10.2)), Times(n, Success(22.4))).probability;
    EXPECT_GE(now, last) << n;
    last = now;
  }
  EXPECT_GT(last, 0.999);
}

/// k and a half exponentials: the gamma distribution of k + 1/2.
double Gamma(int k, base::Rng* rng) {
  double sum = 0.5 * std::pow(rng->Normal(0.0, 1.0), 2);
  for (int i = 0; i < k; ++i) sum -= std::log(1.0 - rng->Uniform(0.0, 1.0));
  return sum;
}

TEST(CompareCostsTest, TheProbabilityIsThatOfDrawnShares) {  // the other road to the number
  const CostComparison with = Compare(Times(61, Success(20.0)) + Times(3, Fall(20.0)),
                                      Times(63, Success(45.0)) + Times(1, Fall(45.0)));
  base::Rng rng(9);
  int cheaper = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const double its = Gamma(3, &rng), its_rest = Gamma(61, &rng);
    const double others = Gamma(1, &rng), others_rest = Gamma(63, &rng);
    cheaper +=
        20.0 + 600.0 * its / (its + its_rest) < 45.0 + 600.0 * others / (others + others_rest);
  }
  EXPECT_NEAR(with.probability, static_cast<double>(cheaper) / kDraws, 0.015);
}

// ---------------------------------------------------------------- what is said

TEST(CostSentenceTest, UnseenFailuresAreWeighed) {
  // 10.2 s + 600 s / 130 against 22.4 s + 600 s / 130.
  const Answered answered =
      Ask({Times(64, Success(10.2, 12)), Times(64, Success(22.4))}, ByCost(600.0));
  EXPECT_EQ(answered.why,
            "fast: 64 of 64 rollouts succeeded (at least 94 %), meets the required success rate, "
            "as does slow, and its expected cost is lower, 14.8 s against 27.0 s; near tie: about "
            "78 rollouts of each would settle it; P(best) 0.93, expected regret 0.5 s; a fall "
            "costs 600 s");
  EXPECT_EQ(answered.reasons->prices.at(base::FailureCode::kObjectFell), 600.0);
  EXPECT_FALSE(answered.reasons->turning);
  EXPECT_FALSE(Ask({Times(128, Success(10.2)), Times(128, Success(22.4))}, ByCost(600.0))
                   .reasons->IsClose());
}

TEST(CostSentenceTest, WithoutAPayloadTheUnseenFailureIsAnyOther) {
  RolloutResult empty = Success(10.0);
  empty.nothing_watched = true;
  const Answered answered = Ask({Times(16, empty), Times(16, empty)}, ByCost(600.0));
  EXPECT_EQ(answered.reasons->prices.at(base::FailureCode::kOther), 50.0);
}

TEST(CostSentenceTest, OneGroundTruthIsNamed) {
  const Criteria criteria = ByCost(600.0);
  Answered answered = Ask({Times(8, Success(10.2)), Times(8, Success(22.4))}, criteria);
  ASSERT_THAT(answered.why, Not(HasSubstr("ground truth")));
  answered.reasons->is_one_truth = true;
  EXPECT_THAT(WhyRecommended(answered.evidence, criteria, {"fast", "slow"}, &*answered.reasons),
              HasSubstr("; all rollouts share one ground truth; a fall costs 600 s"));
}

TEST(CostSentenceTest, LowestExpectedCostIsNamedWithItsOdds) {
  // 4 1/2 of 65 fail at 600 s: 20 s + 41.5 s against 30 s + 4.6 s.
  const std::vector<Results> results{Times(60, Success(20.0)) + Times(4, Fall(20.0)),
                                     Times(64, Success(30.0))};
  EXPECT_THAT(Ask(results, ByCost(600.0)).why,
              AllOf(HasSubstr("slow: 64 of 64"), HasSubstr("34.6 s against 61.5 s"),
                    HasSubstr("; P(best) 0.9"),
                    HasSubstr("; a fall costs 600 s; fast would be "
                              "taken if a fall cost less than 162 s")));
  // 10 s saved for 4 / 65 of a fall: it turns at 162.5 s.
  EXPECT_THAT(Ask(results, ByCost(100.0)).why,
              AllOf(HasSubstr("26.9 s against 30.8 s"),
                    HasSubstr("slow would be taken if a fall cost more than 162 s")));
}

TEST(CostSentenceTest, EqualsCannotBeSettled) {
  EXPECT_THAT(
      Ask({Times(16, Success()), Times(16, Success())}, ByCost(600.0)).why,
      HasSubstr("; near tie: not even 100000 rollouts of each would settle it; P(best) 0.50"));
}

TEST(CostSentenceTest, WhatIsNotGoodEnoughIsNotWeighed) {
  const Answered answered = Ask({Times(64, Fall(1.0)), Times(64, Success(30.0))}, ByCost(5.0));
  EXPECT_EQ(answered.why,
            "slow: 64 of 64 rollouts succeeded (at least 94 %), fast failed in 64 of 64 "
            "(object_fell 64); P(best) 1.00, expected regret 0.0 s");
  EXPECT_TRUE(answered.reasons->prices.empty());
  EXPECT_FALSE(answered.reasons->next);
}

TEST(CostSentenceTest, TheOnlyAlternativeHasNoRival) {
  const Answered answered = Ask({Times(9, Success()) + Times(1, Fall())}, ByCost(5.0), {"slow"});
  EXPECT_EQ(answered.why, "slow: the only alternative; 9 of 10 rollouts succeeded (at least 55 %)");
}

TEST(CostSentenceTest, WhereNothingIsRecommendedThereIsNoCost) {
  EXPECT_FALSE(Ask({Times(8, Fall()), Times(8, Fall())}, ByCost(5.0)).reasons);
  Criteria by_risk = ByCost(5.0);
  by_risk.rule = RankingRule::kRisk;
  EXPECT_FALSE(Ask({Times(8, Success()), Times(8, Success())}, by_risk).reasons);
}

// ---------------------------------------------------------------- where it turns

TEST(TurningPriceTest, TheAnswerTurnsThere) {
  int num_turning = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const base::Rng rng = base::Rng(6).Fork(seed);
    std::vector<Results> results;
    for (int a = 0; a < 4; ++a) {
      results.push_back(InventAll({0.06 * (3 - a), 0.02 * a, 20.0 + 4.0 * a}, rng.Fork(a), 64));
    }
    Criteria criteria = ByCost(120.0);
    criteria.prices.of[base::FailureCode::kNoPath] = 60.0;
    const std::vector<std::string> names{"a", "b", "c", "d"};
    const auto best = [&] { return *Recommended(SumUpAll(results, criteria), criteria); };
    const auto turning = Ask(results, criteria, names).reasons->turning;
    if (!turning) continue;
    ++num_turning;
    const int now = best();
    const double factor = turning->is_below ? 0.999 : 1.001;
    criteria.prices.of[turning->code] = turning->price / factor;
    EXPECT_EQ(best(), now) << "seed " << seed;
    criteria.prices.of[turning->code] = turning->price * factor;
    EXPECT_EQ(best(), turning->other) << "seed " << seed;
  }
  EXPECT_GT(num_turning, 30);  // or nothing was tested
}

TEST(TurningPriceTest, TheQuickerOneIsNamedThoughAnotherOneIsNext) {
  const Answered answered = Ask({Times(59, Success(10.0)) + Times(5, Fall(10.0)),
                                 Times(64, Success(15.0)), Times(64, Success(22.0))},
                                ByCost(600.0), {"fast", "slow", "far"});
  ASSERT_TRUE(answered.reasons->turning);
  EXPECT_EQ(answered.reasons->next->other, 2);
  EXPECT_EQ(answered.reasons->turning->other, 0);
  EXPECT_NEAR(answered.reasons->turning->price, 65.0, 1e-9);  // 5 s for five falls of 65
  EXPECT_THAT(answered.why, HasSubstr("fast would be taken if a fall cost less than 65"));
}

TEST(PriceSentenceTest, NamesEachFailureThatWasWeighed) {
  CostReasons reasons;
  EXPECT_EQ(PriceSentence(reasons), "");
  reasons.prices = {{base::FailureCode::kNoPath, 2.5}, {base::FailureCode::kObjectFell, 600.0}};
  EXPECT_EQ(PriceSentence(reasons), "a fall costs 600 s, no_path costs 2.5 s");
}

}  // namespace
}  // namespace hires::imagination::cost_reasons_test
