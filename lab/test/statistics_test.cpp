#include "lab/src/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hires::lab::statistics_test {
namespace {

TEST(BootstrapIntervalTest, ItHoldsTheMeanAndStaysWithinTheValues) {
  EXPECT_EQ(BootstrapInterval({}, base::Rng(1)).upper, 0.0);
  const Interval same = BootstrapInterval({0.5, 0.5, 0.5}, base::Rng(1));
  EXPECT_EQ(same.lower, 0.5);
  EXPECT_EQ(same.upper, 0.5);
  std::vector<double> sure(20, 1.0);
  sure[0] = 0.4;
  const Interval high = BootstrapInterval(sure, base::Rng(1));
  EXPECT_NEAR(high.estimate, 0.97, 1e-12);
  EXPECT_EQ(high.upper, 1.0) << "the value is left out by a third of the resamples";
  EXPECT_NEAR(high.lower, 0.91, 1e-9) << "three times 0.4 in 20 draws: 97.5 % have no more";
}

TEST(BootstrapIntervalTest, OfManyNormalValuesItIsTheNormalOne) {
  base::Rng rng(2);
  std::vector<double> values(1000);
  for (double& value : values) value = rng.Normal(3.0, 2.0);
  const Interval boot = BootstrapInterval(values, base::Rng(1)), mean = MeanInterval(values);
  EXPECT_NEAR(boot.lower, mean.lower, 0.01);
  EXPECT_NEAR(boot.upper, mean.upper, 0.01);
}

TEST(PercentileIntervalTest, TakesTwoAndAHalfPercentFromEitherEndWhateverTheOrder) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back((i * 8) % 1001);  // 0 .. 1000, shuffled
  const Interval interval = PercentileInterval(444.0, values);
  EXPECT_EQ(interval.estimate, 444.0);
  EXPECT_EQ(interval.lower, 25.0);
  EXPECT_EQ(interval.upper, 975.0);
}

TEST(PercentileIntervalTest, LeavesOutWhatIsNoNumberAndKeepsWhatIsInfinite) {
  const double no_number = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const Interval some = PercentileInterval(2.0, {no_number, 2.0, infinite, no_number, 2.0});
  EXPECT_EQ(some.lower, 2.0);
  EXPECT_EQ(some.upper, infinite);
  const Interval none = PercentileInterval(no_number, {no_number, no_number});
  EXPECT_TRUE(std::isnan(none.lower));
  EXPECT_TRUE(std::isnan(none.upper));
}

TEST(MeanTest, OfNothingIsZero) {
  EXPECT_EQ(Mean({}), 0.0);
  EXPECT_EQ(Deviation({}), 0.0);
}

TEST(MeanTest, DeviationDividesByTheNumberOfValues) {
  EXPECT_DOUBLE_EQ(Mean({2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}), 5.0);
  EXPECT_DOUBLE_EQ(Deviation({2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}), 2.0);
}

TEST(MeanIntervalTest, ThreeValuesUseStudentsTWithTwoDegrees) {
  // Deviation 1, so the half width is 4.302653 / sqrt(3).
  const Interval interval = MeanInterval({1.0, 2.0, 3.0});
  EXPECT_DOUBLE_EQ(interval.estimate, 2.0);
  EXPECT_NEAR(interval.lower, 2.0 - 2.484138, 1e-6);
  EXPECT_NEAR(interval.upper, 2.0 + 2.484138, 1e-6);
  EXPECT_FALSE(interval.ExcludesZero());
}

TEST(MeanIntervalTest, EqualDifferencesLeaveNoDoubt) {
  const Interval interval = MeanInterval({0.5, 0.5, 0.5, 0.5});
  EXPECT_EQ(interval.lower, 0.5);
  EXPECT_EQ(interval.upper, 0.5);
  EXPECT_TRUE(interval.ExcludesZero());
}

TEST(MeanIntervalTest, OneDifferenceProvesNothing) {
  const Interval interval = MeanInterval({3.0});
  EXPECT_TRUE(std::isinf(interval.lower));
  EXPECT_TRUE(std::isinf(interval.upper));
  EXPECT_FALSE(interval.ExcludesZero());
  EXPECT_FALSE(MeanInterval({}).ExcludesZero());
}

// Brown, Cai, DasGupta 2001, Stat. Sci. 16:101: bounds p with |x/n - p| = z sqrt(p (1 - p) / n).
TEST(WilsonIntervalTest, BoundsAreWhereTheScoreIsTheNormalQuantile) {
  constexpr double kQuantile = 1.959963984540054;
  for (int n = 1; n <= 40; ++n) {
    for (int k = 0; k <= n; ++k) {
      const Interval interval = WilsonInterval(k, n);
      EXPECT_EQ(interval.estimate, static_cast<double>(k) / n);
      for (const double p : {interval.lower, interval.upper}) {
        if (p == 0.0 || p == 1.0) continue;
        EXPECT_NEAR(std::abs(interval.estimate - p), kQuantile * std::sqrt(p * (1.0 - p) / n), 1e-9)
            << k << " of " << n;
      }
    }
  }
  EXPECT_EQ(WilsonInterval(0, 10).lower, 0.0);
  EXPECT_EQ(WilsonInterval(10, 10).upper, 1.0);
  EXPECT_EQ(WilsonInterval(0, 0).upper, 1.0);
  EXPECT_THROW(WilsonInterval(3, 2), std::logic_error);
}

TEST(ShareIntervalTest, EightOfTenGivesTheTabulatedBounds) {
  const Interval interval = ShareInterval(8, 10);
  EXPECT_DOUBLE_EQ(interval.estimate, 0.8);
  EXPECT_NEAR(interval.lower, 0.44390, 1e-5);
  EXPECT_NEAR(interval.upper, 0.97479, 1e-5);
}

TEST(ShareIntervalTest, AtTheEndsTheBoundsAreThePowersWorkedByHand) {
  EXPECT_EQ(ShareInterval(0, 10).lower, 0.0);
  EXPECT_NEAR(ShareInterval(0, 10).upper, 1.0 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_NEAR(ShareInterval(10, 10).lower, std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(ShareInterval(10, 10).upper, 1.0);
  EXPECT_EQ(ShareInterval(0, 0).upper, 1.0);
}

TEST(ShareIntervalTest, BoundsAreWhereTheTailsHoldFortiethParts) {
  // P(X >= k | lower) = P(X <= k | upper) = 0.025, summed up term by term.
  for (int n = 1; n <= 30; ++n) {
    for (int k = 1; k < n; ++k) {
      const Interval interval = ShareInterval(k, n);
      double above = 0.0, below = 0.0, binomial = 1.0;
      for (int i = 0; i <= n; ++i) {
        const auto term = [&](double p) {
          return binomial * std::pow(p, i) * std::pow(1 - p, n - i);
        };
        if (i >= k) above += term(interval.lower);
        if (i <= k) below += term(interval.upper);
        binomial = binomial * (n - i) / (i + 1);
      }
      EXPECT_NEAR(above, 0.025, 1e-9) << k << " of " << n;
      EXPECT_NEAR(below, 0.025, 1e-9) << k << " of " << n;
    }
  }
}

TEST(ShareIntervalTest, MoreHitsThanAllAreRefused) {
  EXPECT_THROW(ShareInterval(3, 2), std::logic_error);
  EXPECT_THROW(ShareInterval(-1, 2), std::logic_error);
}

TEST(ClusteredShareIntervalTest, ClustersOfOneCaseAreIndependentCases) {
  for (const int hits : {1, 8, 19}) {
    std::vector<ClusterCounts> clusters(20, ClusterCounts{0, 1});
    for (int i = 0; i < hits; ++i) clusters[i].num_hits = 1;
    clusters.push_back({0, 0});
    const Interval clustered = ClusteredShareInterval(clusters), exact = ShareInterval(hits, 20);
    EXPECT_DOUBLE_EQ(clustered.estimate, exact.estimate);
    EXPECT_NEAR(clustered.lower, exact.lower, 1e-9);
    EXPECT_NEAR(clustered.upper, exact.upper, 1e-9);
  }
}

// Clusters of 1 and 3 of 4 around a half: the sum of squared deviations is 20 * 1, so the variance
// is 20 / 19 * 20 / 80^2, that of 80 independent cases 1 / (4 * 79): a design effect of 1.03947.
// All 20 have hits and misses; with one more cluster of effect 4 it is 1.18045. With t's quantiles
// 1.990450 and 2.093024 that is as much as 61.29 cases.
TEST(ClusteredShareIntervalTest, OfTwentyEqualClustersItIsTheIntervalWorkedByHand) {
  std::vector<ClusterCounts> clusters(20, ClusterCounts{1, 4});
  for (int i = 0; i < 10; ++i) clusters[i].num_hits = 3;
  const double effect = 20.0 / 19.0 * 20.0 / 6400.0 * 4.0 * 79.0;
  EXPECT_NEAR(effect, 1.03947, 1e-5);
  const double cases = 80.0 / ((20.0 * effect + 4.0) / 21.0) * std::pow(1.990450 / 2.093024, 2);
  EXPECT_NEAR(cases, 61.29, 0.01);
  const boost::math::beta_distribution<> low(0.5 * cases, 0.5 * cases + 1.0);
  const Interval interval = ClusteredShareInterval(clusters);
  EXPECT_DOUBLE_EQ(interval.estimate, 0.5);
  EXPECT_NEAR(interval.lower, boost::math::quantile(low, 0.025), 1e-6);
  EXPECT_NEAR(interval.upper, 1.0 - interval.lower, 1e-9);
}

TEST(ClusteredShareIntervalTest, WhereAllAreHitsEachOfEqualClustersIsOneCase) {
  const Interval sure = ClusteredShareInterval({{4, 4}, {4, 4}, {4, 4}});
  EXPECT_EQ(sure.upper, 1.0);
  EXPECT_NEAR(sure.lower, ShareInterval(3, 3).lower, 1e-12);
  EXPECT_NEAR(ClusteredShareInterval({{0, 4}, {0, 4}}).upper, ShareInterval(0, 2).upper, 1e-12);
  // Of 4, 2 and 7 cases: 13^2 / (16 + 4 + 49).
  EXPECT_NEAR(ClusteredShareInterval({{4, 4}, {2, 2}, {7, 7}}).lower, std::pow(0.025, 69.0 / 169.0),
              1e-12);
}

TEST(ClusteredShareIntervalTest, OneClusterAndNothingSayLittle) {
  const Interval one = ClusteredShareInterval({{3, 4}});
  EXPECT_DOUBLE_EQ(one.estimate, 0.75);
  EXPECT_LT(one.lower, 0.05);
  EXPECT_GT(one.upper, 0.95);
  EXPECT_EQ(ClusteredShareInterval({{0, 0}}).lower, 0.0);
  EXPECT_EQ(ClusteredShareInterval({}).upper, 1.0);
  EXPECT_THROW(ClusteredShareInterval({{3, 2}}), std::logic_error);
}

/// @param alike  how often a case goes as its cluster does instead of by itself.
std::vector<ClusterCounts> DrawClusters(double share, double alike, base::Rng* rng) {
  std::vector<ClusterCounts> clusters(100);
  for (ClusterCounts& one : clusters) {
    one.num_all = 1 + rng->Index(7);
    const bool all_hit = rng->Bernoulli(share);
    for (int i = 0; i < one.num_all; ++i) {
      const bool hit = rng->Bernoulli(alike) ? all_hit : rng->Bernoulli(share);
      one.num_hits += hit ? 1 : 0;
    }
  }
  return clusters;
}

bool Covers(const Interval& interval, double share) {
  return interval.lower <= share && share <= interval.upper;
}

// 2000 draws know a coverage of 0.95 to three deviations of 0.005.
TEST(ClusteredShareIntervalTest, CoversTheTruthAsOftenAsItSaysHoweverAlikeCasesOfAClusterAre) {
  constexpr int kDraws = 2000;
  base::Rng rng(1);
  for (const double share : {0.5, 0.9, 0.98}) {
    for (const double alike : {0.0, 0.7, 1.0}) {
      int clustered = 0, as_if_independent = 0;
      for (int draw = 0; draw < kDraws; ++draw) {
        const auto clusters = DrawClusters(share, alike, &rng);
        const ClusterCounts sum = SumOf(clusters);
        clustered += Covers(ClusteredShareInterval(clusters), share) ? 1 : 0;
        as_if_independent += Covers(ShareInterval(sum.num_hits, sum.num_all), share) ? 1 : 0;
      }
      SCOPED_TRACE(testing::Message() << share << " alike " << alike);
      EXPECT_GE(clustered, 0.935 * kDraws);
      if (alike == 1.0) {
        EXPECT_LT(as_if_independent, 0.8 * kDraws) << "what the clusters are for";
      }
    }
  }
}

TEST(McNemarTest, TailsAreCountedByHand) {
  EXPECT_DOUBLE_EQ(McNemarPValue({10, 2, 50}), 2.0 * (1 + 12 + 66) / 4096.0);
  EXPECT_DOUBLE_EQ(McNemarPValue({0, 6, 6}), 2.0 / 64.0);
  EXPECT_DOUBLE_EQ(McNemarPValue({3, 3, 9}), 1.0);
  EXPECT_DOUBLE_EQ(McNemarPValue({0, 0, 9}), 1.0);
}

TEST(PairedShareDifferenceTest, TenAgainstTwoOfFiftyIsTheScaledShareInterval) {
  const Interval difference = PairedShareDifference({10, 2, 50});
  const Interval share = ShareInterval(10, 12);
  EXPECT_DOUBLE_EQ(difference.estimate, 8.0 / 50.0);
  EXPECT_DOUBLE_EQ(difference.lower, (2.0 * share.lower - 1.0) * 12.0 / 50.0);
  EXPECT_DOUBLE_EQ(difference.upper, (2.0 * share.upper - 1.0) * 12.0 / 50.0);
}

TEST(PairedShareDifferenceTest, ExcludesZeroExactlyWhenTheExactTestRejects) {
  for (int first = 0; first <= 25; ++first) {
    for (int second = 0; second <= 25; ++second) {
      const PairedCounts counts{first, second, 60};
      EXPECT_EQ(PairedShareDifference(counts).ExcludesZero(), McNemarPValue(counts) < 0.05)
          << first << " : " << second;
    }
  }
}

TEST(PairedShareDifferenceTest, ChangesItsSignWithTheOrder) {
  const Interval forth = PairedShareDifference({7, 3, 20}),
                 back = PairedShareDifference({3, 7, 20});
  EXPECT_DOUBLE_EQ(forth.estimate, -back.estimate);
  EXPECT_NEAR(forth.lower, -back.upper, 1e-12);
}

TEST(PairedShareDifferenceTest, WithoutDiscordantPairsTheirNumberBoundsTheDifference) {
  EXPECT_FALSE(PairedShareDifference({0, 0, 100}).ExcludesZero());
  EXPECT_NEAR(PairedShareDifference({0, 0, 100}).upper, 0.03622, 1e-5);
  EXPECT_EQ(PairedShareDifference({0, 0, 0}).upper, 1.0);
}

TEST(PairedShareDifferenceTest, MoreDiscordantPairsThanPairsAreRefused) {
  EXPECT_THROW(PairedShareDifference({2, 2, 3}), std::logic_error);
  EXPECT_THROW(McNemarPValue({-1, 2, 3}), std::logic_error);
}

// 1 and 7 discordant pairs of 21 (Bentur et al. 2009, airway reactivity before and after stem cell
// transplantation) are the example of Fagerland, Lydersen, Laake 2014: -0.517 .. -0.026.
TEST(PairedScoreIntervalTest, OneAgainstSevenOfTwentyOneIsThePublishedInterval) {
  const Interval difference = PairedScoreInterval({1, 7, 21});
  EXPECT_DOUBLE_EQ(difference.estimate, -6.0 / 21.0);
  EXPECT_NEAR(difference.lower, -0.517232, 1e-6);
  EXPECT_NEAR(difference.upper, -0.026003, 1e-6);
}

TEST(PairedScoreIntervalTest, WithoutDiscordantPairsItIsKnownInClosedForm) {
  constexpr double kSquare = 3.841458820694124;  // of the normal's 97.5 % quantile
  for (const int n : {1, 20, 500}) {
    EXPECT_NEAR(PairedScoreInterval({0, 0, n}).upper, kSquare / (n + kSquare), 1e-9) << n;
    EXPECT_NEAR(PairedScoreInterval({0, 0, n}).lower, -kSquare / (n + kSquare), 1e-9) << n;
  }
  EXPECT_EQ(PairedScoreInterval({0, 0, 0}).upper, 1.0);
  EXPECT_EQ(PairedScoreInterval({0, 0, 0}).lower, -1.0);
}

TEST(PairedScoreIntervalTest, ReachesTheEndWhereOneMemberAlwaysWins) {
  EXPECT_DOUBLE_EQ(PairedScoreInterval({20, 0, 20}).upper, 1.0);
  EXPECT_NEAR(PairedScoreInterval({20, 0, 20}).lower, 0.677750, 1e-6);
  EXPECT_DOUBLE_EQ(PairedScoreInterval({0, 20, 20}).lower, -1.0);
}

/// Logarithm of the likelihood, but for a constant, of shares q + difference, q and the rest.
double LogLikelihood(const PairedCounts& counts, double difference, double q) {
  const auto term = [](int count, double share) {
    return count == 0 ? 0.0 : count * std::log(std::max(share, 1e-300));
  };
  return term(counts.only_first, q + difference) + term(counts.only_second, q) +
         term(counts.num_pairs - counts.only_first - counts.only_second,
              1.0 - 2.0 * q - difference);
}

/// The q that is likeliest given the difference, by thirds: the likelihood has one summit.
double LikeliestShare(const PairedCounts& counts, double difference) {
  double lower = std::max(0.0, -difference), upper = 0.5 * (1.0 - difference);
  for (int i = 0; i < 300; ++i) {
    const double left = lower + (upper - lower) / 3.0, right = upper - (upper - lower) / 3.0;
    const bool is_left_better =
        LogLikelihood(counts, difference, left) > LogLikelihood(counts, difference, right);
    (is_left_better ? upper : lower) = is_left_better ? right : left;
  }
  return 0.5 * (lower + upper);
}

// Two roads: at both ends the score with a share that was searched for is the normal's quantile.
TEST(PairedScoreIntervalTest, EndsWhereTheScoreTestBeginsToReject) {
  for (const PairedCounts& counts : {PairedCounts{5, 2, 20}, PairedCounts{1, 7, 21},
                                     PairedCounts{12, 3, 20}, PairedCounts{30, 40, 100}}) {
    const Interval interval = PairedScoreInterval(counts);
    for (const double end : {interval.lower, interval.upper}) {
      const double q = LikeliestShare(counts, end), n = counts.num_pairs;
      const double variance = (2.0 * q + end * (1.0 - end)) / n;
      EXPECT_NEAR(std::abs(interval.estimate - end) / std::sqrt(variance), 1.959964, 1e-5);
    }
  }
}

TEST(PairedScoreIntervalTest, ChangesItsSignWithTheOrder) {
  for (int first = 0; first <= 20; ++first) {
    for (int second = 0; second <= 20 - first; ++second) {
      const Interval forth = PairedScoreInterval({first, second, 20});
      const Interval back = PairedScoreInterval({second, first, 20});
      EXPECT_NEAR(forth.lower, -back.upper, 1e-9) << first << " : " << second;
      EXPECT_LE(forth.lower, forth.estimate);
      EXPECT_GE(forth.upper, forth.estimate);
    }
  }
}

/// Probability of these counts among 20 pairs.
double Multinomial(const PairedCounts& counts, double first, double second) {
  const int rest = counts.num_pairs - counts.only_first - counts.only_second;
  const double ways = std::lgamma(counts.num_pairs + 1.0) - std::lgamma(counts.only_first + 1.0) -
                      std::lgamma(counts.only_second + 1.0) - std::lgamma(rest + 1.0);
  return std::exp(ways) * std::pow(first, counts.only_first) *
         std::pow(second, counts.only_second) * std::pow(std::max(0.0, 1.0 - first - second), rest);
}

// Counted out over all outcomes of 20 pairs for truths on a grid.
TEST(PairedScoreIntervalTest, CoversTheTruthOfTwentyPairsAsOftenAsItSays) {
  std::vector<std::pair<PairedCounts, Interval>> outcomes;
  for (int first = 0; first <= 20; ++first) {
    for (int second = 0; second <= 20 - first; ++second) {
      const PairedCounts counts{first, second, 20};
      outcomes.emplace_back(counts, PairedScoreInterval(counts));
    }
  }
  std::vector<double> coverages;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20 - i; ++j) {
      const double first = i / 20.0, second = j / 20.0;
      double coverage = 0.0;
      for (const auto& [counts, interval] : outcomes) {
        const bool covers =
            interval.lower <= first - second + 1e-9 && interval.upper >= first - second - 1e-9;
        if (covers) coverage += Multinomial(counts, first, second);
      }
      coverages.push_back(coverage);
      EXPECT_GE(coverage, 0.92) << first << ", " << second;
    }
  }
  EXPECT_GE(Mean(coverages), 0.95);
}

TEST(PairedScoreIntervalTest, MoreDiscordantPairsThanPairsAreRefused) {
  EXPECT_THROW(PairedScoreInterval({2, 2, 3}), std::logic_error);
}

TEST(SignFlipPValueTest, WorkedByHand) {
  // Of the 8 signs of 1, 2, 3 only all plus and all minus are as far as 6; 0 says nothing.
  EXPECT_DOUBLE_EQ(SignFlipPValue({1.0, 0.0, 2.0, 3.0}, base::Rng(1)), 0.25);
  // Sums of -1, 2, 3: 4 or farther are 6, 4, -4, -6.
  EXPECT_DOUBLE_EQ(SignFlipPValue({-1.0, 2.0, 3.0}, base::Rng(1)), 0.5);
  EXPECT_EQ(SignFlipPValue({}, base::Rng(1)), 1.0);
  EXPECT_EQ(SignFlipPValue({0.0, 0.0}, base::Rng(1)), 1.0);
}

TEST(SignFlipPValueTest, DrawnSignsOfEqualSizesGiveTheSignTest) {
  // 14 of 20 of one sign: binomial, doubled tail, 0.1153.
  std::vector<double> differences(14, 1.0);
  differences.resize(20, -1.0);
  const double exact = McNemarPValue({14, 6, 20});
  EXPECT_NEAR(exact, 0.11532, 1e-5);
  // Four deviations of a share of 20,000 draws.
  EXPECT_NEAR(SignFlipPValue(differences, base::Rng(1)), exact,
              4.0 * std::sqrt(0.1153 * 0.8847 / 2e4));
}

}  // namespace
}  // namespace hires::lab::statistics_test
