#include "hires/base/rng.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <vector>

namespace hires::base::rng_test {
namespace {

using ::testing::ElementsAre;

template <typename Draw>
auto Draws(int count, Draw draw) {
  std::vector<decltype(draw())> drawn;
  for (int i = 0; i < count; ++i) drawn.push_back(draw());
  return drawn;
}

// Golden values of seed 7. If one changes, every result that somebody wrote down with its seed can
// no longer be repeated: change the stream only on purpose. The uniform numbers and the forked
// seeds were computed a second time from the published definitions of SplitMix64 and MT19937-64.
TEST(RngTest, TheUniformStreamOfSeedSevenStays) {
  Rng rng(7);
  EXPECT_THAT(Draws(4, [&] { return rng.Uniform(0.0, 1.0); }),
              ElementsAre(0.8421548048141535, 0.6790880946501584, 0.16723922861961335,
                          0.83138506921419608));
}

TEST(RngTest, TheNormalStreamOfSeedSevenStays) {
  Rng rng(7);
  EXPECT_THAT(Draws(4, [&] { return rng.Normal(0.0, 1.0); }),
              ElementsAre(1.1210831710110098, -0.82019699851790462, 0.32080787128972288,
                          -0.51908241563829471));
}

TEST(RngTest, TheIndicesOfSeedSevenStay) {
  Rng rng(7);
  EXPECT_THAT(Draws(12, [&] { return rng.Index(10); }),
              ElementsAre(8, 6, 1, 8, 2, 4, 6, 8, 5, 1, 4, 6));
}

TEST(RngTest, TheCoinsOfSeedSevenStay) {
  Rng rng(7);
  EXPECT_THAT(Draws(8, [&] { return rng.Bernoulli(0.5); }),
              ElementsAre(false, false, true, false, true, true, false, false));
}

TEST(RngTest, TheForksOfSeedSevenStay) {
  const Rng rng(7);
  EXPECT_EQ(rng.Fork(0).seed(), 8581286081765471666ULL);
  EXPECT_EQ(rng.Fork(1).seed(), 1988111358474182198ULL);
  EXPECT_EQ(rng.Fork(2).seed(), 16753576447339095367ULL);
  EXPECT_EQ(rng.Fork(0).Uniform(0.0, 1.0), 0.33868039383157672);
}

TEST(RngTest, AForkDoesNotDependOnWhatWasDrawnBefore) {
  Rng used(11);
  const Rng fresh(11);
  for (int i = 0; i < 100; ++i) used.Normal(0.0, 1.0);
  EXPECT_EQ(used.Fork(3).Uniform(0.0, 1.0), fresh.Fork(3).Uniform(0.0, 1.0));
}

TEST(RngTest, ForkingLeavesTheStreamAlone) {
  Rng forked(11), untouched(11);
  forked.Fork(1).Uniform(0.0, 1.0);
  EXPECT_EQ(forked.Uniform(0.0, 1.0), untouched.Uniform(0.0, 1.0));
}

// 500 draws: the generator makes 312 numbers at a time.
TEST(RngTest, ACopyGoesOnWithTheSameNumbersByItself) {
  for (const int drawn : {0, 1, 311, 312, 500}) {
    Rng rng(11), assigned(12);
    for (int i = 0; i < drawn; ++i) rng.Uniform(0.0, 1.0);
    Rng copy(rng);
    assigned = rng;
    const auto wanted = Draws(500, [&] { return rng.Uniform(0.0, 1.0); });
    EXPECT_EQ(Draws(500, [&] { return copy.Uniform(0.0, 1.0); }), wanted) << drawn;
    EXPECT_EQ(Draws(500, [&] { return assigned.Uniform(0.0, 1.0); }), wanted) << drawn;
    EXPECT_EQ(copy.seed(), 11u);
  }
}

TEST(RngTest, ForksOfForksAndOfNeighboursAreAllDifferent) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Rng rng(seed);
    seeds.insert(seed);
    for (std::uint64_t id = 0; id < 100; ++id) {
      seeds.insert(rng.Fork(id).seed());
      seeds.insert(rng.Fork(id).Fork(0).seed());
    }
  }
  EXPECT_EQ(seeds.size(), 10u * (1 + 2 * 100));
}

TEST(RngTest, TheSeedIsKept) { EXPECT_EQ(Rng(42).seed(), 42u); }

TEST(RngTest, UniformNumbersStayInTheirHalfOpenInterval) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Rng rng = Rng(1).Fork(seed);
    for (int i = 0; i < 100; ++i) {
      const double x = rng.Uniform(-0.25, 0.5);
      EXPECT_GE(x, -0.25);
      EXPECT_LT(x, 0.5);
    }
  }
}

// The bounds below are five standard errors of the statistic, for one fixed seed.
TEST(RngTest, UniformNumbersHaveTheirMeanAndSpread) {
  Rng rng(5);
  constexpr int kCount = 100000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.Uniform(2.0, 6.0);
    sum += x;
    squares += (x - 4.0) * (x - 4.0);
  }
  EXPECT_NEAR(sum / kCount, 4.0, 5.0 * std::sqrt(16.0 / 12.0 / kCount));
  EXPECT_NEAR(squares / kCount, 16.0 / 12.0, 5.0 * std::sqrt(256.0 / 180.0 / kCount));
}

TEST(RngTest, NormalNumbersHaveTheirMeanAndSpread) {
  Rng rng(5);
  constexpr int kCount = 100000;
  int within_one_sd = 0;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double z = (rng.Normal(3.0, 0.5) - 3.0) / 0.5;
    sum += z;
    squares += z * z;
    within_one_sd += std::abs(z) < 1.0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(within_one_sd / double{kCount}, 0.6827, 5.0 * std::sqrt(0.6827 * 0.3173 / kCount));
}

TEST(RngTest, EveryIndexComesEquallyOften) {
  Rng rng(5);
  constexpr int kCount = 70000, kSize = 7;
  std::vector<int> times(kSize, 0);
  for (int i = 0; i < kCount; ++i) ++times.at(rng.Index(kSize));
  for (const int n : times) EXPECT_NEAR(n, 10000.0, 5.0 * std::sqrt(10000.0 * 6 / 7));
}

TEST(RngTest, CoinsFallAsOftenAsTold) {
  Rng rng(5);
  constexpr int kCount = 100000;
  int heads = 0;
  for (int i = 0; i < kCount; ++i) heads += rng.Bernoulli(0.2);
  EXPECT_NEAR(heads / double{kCount}, 0.2, 5.0 * std::sqrt(0.2 * 0.8 / kCount));
}

TEST(RngTest, EdgesLeaveNothingToChance) {
  Rng rng(5);
  EXPECT_EQ(rng.Uniform(2.0, 2.0), 2.0);
  EXPECT_EQ(rng.Normal(2.0, 0.0), 2.0);
  EXPECT_EQ(rng.Index(1), 0);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(rng.Bernoulli(0.0));
    EXPECT_TRUE(rng.Bernoulli(1.0));
  }
}

TEST(RngTest, BrokenPreconditionsAreTheCallersFault) {
  Rng rng(5);
  EXPECT_THROW(rng.Uniform(1.0, 0.0), std::logic_error);
  EXPECT_THROW(rng.Uniform(NAN, 1.0), std::logic_error);
  EXPECT_THROW(rng.Normal(0.0, -1.0), std::logic_error);
  EXPECT_THROW(rng.Normal(0.0, NAN), std::logic_error);
  EXPECT_THROW(rng.Bernoulli(-0.1), std::logic_error);
  EXPECT_THROW(rng.Bernoulli(1.1), std::logic_error);
  EXPECT_THROW(rng.Bernoulli(NAN), std::logic_error);
  EXPECT_THROW(rng.Index(0), std::logic_error);
}

}  // namespace
}  // namespace hires::base::rng_test
