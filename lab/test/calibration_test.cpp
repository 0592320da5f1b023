#include "lab/src/decision/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

namespace hires::lab::calibration_test {
namespace {

/// Forecasts that are right: each event comes with the probability that was said.
std::vector<Forecast> Right(int num, base::Rng rng) {
  std::vector<Forecast> forecasts;
  for (int i = 0; i < num; ++i) {
    const double p = std::sqrt(rng.Uniform(0.0, 1.0));
    forecasts.push_back({p, rng.Bernoulli(p)});
  }
  return forecasts;
}

TEST(BrierTest, PartsWorkedByHand) {
  // Bins [0, 1/2) and [1/2, 1]: shares 0 of 1 and 2 of 3, 1/2 of all.
  const BrierParts parts = Brier({{0.2, false}, {0.8, true}, {0.8, true}, {0.8, false}}, 2);
  EXPECT_NEAR(parts.score, (0.04 + 0.04 + 0.04 + 0.64) / 4.0, 1e-12);
  EXPECT_NEAR(parts.reliability, (0.04 + 3.0 * std::pow(0.8 - 2.0 / 3.0, 2)) / 4.0, 1e-12);
  EXPECT_NEAR(parts.resolution, (0.25 + 3.0 * std::pow(1.0 / 6.0, 2)) / 4.0, 1e-12);
  EXPECT_NEAR(parts.uncertainty, 0.25, 1e-12);
  EXPECT_NEAR(parts.within, 0.0, 1e-12) << "forecasts of a bin are equal";
}

TEST(BrierTest, PartsAddUpForAnyForecastsAndBins) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const BrierParts parts = Brier(Right(50, base::Rng(seed)), 1 + static_cast<int>(seed % 12));
    EXPECT_NEAR(parts.reliability - parts.resolution + parts.uncertainty + parts.within,
                parts.score, 1e-12);
  }
}

TEST(BrierTest, OfNothingIsZero) { EXPECT_EQ(Brier({}, 10).score, 0.0); }

TEST(PoissonBinomialTest, EqualProbabilitiesGiveTheBinomial) {
  const std::vector<double> found = PoissonBinomial(std::vector<double>(20, 0.3));
  ASSERT_EQ(found.size(), 21U);
  const boost::math::binomial wanted(20, 0.3);
  for (int k = 0; k <= 20; ++k) EXPECT_NEAR(found[k], boost::math::pdf(wanted, k), 1e-12);
}

TEST(PoissonBinomialTest, TwoCoinsWorkedByHand) {
  const std::vector<double> found = PoissonBinomial({0.5, 0.2});
  EXPECT_NEAR(found[0], 0.4, 1e-12);
  EXPECT_NEAR(found[1], 0.5, 1e-12);
  EXPECT_NEAR(found[2], 0.1, 1e-12);
}

TEST(ReliabilityDiagramTest, BandsAreTheQuantilesOfTheBinomial) {
  // Of 10 at 1/2: P(X <= 1) = 11/1024 is below 2.5 %, P(X <= 2) = 56/1024 above it.
  std::vector<Forecast> forecasts(10, {0.5, true});
  const auto diagram = ReliabilityDiagram(forecasts, 10);
  ASSERT_EQ(diagram.size(), 1U) << "empty bins are left out";
  EXPECT_EQ(diagram[0].count, 10);
  EXPECT_EQ(diagram[0].share, 1.0);
  EXPECT_DOUBLE_EQ(diagram[0].lower, 0.5);
  EXPECT_DOUBLE_EQ(diagram[0].band_lower, 0.2);
  EXPECT_DOUBLE_EQ(diagram[0].band_upper, 0.8);
}

TEST(ReliabilityDiagramTest, CertaintyLeavesNoBand) {
  const auto diagram = ReliabilityDiagram({{1.0, true}, {1.0, false}}, 10);
  ASSERT_EQ(diagram.size(), 1U);
  EXPECT_EQ(diagram[0].band_lower, 1.0);
  EXPECT_EQ(diagram[0].band_upper, 1.0);
  EXPECT_EQ(diagram[0].share, 0.5);
}

TEST(SpiegelhalterTestTest, StatisticWorkedByHand) {
  // (1 - 0.2) 0.6 / sqrt(0.36 * 0.16) = 0.48 / 0.24
  const TestResult test = SpiegelhalterTest({{0.2, true}});
  EXPECT_NEAR(test.statistic, 2.0, 1e-12);
  EXPECT_NEAR(test.p_value, 0.04550026389635842, 1e-12);
  EXPECT_EQ(SpiegelhalterTest({{1.0, true}, {0.5, false}}).p_value, 1.0);
}

TEST(SpiegelhalterTestTest, RejectsRightForecastsAsOftenAsItSays) {
  int rejected = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    rejected += SpiegelhalterTest(Right(200, base::Rng(seed))).p_value < 0.05 ? 1 : 0;
  }
  EXPECT_GT(rejected, 50 - 28);  // four deviations of the binomial, 6.9
  EXPECT_LT(rejected, 50 + 28);
}

TEST(ExchangeTestTest, OneEventWorkedByHand) {
  // 9 of 9 and then a failure: one of ten failed, and it was the last one with 1/10.
  const TestResult test = ExchangeTest({{9, 9, false}});
  EXPECT_NEAR(test.statistic, -0.9, 1e-12);
  EXPECT_NEAR(test.p_value, 0.2, 1e-12);
  EXPECT_EQ(ExchangeTest({{9, 9, true}}).p_value, 1.0);
  EXPECT_EQ(ExchangeTest({}).p_value, 1.0);
}

TEST(ExchangeTestTest, KnowsThatSharesAreCounted) {
  // Eight plays foretell each event. Taken as probabilities, their shares would be rejected.
  int rejected = 0, shares_rejected = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    base::Rng rng(seed);
    std::vector<Replayed> events;
    std::vector<Forecast> forecasts;
    for (int i = 0; i < 100; ++i) {
      const double p = rng.Uniform(0.7, 1.0);
      int successes = 0;
      for (int k = 0; k < 8; ++k) successes += rng.Bernoulli(p) ? 1 : 0;
      events.push_back({successes, 8, rng.Bernoulli(p)});
      forecasts.push_back({successes / 8.0, events.back().succeeded});
    }
    rejected += ExchangeTest(events).p_value < 0.05 ? 1 : 0;
    shares_rejected += SpiegelhalterTest(forecasts).p_value < 0.05 ? 1 : 0;
  }
  EXPECT_LE(rejected, 50 + 28);
  EXPECT_GT(shares_rejected, 50 + 28) << "shares are no probabilities";
}

TEST(RandomisedPitTest, LiesAmongItsEquals) {
  base::Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const double pit = RandomisedPit({1.0, 2.0, 2.0, 3.0}, 2.0, &rng);
    EXPECT_GE(pit, 0.2);
    EXPECT_LT(pit, 0.8);
  }
  EXPECT_LT(RandomisedPit({1.0}, 0.5, &rng), 0.5);
  EXPECT_GE(RandomisedPit({1.0}, 1.5, &rng), 0.5);
}

TEST(UniformTestTest, StatisticByHandAndTheTabulatedFivePercent) {
  EXPECT_NEAR(UniformTest({0.5}).statistic, 0.5, 1e-12);
  EXPECT_NEAR(UniformTest({0.1, 0.2, 0.3}).statistic, 0.7, 1e-12);
  // 1.358 is tabulated for 5 % in the limit: 400 values that all lie 0.0675 too low.
  std::vector<double> values;
  const double shift = 1.358 / (20.0 + 0.12 + 0.11 / 20.0);
  for (int i = 0; i < 400; ++i) values.push_back(std::max(0.0, (i + 1) / 400.0 - shift));
  EXPECT_NEAR(UniformTest(values).p_value, 0.05, 1e-3);
  EXPECT_EQ(UniformTest({}).p_value, 1.0);
}

TEST(PearsonCorrelationTest, PerfectNoneAndWorkedByHand) {
  EXPECT_NEAR(PearsonCorrelation({1.0, 2.0, 3.0}, {2.0, 4.0, 6.0}).estimate, 1.0, 1e-12);
  EXPECT_EQ(PearsonCorrelation({1.0, 1.0}, {2.0, 4.0}).estimate, 0.0);
  // Deviations (-1.5, -0.5, 0.5, 1.5) and (-1.5, 0.5, -0.5, 1.5): 4 / 5.
  const Interval r = PearsonCorrelation({1.0, 2.0, 3.0, 4.0}, {1.0, 3.0, 2.0, 4.0});
  EXPECT_NEAR(r.estimate, 0.8, 1e-12);
  EXPECT_NEAR(r.lower, std::tanh(std::atanh(0.8) - 1.959963984540054), 1e-12);
}

TEST(MeanMaximumRankViolationTest, WorkedByHand) {
  EXPECT_EQ(MeanMaximumRankViolation({0.1, 0.5, 0.9}, {0.2, 0.3, 0.8}), 0.0);
  // The first two are swapped: each violates by 0.1, the third by nothing.
  EXPECT_NEAR(MeanMaximumRankViolation({0.5, 0.1, 0.9}, {0.2, 0.3, 0.8}), 0.2 / 3.0, 1e-12);
}

}  // namespace
}  // namespace hires::lab::calibration_test
