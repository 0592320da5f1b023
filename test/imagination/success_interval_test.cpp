#include "hires/imagination/success_interval.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/rng.h"

namespace hires::imagination::success_interval_test {
namespace {

constexpr IntervalKind kFixed = IntervalKind::kClopperPearson;
constexpr IntervalKind kSequence = IntervalKind::kConfidenceSequence;

/// Probability of exactly k successes of n.
double Binomial(int k, int n, double p) {
  double log = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
  if (k > 0) log += k * std::log(p);
  if (k < n) log += (n - k) * std::log1p(-p);
  return std::exp(log);
}

double AtLeast(int k, int n, double p) {
  double sum = 0.0;
  for (int i = k; i <= n; ++i) sum += Binomial(i, n, p);
  return sum;
}

TEST(EstimateSuccessTest, EightOfTenGivesTheTabulatedClopperPearsonInterval) {
  const SuccessInterval success = EstimateSuccess(8, 10, kFixed);
  EXPECT_NEAR(success.lower, 0.4439, 1e-4);
  EXPECT_NEAR(success.upper, 0.9748, 1e-4);
  EXPECT_DOUBLE_EQ(success.share, 0.8);
  EXPECT_EQ(success.num_rollouts, 10);
  EXPECT_EQ(success.kind, kFixed);
}

TEST(EstimateSuccessTest, ClopperPearsonEndsAreRootsWhereNoneOrAllSucceed) {
  EXPECT_NEAR(EstimateSuccess(64, 64, kFixed).lower, std::pow(0.025, 1.0 / 64.0), 1e-12);
  EXPECT_EQ(EstimateSuccess(64, 64, kFixed).upper, 1.0);
  EXPECT_NEAR(EstimateSuccess(0, 10, kFixed).upper, 1.0 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(EstimateSuccess(0, 10, kFixed).lower, 0.0);
}

TEST(EstimateSuccessTest, ClopperPearsonLeavesHalfOfFivePercentOnEachSide) {  // two roads
  for (const auto& [k, n] : {std::pair{1, 64}, {63, 64}, {30, 64}, {1, 400}, {350, 400}}) {
    const SuccessInterval success = EstimateSuccess(k, n, kFixed);
    EXPECT_NEAR(AtLeast(k, n, success.lower), 0.025, 1e-9) << k << " of " << n;
    EXPECT_NEAR(1.0 - AtLeast(k + 1, n, success.upper), 0.025, 1e-9) << k << " of " << n;
  }
}

TEST(EstimateSuccessTest, SequenceIsWorkedByHandWhereAllSucceed) {
  // The mixture gives n successes of n the probability C(2n, n) / 4^n: 1/2, 3/8, 35/128, 429/2048
  // for n = 1, 2, 4, 7; p is out where p^n is less than a twentieth of that.
  EXPECT_NEAR(EstimateSuccess(1, 1, kSequence).lower, 1.0 / 40.0, 1e-9);
  EXPECT_NEAR(EstimateSuccess(2, 2, kSequence).lower, std::sqrt(3.0 / 160.0), 1e-9);
  EXPECT_NEAR(EstimateSuccess(4, 4, kSequence).lower, std::pow(35.0 / 2560.0, 0.25), 1e-9);
  EXPECT_NEAR(EstimateSuccess(7, 7, kSequence).lower, std::pow(429.0 / 40960.0, 1.0 / 7.0), 1e-9);
  EXPECT_EQ(EstimateSuccess(4, 4, kSequence).upper, 1.0);
}

TEST(EstimateSuccessTest, SequenceIsWorkedByHandForOneOfTwo) {
  // The mixture gives one success and one failure in this order 1/8: p (1 - p) = 1/160 at the ends.
  const double half_width = std::sqrt(0.25 - 1.0 / 160.0);
  const SuccessInterval success = EstimateSuccess(1, 2, kSequence);
  EXPECT_NEAR(success.lower, 0.5 - half_width, 1e-9);
  EXPECT_NEAR(success.upper, 0.5 + half_width, 1e-9);
  EXPECT_EQ(success.kind, kSequence);
}

TEST(EstimateSuccessTest, NoRolloutSaysNothing) {
  for (const IntervalKind kind : {kFixed, kSequence}) {
    const SuccessInterval success = EstimateSuccess(0, 0, kind);
    EXPECT_EQ(success.lower, 0.0);
    EXPECT_EQ(success.upper, 1.0);
    EXPECT_EQ(success.num_rollouts, 0);
    EXPECT_EQ(success.kind, kind);
  }
}

TEST(EstimateSuccessTest, IntervalHoldsTheShareMirrorsWithFailuresAndGrowsWithSuccesses) {
  for (const IntervalKind kind : {kFixed, kSequence}) {
    for (int n = 1; n <= 200; n += 7) {
      double lower = -1.0, upper = -1.0;
      for (int k = 0; k <= n; ++k) {
        const SuccessInterval success = EstimateSuccess(k, n, kind);
        EXPECT_LE(0.0, success.lower);
        EXPECT_LE(success.lower, success.share);
        EXPECT_LE(success.share, success.upper);
        EXPECT_LE(success.upper, 1.0);
        EXPECT_NEAR(success.lower, 1.0 - EstimateSuccess(n - k, n, kind).upper, 1e-9)
            << k << " of " << n;
        EXPECT_GT(success.lower + success.upper, lower + upper) << k << " of " << n;
        EXPECT_GE(success.lower, lower);
        EXPECT_GE(success.upper, upper);
        lower = success.lower;
        upper = success.upper;
      }
    }
  }
}

TEST(EstimateSuccessTest, MoreFlawlessRolloutsRaiseTheLowerEnd) {
  for (const IntervalKind kind : {kFixed, kSequence}) {
    for (int n = 1; n <= 65536; n *= 2) {
      EXPECT_GT(EstimateSuccess(2 * n, 2 * n, kind).lower, EstimateSuccess(n, n, kind).lower)
          << "n = " << n;
    }
  }
}

TEST(EstimateSuccessTest, TheLibertyToStopAtAnyTimeCostsWidth) {
  for (int n = 1; n <= 400; n += 19) {
    for (int k = 0; k <= n; ++k) {
      const SuccessInterval fixed = EstimateSuccess(k, n, kFixed);
      const SuccessInterval sequence = EstimateSuccess(k, n, kSequence);
      EXPECT_GE(sequence.upper - sequence.lower, fixed.upper - fixed.lower) << k << " of " << n;
    }
  }
}

/// Probability that the interval of n rollouts holds p, summed over all outcomes.
double Coverage(int n, double p, IntervalKind kind) {
  double covered = 0.0;
  for (int k = 0; k <= n; ++k) {
    const SuccessInterval success = EstimateSuccess(k, n, kind);
    if (success.lower <= p && p <= success.upper) covered += Binomial(k, n, p);
  }
  return covered;
}

TEST(EstimateSuccessTest, AtAFixedNumberBothKindsCoverEveryShare) {  // exactly, no simulation
  for (const int n : {1, 4, 16, 64, 128}) {
    for (double p = 0.01; p < 1.0; p += 0.01) {
      EXPECT_GE(Coverage(n, p, kFixed), 0.95 - 1e-12) << "n " << n << ", p " << p;
      EXPECT_GE(Coverage(n, p, kSequence), 0.95 - 1e-12) << "n " << n << ", p " << p;
    }
  }
}

/// In how many of `repetitions` an interval missed p at some n up to 256.
int NumMissesAtAnyTime(double p, IntervalKind kind, int repetitions) {
  int misses = 0;
  for (int i = 0; i < repetitions; ++i) {
    base::Rng rng = base::Rng(91).Fork(i);
    int successes = 0;
    bool is_missed = false;
    for (int n = 1; n <= 256 && !is_missed; ++n) {
      successes += rng.Bernoulli(p);
      const SuccessInterval success = EstimateSuccess(successes, n, kind);
      is_missed = p < success.lower || p > success.upper;
    }
    misses += is_missed;
  }
  return misses;
}

TEST(EstimateSuccessTest, SequenceMissesAtMostFivePercentOverAllNumbersTogether) {
  for (const double p : {0.5, 0.9, 0.99}) {
    EXPECT_LE(NumMissesAtAnyTime(p, kSequence, 200), 10) << p;
  }
  // What the test is for: an interval for one look misses far more often when looked at always.
  EXPECT_GT(NumMissesAtAnyTime(0.5, kFixed, 200), 20);
}

TEST(EstimateSuccessTest, ImpossibleCountsAreRefused) {
  EXPECT_THROW(EstimateSuccess(-1, 3, kFixed), std::logic_error);
  EXPECT_THROW(EstimateSuccess(4, 3, kSequence), std::logic_error);
}

TEST(JudgeTest, TheLowerEndMustReachWhatIsWanted) {
  EXPECT_EQ(Judge({0.8, 0.5, 0.9, 10}, 0.5), Suitability::kReached);
  EXPECT_EQ(Judge({0.8, 0.49, 0.9, 10}, 0.5), Suitability::kOpen);
  EXPECT_EQ(Judge({0.3, 0.1, 0.5, 10}, 0.5), Suitability::kOpen);
  EXPECT_EQ(Judge({0.3, 0.1, 0.49, 10}, 0.5), Suitability::kNotReached);
  EXPECT_EQ(Judge({}, 0.5), Suitability::kOpen);
}

TEST(JudgeTest, FourGoodRolloutsAloneProveNothing) {
  EXPECT_EQ(Judge(EstimateSuccess(4, 4, kSequence), 0.5), Suitability::kOpen);
  EXPECT_EQ(Judge(EstimateSuccess(4, 4, kFixed), 0.5), Suitability::kOpen);
}

TEST(JudgeTest, OneOfFourHundredIsNotGoodEnough) {
  EXPECT_EQ(Judge(EstimateSuccess(1, 400, kFixed), 0.5), Suitability::kNotReached);
  EXPECT_EQ(Judge(EstimateSuccess(1, 400, kSequence), 0.5), Suitability::kNotReached);
}

TEST(RolloutsToDecideTest, SevenFlawlessOnesReachAHalf) {
  // 6 of 6: (231 / 1024 / 20)^(1/6) = 0.473; 7 of 7: 0.521.
  EXPECT_EQ(RolloutsToDecide(EstimateSuccess(4, 4, kSequence), 0.5, 1000), 7);
  // 5 of 5: 0.025^(1/5) = 0.478; 6 of 6: 0.541.
  EXPECT_EQ(RolloutsToDecide(EstimateSuccess(4, 4, kFixed), 0.5, 1000), 6);
}

TEST(RolloutsToDecideTest, WhatItNamesDecidesAndOneLessDoesNot) {
  for (const auto& [k, n] : {std::pair{3, 4}, {20, 32}, {12, 32}, {0, 2}, {36, 64}}) {
    const SuccessInterval now = EstimateSuccess(k, n, kSequence);
    const auto needed = RolloutsToDecide(now, 0.5, 100000);
    ASSERT_TRUE(needed.has_value());
    const auto at = [&](int num) {
      return EstimateSuccess(static_cast<int>(std::lround(now.share * num)), num, kSequence);
    };
    EXPECT_GT(*needed, n);
    EXPECT_NE(Judge(at(*needed), 0.5), Suitability::kOpen);
    EXPECT_EQ(Judge(at(*needed - 1), 0.5), Suitability::kOpen);
  }
}

TEST(RolloutsToDecideTest, NobodyDecidesOnTheEdge) {
  EXPECT_EQ(RolloutsToDecide(EstimateSuccess(32, 64, kSequence), 0.5, 100000), std::nullopt);
}

TEST(RolloutsToDecideTest, ImpossibleQuestionsAreRefused) {
  EXPECT_THROW(RolloutsToDecide({}, 0.5, 100), std::logic_error);
  EXPECT_THROW(RolloutsToDecide(EstimateSuccess(1, 2, kFixed), 1.0, 100), std::logic_error);
}

}  // namespace
}  // namespace hires::imagination::success_interval_test
