#include "hires/imagination/expected_regret.h"

#include <gmock/gmock.h>

#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <numeric>

#include "hires/base/rng.h"

namespace hires::imagination::expected_regret_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Le;

/// Never fails at a cost: the mean duration is normal.
CostPosterior Normal(double mean, double sd, double rollouts = 16.0) {
  return {mean, sd, 0.0, 0.0, rollouts};
}

/// Duration known exactly, `failures` of `rollouts` failed at 600 s.
CostPosterior Failing(double duration, int failures, int rollouts) {
  return {duration, 0.0, 600.0, 1.0 * failures, 1.0 * rollouts};
}

TEST(CostPosteriorTest, MeanAndVarianceAreThoseOfTheBetaDistribution) {
  // Beta(1/2, 64 1/2): mean 1/130, variance (1/130)(129/130)/66.
  const CostPosterior flawless = Failing(20.0, 0, 64);
  EXPECT_DOUBLE_EQ(flawless.Mean(), 20.0 + 600.0 / 130.0);
  EXPECT_NEAR(flawless.Variance(), 360000.0 * 129.0 / (130.0 * 130.0 * 66.0), 1e-9);
  EXPECT_DOUBLE_EQ(Normal(20.0, 3.0).Variance(), 9.0);
}

TEST(OddsOfTest, OneAlternativeIsBest) {
  const BestOdds odds = OddsOf({Failing(20.0, 3, 16)});
  EXPECT_THAT(odds.probability, ElementsAre(1.0));
  EXPECT_THAT(odds.regret, ElementsAre(0.0));
}

TEST(OddsOfTest, EqualsShareTheProbability) {
  const BestOdds odds = OddsOf({Failing(20.0, 1, 16), Failing(20.0, 1, 16)});
  EXPECT_NEAR(odds.probability[0], 0.5, 1e-9);
  EXPECT_NEAR(odds.probability[1], 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(odds.regret[0], odds.regret[1]);
}

TEST(OddsOfTest, NormalCostsFollowTheClosedForm) {
  // d = 1 s apart, each with a standard deviation of 1 s: P = Phi(1 / sqrt(2)) = 0.7602; the loss
  // of the better one is sqrt(2) (phi(z) - z (1 - Phi(z))) = 0.1996 s with z = 1 / sqrt(2), of the
  // other one that plus d.
  const BestOdds odds = OddsOf({Normal(10.0, 1.0), Normal(11.0, 1.0)});
  EXPECT_NEAR(odds.probability[0], 0.7602, 0.002);
  EXPECT_NEAR(odds.regret[0], 0.1996, 0.002);
  EXPECT_NEAR(odds.regret[1] - odds.regret[0], 1.0, 1e-9);
}

TEST(OddsOfTest, UnseenFailuresFollowTheBetaDistribution) {
  // 10 s for certain against 5 s and 16 flawless rollouts: the other one is cheaper where
  // p < 5 / 600.
  const BestOdds odds = OddsOf({Normal(10.0, 0.0), Failing(5.0, 0, 16)});
  const boost::math::beta_distribution<> failing(0.5, 16.5);
  EXPECT_NEAR(odds.probability[1], boost::math::cdf(failing, 5.0 / 600.0), 0.015);
  double regret = 0.0;  // E[max(0, 5 - 600 p)]
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    regret += std::max(0.0, 5.0 - 600.0 * boost::math::quantile(failing, (i + 0.5) / kSteps));
  }
  EXPECT_NEAR(odds.regret[0], regret / kSteps, 0.05);
}

TEST(OddsOfTest, ProbabilitiesOfSeveralAddUpToOne) {
  for (int seed = 0; seed < 50; ++seed) {
    base::Rng rng = base::Rng(3).Fork(seed);
    std::vector<CostPosterior> alternatives;
    for (int i = 0; i < 4; ++i) {
      alternatives.push_back({rng.Uniform(10.0, 20.0), rng.Uniform(0.0, 1.0), 600.0,
                              1.0 * rng.Index(5), 16.0 + rng.Index(100)});
    }
    const BestOdds odds = OddsOf(alternatives);
    EXPECT_NEAR(std::accumulate(odds.probability.begin(), odds.probability.end(), 0.0), 1.0, 1e-9);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_GE(odds.regret[i], 0.0);
  }
}

TEST(OddsOfTest, MoreFlawlessRolloutsOfBothLowerTheRegretOfTheQuickerOne) {
  double last = 1e9;
  for (int n = 16; n <= 1024; n *= 2) {
    const double regret = OddsOf({Failing(10.0, 0, n), Failing(22.0, 0, n)}).regret[0];
    EXPECT_LE(regret, last) << n;
    last = regret;
  }
  EXPECT_LT(last, 0.01);
}

TEST(AllocateRoundTest, EqualsGetEqualShares) {
  EXPECT_THAT(AllocateRound({Normal(10.0, 1.0), Normal(10.0, 1.0)}, 0, 16, {100, 100}),
              ElementsAre(8, 8));
}

TEST(AllocateRoundTest, TheClosestRivalAndTheNoisiestGetMost) {
  const auto round = AllocateRound({Normal(10.0, 1.0), Normal(11.0, 1.0), Normal(30.0, 1.0)}, 0, 16,
                                   {100, 100, 100});
  EXPECT_EQ(round[2], 0);
  EXPECT_GE(round[0], 6);
  EXPECT_GE(round[1], 6);
  const auto noisy = AllocateRound({Normal(10.0, 0.1), Normal(11.0, 2.0)}, 0, 16, {100, 100});
  EXPECT_EQ(noisy[0], 0);
  EXPECT_EQ(noisy[1], 16);
}

TEST(AllocateRoundTest, AlternativeWithoutRoomGetsNothing) {
  EXPECT_THAT(AllocateRound({Normal(10.0, 1.0), Normal(11.0, 1.0)}, 0, 16, {0, 100}),
              ElementsAre(0, 16));
  EXPECT_THAT(AllocateRound({Normal(10.0, 1.0), Normal(11.0, 1.0)}, 0, 16, {5, 2}),
              ElementsAre(Le(5), Le(2)));
  EXPECT_THAT(AllocateRound({Normal(10.0, 1.0), Normal(11.0, 1.0)}, 0, 16, {0, 0}), Each(0));
}

TEST(AllocateRoundTest, WithoutAnyDifferenceAllGetTheSame) {
  EXPECT_THAT(AllocateRound({Normal(10.0, 0.0), Normal(99.0, 0.0)}, 0, 16, {100, 100}),
              ElementsAre(8, 8));
}

TEST(RolloutsToSettleTest, NumberOfRolloutsSettlesTheChoice) {
  for (const auto& [own, other] : std::vector<std::pair<CostPosterior, CostPosterior>>{
           {Failing(10.0, 0, 64), Failing(12.0, 0, 64)},
           {Failing(10.0, 4, 64), Failing(30.0, 1, 64)},
           {Normal(10.0, 1.0), Normal(10.5, 1.0)}}) {
    const std::vector<CostPosterior> both{own, other};
    ASSERT_LT(OddsOf(both).probability[0], 0.95);
    const auto needed = RolloutsToSettle(both, 0.95, 100000);
    ASSERT_TRUE(needed);
    std::vector<CostPosterior> later = both;
    for (CostPosterior& one : later) {
      const double factor = *needed / one.rollouts;
      one.failures *= factor;
      one.duration_sd /= std::sqrt(factor);
      one.rollouts = *needed;
    }
    const auto odds = OddsOf(later).probability;
    EXPECT_GE(std::max(odds[0], odds[1]), 0.95);
  }
}

TEST(RolloutsToSettleTest, EqualsAreNeverSettled) {
  EXPECT_EQ(RolloutsToSettle({Failing(10.0, 1, 64), Failing(10.0, 1, 64)}, 0.95, 100000),
            std::nullopt);
}

}  // namespace
}  // namespace hires::imagination::expected_regret_test
