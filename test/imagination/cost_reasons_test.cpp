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

Answered Ask(const std::vector<Results>& results, const Criteria& criteria,
             const std::vector<std::string>& names = {"fast", "slow"}) {
  Answered answered;
  std::vector<const Results*> apart;
  for (const Results& of_one : results) {
    apart.push_back(&of_one);
    answered.evidence.push_back(SumUp(of_one, static_cast<int>(of_one.size()),
                                      IntervalKind::kClopperPearson, criteria.prices));
  }
  answered.reasons = CostReasonsOf(apart, answered.evidence, criteria);
  answered.why = WhyRecommended(answered.evidence, criteria, names,
                                answered.reasons ? &*answered.reasons : nullptr);
  return answered;
}

CostComparison Compare(const Results& a, const Results& b, double price_of_fall = 600.0) {
  return CompareCosts(a, b, static_cast<int>(a.size()), ByCost(price_of_fall).prices);
}

// ---------------------------------------------------------------- two alternatives

TEST(CompareCostsTest, SecondsAndFailuresAreMeansOfPairs) {
  const CostComparison with = Compare(Times(60, Success(20.0)) + Times(4, Fall(20.0)),
                                      Times(62, Success(30.0)) + Times(2, NoPath()));
  EXPECT_NEAR(with.time_saved, (62 * 30.0 - 64 * 20.0) / 64.0, 1e-12);
  EXPECT_NEAR(with.failures_more, (4 * 600.0 - 2 * 50.0) / 64.0, 1e-12);
  EXPECT_GT(with.failures_more_upper, with.failures_more);
  EXPECT_FALSE(with.neither_failed);
  EXPECT_FALSE(with.IsAlike());
}

TEST(CompareCostsTest, EqualsAreAsLikelyOneAsTheOther) {
  const CostComparison with = Compare(Times(16, Success()), Times(16, Success()));
  EXPECT_NEAR(with.probability, 0.5, 1e-9);
  EXPECT_TRUE(with.neither_failed);
  EXPECT_FALSE(with.IsAlike()) << "neither is quicker";
}

TEST(CompareCostsTest, TheSlowerOneIsNotTakenAsTheQuickerOne) {
  const CostComparison with = Compare(Times(64, Success(30.0)), Times(64, Fall(20.0)));
  EXPECT_LT(with.failures_more_upper, with.time_saved);
  EXPECT_FALSE(with.IsAlike());
}

TEST(CompareCostsTest, OneIsAsSureAsTheOtherIsNot) {
  for (int seed = 0; seed < 50; ++seed) {
    const base::Rng rng = base::Rng(8).Fork(seed);
    const Results a = InventAll({0.1, 0.05, 20.0}, rng.Fork(1), 32);
    const Results b = InventAll({0.05, 0.1, 24.0}, rng.Fork(2), 32);
    EXPECT_NEAR(Compare(a, b).probability + Compare(b, a).probability, 1.0, 1e-6);
  }
}

TEST(CompareCostsTest, MoreRolloutsWithoutAFailureMakeTheQuickerOneSurer) {
  double last = 0.5;
  for (int n = 16; n <= 1024; n *= 2) {
    const double now = Compare(Times(n, Success(10.2)), Times(n, Success(22.4))).probability;
    EXPECT_GE(now, last) << n;
    last = now;
  }
  EXPECT_GT(last, 0.999);
}

TEST(CompareCostsTest, WhatSavesMoreThanAnyFailureCostsIsCertain) {
  EXPECT_EQ(Compare(Times(1, Success(1.0)), Times(1, Success(299.0)), 100.0).probability, 1.0);
}

/// k and a half exponentials: the gamma distribution of k + 1/2.
double Gamma(int k, base::Rng* rng) {
  double sum = 0.5 * std::pow(rng->Normal(0.0, 1.0), 2);
  for (int i = 0; i < k; ++i) sum -= std::log(1.0 - rng->Uniform(0.0, 1.0));
  return sum;
}

TEST(CompareCostsTest, TheProbabilityIsThatOfDrawnShares) {  // the other road to the number
  const Results fast = Times(61, Success(20.0)) + Times(3, Fall(20.0));
  const Results slow = Times(1, NoPath()) + Times(63, Success(45.0));
  const CostComparison with = Compare(fast, slow);
  base::Rng rng(9);
  int cheaper = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const double its = Gamma(3, &rng), others = Gamma(1, &rng), equal = Gamma(60, &rng);
    cheaper += (600.0 * its - 50.0 * others) / (its + others + equal) < with.time_saved;
  }
  EXPECT_NEAR(with.probability, static_cast<double>(cheaper) / kDraws, 0.015);
}

// ---------------------------------------------------------------- what is said

TEST(CostSentenceTest, OfTwoThatNeverFailedTheQuickerOneIsTaken) {
  const Answered answered =
      Ask({Times(64, Success(10.2, 12)), Times(64, Success(22.4))}, ByCost(600.0));
  EXPECT_EQ(
      answered.why,
      "fast: 64 of 64 rollouts succeeded (at least 94 %), good enough like slow; neither "
      "failed, so the quicker one is taken, 10.2 s against 22.4 s; it costs less with "
      "probability 0.93, as a failure may have stayed unseen in 64 rollouts; a fall costs 600 s");
  EXPECT_EQ(answered.reasons->prices.at(base::FailureCode::kObjectFell), 600.0);
  EXPECT_FALSE(answered.reasons->turning);
}

TEST(CostSentenceTest, OfOneTruthNothingStaysUnseen) {
  const Criteria criteria = ByCost(600.0);
  Answered answered = Ask({Times(8, Success(10.2)), Times(8, Success(22.4))}, criteria);
  ASSERT_THAT(answered.why, HasSubstr("may have stayed unseen in 8 rollouts"));
  answered.reasons->is_one_truth = true;
  const std::string why =
      WhyRecommended(answered.evidence, criteria, {"fast", "slow"}, &*answered.reasons);
  EXPECT_THAT(why, HasSubstr("taken, 10.2 s against 22.4 s; all rollouts are of one and the same "
                             "truth; a fall costs 600 s"));
  EXPECT_THAT(why, Not(HasSubstr("unseen")));
}

TEST(CostSentenceTest, FewFailuresThatCannotOutweighTheSecondsAreSaidSo) {
  const Answered answered =
      Ask({Times(511, Success(10.0)) + Times(1, Fall(10.0)), Times(512, Success(200.0))},
          ByCost(100.0));
  EXPECT_THAT(answered.why,
              AllOf(HasSubstr(", and quicker by 190.0 s, which is more than its failures may cost "
                              "beyond those of the other (at most "),
                    HasSubstr("), so the quicker one is taken; a fall costs 100 s")));
  EXPECT_TRUE(answered.reasons->next->IsAlike());
}

TEST(CostSentenceTest, ElseTheLeastCostIsSaidWithHowSureItIs) {
  const std::vector<Results> results{Times(60, Success(20.0)) + Times(4, Fall(20.0)),
                                     Times(64, Success(30.0))};
  EXPECT_EQ(Ask(results, ByCost(600.0)).why,
            "slow: 64 of 64 rollouts succeeded (at least 94 %), good enough like fast, and its "
            "expected cost is lower, 30.0 s against 57.5 s, with probability 0.93; a fall costs "
            "600 s; fast would be taken if a fall cost less than 160 s");
  EXPECT_THAT(Ask(results, ByCost(100.0)).why,
              AllOf(HasSubstr("26.2 s against 30.0 s, with probability 0."),
                    HasSubstr("slow would be taken if a fall cost more than 160 s")));
}

TEST(CostSentenceTest, OneFallInSixteenIsNotTakenForNone) {
  const std::vector<Results> results{Times(15, Success(10.2)) + Times(1, Fall(10.2)),
                                     Times(16, Success(22.4))};
  const Answered answered = Ask(results, ByCost(100.0));
  EXPECT_THAT(answered.why, AllOf(HasSubstr("fast: 15 of 16"), HasSubstr("with probability 0."),
                                  Not(HasSubstr("neither failed"))));
  EXPECT_FALSE(answered.reasons->next->IsAlike());
}

TEST(CostSentenceTest, WhatIsNotGoodEnoughIsNotWeighed) {
  const Answered answered = Ask({Times(64, Fall(1.0)), Times(64, Success(30.0))}, ByCost(5.0));
  EXPECT_EQ(answered.why,
            "slow: 64 of 64 rollouts succeeded (at least 94 %), fast failed in 64 of 64 "
            "(object_fell 64)");
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
  for (int seed = 0; seed < 200; ++seed) {
    const base::Rng rng = base::Rng(6).Fork(seed);
    std::vector<Results> results;
    for (int a = 0; a < 4; ++a) {
      results.push_back(InventAll({0.06 * (3 - a), 0.02 * a, 20.0 + 4.0 * a}, rng.Fork(a), 64));
    }
    Criteria criteria = ByCost(120.0);
    criteria.prices.of[base::FailureCode::kNoPath] = 60.0;
    const std::vector<std::string> names{"a", "b", "c", "d"};
    const auto best = [&] {
      return *Recommended(Ask(results, criteria, names).evidence, criteria);
    };
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
  EXPECT_GT(num_turning, 100);  // or nothing was tested
}

TEST(TurningPriceTest, TheQuickerOneIsNamedThoughAnotherOneIsNext) {
  const Answered answered = Ask({Times(59, Success(10.0)) + Times(5, Fall(10.0)),
                                 Times(64, Success(15.0)), Times(64, Success(22.0))},
                                ByCost(600.0), {"fast", "slow", "far"});
  ASSERT_TRUE(answered.reasons->turning);
  EXPECT_EQ(answered.reasons->next->other, 2);
  EXPECT_EQ(answered.reasons->turning->other, 0);
  EXPECT_NEAR(answered.reasons->turning->price, 64.0, 1e-9);  // 5 s for five falls of 64
  EXPECT_THAT(answered.why, HasSubstr("fast would be taken if a fall cost less than 64 s"));
}

TEST(PriceSentenceTest, NamesEachFailureThatWasWeighed) {
  CostReasons reasons;
  EXPECT_EQ(PriceSentence(reasons), "");
  reasons.prices = {{base::FailureCode::kNoPath, 2.5}, {base::FailureCode::kObjectFell, 600.0}};
  EXPECT_EQ(PriceSentence(reasons), "a fall costs 600 s, no_path costs 2.5 s");
}

}  // namespace
}  // namespace hires::imagination::cost_reasons_test
