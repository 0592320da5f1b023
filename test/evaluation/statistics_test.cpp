#include "hires/evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hires::evaluation {
namespace {

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

}  // namespace
}  // namespace hires::evaluation
