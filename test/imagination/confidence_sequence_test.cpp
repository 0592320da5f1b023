#include "imagination/answer/confidence_sequence.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/rng.h"

namespace hires::imagination::confidence_sequence_test {
namespace {

using Draw = std::function<double(base::Rng*)>;

/// -1, 0 or 1: what two alternatives with success in {0, 1} differ by.
Draw SuccessDifference(double better, double worse) {
  return [=](base::Rng* rng) {
    const double luck = rng->Uniform(0.0, 1.0);
    return luck < better ? 1.0 : (luck < better + worse ? -1.0 : 0.0);
  };
}

/// In how many of `num_sequences` the mean was ruled out at one of the looks 16, 32, ..., 512.
int NumMisses(const Draw& draw, double mean, int num_sequences, double alpha) {
  int misses = 0;
  for (int i = 0; i < num_sequences; ++i) {
    base::Rng rng = base::Rng(2024).Fork(i);
    MeanSequence sequence(-1.0, 1.0, alpha);
    bool missed = false;
    for (int n = 1; n <= 512; ++n) {
      sequence.Add(draw(&rng));
      const bool is_look = n >= 16 && (n & (n - 1)) == 0;
      if (is_look) missed = missed || sequence.Above(mean) || sequence.Below(mean);
    }
    misses += missed;
  }
  return misses;
}

TEST(MeanSequenceTest, MissesAtMostFivePercentOverAllLooks) {
  constexpr int kSequences = 10000;
  const std::vector<std::pair<double, double>> better_and_worse{
      {0.5, 0.5}, {0.1, 0.1}, {0.02, 0.0}, {0.9, 0.05}};
  for (const auto& [better, worse] : better_and_worse) {
    const int misses =
        NumMisses(SuccessDifference(better, worse), better - worse, kSequences, 0.05);
    RecordProperty("misses_at_" + std::to_string(better), misses);
    EXPECT_LE(misses, kSequences / 20) << better << " better, " << worse << " worse";
  }
}

TEST(MeanSequenceTest, MissesAtMostFivePercentForSkewedDifferencesOfConfidences) {
  const Draw draw = [](base::Rng* rng) {  // mean 0: rarely much worse, mostly a little better
    return rng->Bernoulli(0.1) ? -0.9 : rng->Uniform(0.0, 0.2);
  };
  EXPECT_LE(NumMisses(draw, 0.0, 10000, 0.05), 500);
}

TEST(MeanSequenceTest, KnowsNothingBeforeTheFirstValue) {
  const MeanSequence sequence(-1.0, 1.0, 0.05);
  EXPECT_NEAR(sequence.Bounds().lower, -1.0, 1e-8);
  EXPECT_NEAR(sequence.Bounds().upper, 1.0, 1e-8);
  EXPECT_FALSE(sequence.Above(-1.0));
  EXPECT_FALSE(sequence.Below(1.0));
}

TEST(MeanSequenceTest, FirstBetIsWorkedByHand) {
  // One success: the wealth on "higher than m" is 1 + min(stake, 0.9 / m) (1 - m). The stake is
  // sqrt(2 ln(40) / (0.25 ln 2)) = 6.525 and the threshold 40 is reached at m with 0.9 / m > stake,
  // were it not that 1 + 6.525 < 40: so nothing is ruled out.
  MeanSequence one(0.0, 1.0, 0.05);
  one.Add(1.0);
  EXPECT_FALSE(one.Above(0.0));
  // With alpha 0.9 the stake is sqrt(2 ln(2.2222) / (0.25 ln 2)) = 3.0357, the wealth
  // reaches 2.2222 where 1 + 0.9 / m (1 - m) = 2.2222, m = 0.9 / 2.1222 = 0.42408.
  MeanSequence bold(0.0, 1.0, 0.9);
  bold.Add(1.0);
  EXPECT_NEAR(bold.Bounds().lower, 0.9 / (2.0 / 0.9 - 0.1), 1e-8);
  EXPECT_NEAR(bold.Bounds().upper, 1.0, 1e-8);
}

TEST(MeanSequenceTest, BoundsAgreeWithWhatIsAboveAndBelow) {
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    MeanSequence sequence(-1.0, 1.0, 0.05);
    const int n = 20 + rng.Index(200);
    for (int i = 0; i < n; ++i) sequence.Add(rng.Uniform(-0.2, 1.0));
    const Interval bounds = sequence.Bounds();
    ASSERT_LT(bounds.lower, bounds.upper);
    EXPECT_TRUE(sequence.Above(bounds.lower - 1e-7));
    EXPECT_FALSE(sequence.Above(bounds.lower + 1e-7));
    EXPECT_TRUE(sequence.Below(bounds.upper + 1e-7));
    EXPECT_FALSE(sequence.Below(bounds.upper - 1e-7));
  }
}

TEST(MeanSequenceTest, MirroredValuesMirrorTheInterval) {
  base::Rng rng(6);
  MeanSequence sequence(-1.0, 1.0, 0.05);
  MeanSequence mirrored(-1.0, 1.0, 0.05);
  for (int i = 0; i < 100; ++i) {
    const double value = rng.Uniform(-0.5, 1.0);
    sequence.Add(value);
    mirrored.Add(-value);
  }
  EXPECT_NEAR(sequence.Bounds().lower, -mirrored.Bounds().upper, 1e-8);
  EXPECT_NEAR(sequence.Bounds().upper, -mirrored.Bounds().lower, 1e-8);
}

TEST(MeanSequenceTest, IntervalNarrowsAroundTheMean) {
  base::Rng rng(7);
  MeanSequence sequence(-1.0, 1.0, 0.05);
  for (int i = 0; i < 5000; ++i) sequence.Add(rng.Uniform(0.2, 0.4));
  const Interval bounds = sequence.Bounds();
  EXPECT_GT(bounds.lower, 0.28);
  EXPECT_LT(bounds.upper, 0.32);
}

TEST(MeanSequenceTest, AllEqualIsKnownWithinFivePercentAfterOneHundred) {
  MeanSequence sequence(-1.0, 1.0, 0.05);
  for (int i = 0; i < 100; ++i) sequence.Add(0.0);
  EXPECT_TRUE(sequence.Above(-0.05));
  EXPECT_TRUE(sequence.Below(0.05));
}

TEST(MeanSequenceTest, ImpossibleInputIsRefused) {
  EXPECT_THROW(MeanSequence(1.0, 1.0, 0.05), std::logic_error);
  EXPECT_THROW(MeanSequence(0.0, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(MeanSequence(0.0, 1.0, 1.0), std::logic_error);
  EXPECT_THROW(MeanSequence(0.0, std::numeric_limits<double>::infinity(), 0.05), std::logic_error);
  MeanSequence sequence(0.0, 1.0, 0.05);
  EXPECT_THROW(sequence.Add(1.1), std::logic_error);
  EXPECT_THROW(sequence.Add(std::nan("")), std::logic_error);
  EXPECT_THROW(sequence.Above(2.0), std::logic_error);
  EXPECT_THROW(sequence.Below(-0.1), std::logic_error);
  EXPECT_EQ(sequence.num_values(), 0);
}

}  // namespace
}  // namespace hires::imagination::confidence_sequence_test
