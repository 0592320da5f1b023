#include "hires/imagination/ranking.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "imagination/rollout_examples.h"

namespace hires::imagination {
namespace {

using test_support::Behaviour;
using test_support::Fall;
using test_support::InventAll;
using test_support::NoPath;
using test_support::Success;
using test_support::Times;
using test_support::operator+;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Results = std::vector<RolloutResult>;

std::vector<Evidence> SumUpAll(const std::vector<Results>& alternatives) {
  std::vector<Evidence> evidence;
  for (const Results& results : alternatives) evidence.push_back(SumUp(results));
  return evidence;
}

const std::vector<std::string> kNames{"fast", "slow"};

TEST(ParseRankingRuleTest, KnowsBothNamesInAnyCase) {
  EXPECT_EQ(ParseRankingRule("risk"), RankingRule::kRisk);
  EXPECT_EQ(ParseRankingRule("Thesis"), RankingRule::kThesis);
  EXPECT_EQ(ToString(RankingRule::kRisk), "risk");
  EXPECT_EQ(ToString(RankingRule::kThesis), "thesis");
}

TEST(ParseRankingRuleTest, NamesWhatIsUnknown) {
  try {
    ParseRankingRule("tesis");
    FAIL() << "an unknown rule was accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'tesis'"));
    EXPECT_THAT(error.what(), HasSubstr("thesis"));
  }
}

// ---------------------------------------------------------------- order

TEST(RankTest, RulesDisagreeOnOneFallAgainstTwelveWobbles) {  // the case DESIGN is careful about
  const auto evidence = SumUpAll({{Fall(32.0, 1)}, {Success(45.0, 12)}});
  EXPECT_THAT(Rank(evidence, RankingRule::kRisk), ElementsAre(1, 0));
  EXPECT_THAT(Rank(evidence, RankingRule::kThesis), ElementsAre(0, 1));
}

TEST(RankTest, OriginalExperimentRecommendsSlow) {  // one rollout each, dissertation 6.3.3
  const auto evidence = SumUpAll({{Success(32.01, 12)}, {Success(45.27, 0)}});
  EXPECT_EQ(Recommended(evidence, RankingRule::kThesis), 1);
  EXPECT_EQ(Recommended(evidence, RankingRule::kRisk), 1);
}

TEST(RankTest, ConfidenceDecidesWhereSuccessIsEqual) {
  const auto evidence = SumUpAll({Times(8, Success(20.0, 5)), Times(8, Success(30.0, 1))});
  EXPECT_THAT(Rank(evidence, RankingRule::kRisk), ElementsAre(1, 0));
}

TEST(RankTest, DurationDecidesWhereTheRestIsEqual) {
  const auto evidence = SumUpAll({Times(8, Success(30.0)), Times(8, Success(20.0))});
  EXPECT_THAT(Rank(evidence, RankingRule::kRisk), ElementsAre(1, 0));
  EXPECT_THAT(Rank(evidence, RankingRule::kThesis), ElementsAre(1, 0));
}

TEST(RankTest, EqualsKeepTheirOrder) {
  const auto evidence = SumUpAll(std::vector<Results>(5, Times(3, Success())));
  EXPECT_THAT(Rank(evidence, RankingRule::kRisk), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(Rank(evidence, RankingRule::kThesis), ElementsAre(0, 1, 2, 3, 4));
}

TEST(RankTest, FallsOnlyLowerTheConfidenceUnderThesis) {
  const auto evidence = SumUpAll({Times(10, NoPath()), Times(10, Fall())});
  EXPECT_THAT(Rank(evidence, RankingRule::kThesis), ElementsAre(1, 0));
  EXPECT_EQ(Recommended(evidence, RankingRule::kThesis), 1);
  EXPECT_EQ(Recommended(evidence, RankingRule::kRisk), std::nullopt);
}

TEST(RankTest, HalfFailedIsNotOutUnderThesis) {
  const auto half = SumUpAll({Times(5, NoPath()) + Times(5, Success())});
  EXPECT_EQ(Recommended(half, RankingRule::kThesis), 0);
  const auto most = SumUpAll({Times(6, NoPath()) + Times(4, Success())});
  EXPECT_EQ(Recommended(most, RankingRule::kThesis), std::nullopt);
}

TEST(RankTest, WhoNeverFinishedIsSlowerThanWhoDid) {
  // Every rollout of both fails; with the same confidence only the duration is left.
  auto finished = SumUp({Fall(50.0)});
  finished.confidence_mean = 0.0;
  EXPECT_THAT(Rank({SumUp({NoPath()}), finished}, RankingRule::kRisk), ElementsAre(1, 0));
}

TEST(RankTest, NothingAndNoRolloutRecommendNothing) {
  EXPECT_THAT(Rank({}, RankingRule::kRisk), IsEmpty());
  EXPECT_EQ(Recommended({}, RankingRule::kRisk), std::nullopt);
  EXPECT_EQ(Recommended({Evidence{}, Evidence{}}, RankingRule::kThesis), std::nullopt);
}

TEST(RankTest, DifferentNumbersOfRolloutsAreRefused) {
  const auto evidence = SumUpAll({Times(8, Success()), Times(9, Success())});
  EXPECT_THROW(Rank(evidence, RankingRule::kRisk), std::logic_error);
  EXPECT_THROW(WhyRecommended(evidence, RankingRule::kRisk, kNames), std::logic_error);
}

TEST(RankTest, OrderOfTheRequestDoesNotMatterWhereNothingIsEqual) {
  for (int seed = 0; seed < 100; ++seed) {
    const base::Rng rng = base::Rng(3).Fork(seed);
    std::vector<Evidence> evidence;
    for (int a = 0; a < 6; ++a) {
      evidence.push_back(SumUp(InventAll({0.1 * a, 0.1, 20.0 + a, 30}, rng.Fork(a), 20)));
    }
    const std::vector<Evidence> reversed(evidence.rbegin(), evidence.rend());
    for (const RankingRule rule : {RankingRule::kRisk, RankingRule::kThesis}) {
      std::vector<int> expected;
      for (const int i : Rank(evidence, rule)) expected.push_back(5 - i);
      EXPECT_EQ(Rank(reversed, rule), expected);
    }
  }
}

// ---------------------------------------------------------------- words

TEST(WhyRecommendedTest, SuccessDecides) {
  const auto evidence = SumUpAll(
      {Times(55, Success()) + Times(7, Fall()) + Times(2, NoPath()), Times(64, Success())});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kRisk, kNames),
            "slow: 64 of 64 rollouts succeeded (at least 94 %), fast failed in 9 of 64 "
            "(object_fell 7, no_path 2)");
}

TEST(WhyRecommendedTest, ConfidenceDecides) {
  const auto evidence = SumUpAll({Times(16, Success(30.0, 12)), Times(16, Success(45.0))});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kRisk, kNames),
            "slow: 16 of 16 rollouts succeeded (at least 80 %) as with fast, and its confidence is "
            "higher, 1.000 against 0.856");
}

TEST(WhyRecommendedTest, DurationDecides) {
  const auto evidence = SumUpAll({Times(16, Success(18.0)), Times(16, Success(27.5))});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kRisk, kNames),
            "fast: 16 of 16 rollouts succeeded (at least 80 %) as with slow and with the same "
            "confidence 1.000, but quicker, 18.000 s against 27.500 s");
}

TEST(WhyRecommendedTest, NothingDecides) {
  const auto evidence = SumUpAll({{Success()}, {Success()}});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kRisk, kNames),
            "fast: 1 of 1 rollout succeeded (at least 20 %) as with slow, and in nothing worse; it "
            "was named first");
}

TEST(WhyRecommendedTest, NumbersThatDifferAreShownDifferent) {
  auto evidence = SumUpAll({{Success()}, {Success()}});
  evidence[0].confidence_mean = 0.99991;
  EXPECT_THAT(WhyRecommended(evidence, RankingRule::kRisk, kNames),
              HasSubstr("1.0000 against 0.9999"));
}

TEST(WhyRecommendedTest, ThesisSpeaksOfTheAction) {
  const auto evidence = SumUpAll({Times(10, NoPath()), Times(10, Fall())});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kThesis, kNames),
            "slow: its action reached its goal in 100 % of 10 rollouts, that of fast only in 0 %");
}

TEST(WhyRecommendedTest, OnlyAlternative) {
  EXPECT_EQ(WhyRecommended(SumUpAll({Times(8, Success()) + Times(2, Fall())}), RankingRule::kRisk,
                           {"slow"}),
            "slow: the only alternative; 8 of 10 rollouts succeeded (at least 49 %)");
}

TEST(WhyRecommendedTest, NothingIsRecommended) {
  const auto evidence = SumUpAll({Times(4, NoPath()), Times(3, Fall()) + Times(1, NoPath())});
  EXPECT_EQ(WhyRecommended(evidence, RankingRule::kRisk, kNames),
            "nothing is recommended, all alternatives fail: fast failed in 4 of 4 (no_path 4); "
            "slow failed in 4 of 4 (object_fell 3, no_path 1)");
  EXPECT_EQ(WhyRecommended({Evidence{}, Evidence{}}, RankingRule::kRisk, kNames),
            "nothing is recommended: no rollout of every alternative has finished");
  EXPECT_EQ(WhyRecommended({}, RankingRule::kRisk, {}),
            "nothing is recommended: there is no alternative");
}

TEST(WhyRecommendedTest, EachAlternativeNeedsAName) {
  EXPECT_THROW(WhyRecommended(SumUpAll({{Success()}}), RankingRule::kRisk, kNames),
               std::logic_error);
}

// ---------------------------------------------------------------- settled

bool IsSettled(const std::vector<Results>& results, RankingRule rule = RankingRule::kRisk) {
  return Settled(results, static_cast<int>(results.front().size()), rule, {});
}

TEST(SettledTest, ClearDifferenceInSuccessSettlesAtTheFirstLook) {
  EXPECT_TRUE(IsSettled({Times(16, Fall()), Times(16, Success())}));
}

TEST(SettledTest, FewFallsSettleNothingAtTheFirstLook) {
  EXPECT_FALSE(IsSettled({Times(14, Success()) + Times(2, Fall()), Times(16, Success())}));
}

TEST(SettledTest, NineFallsOfSixtyFourSettle) {
  Results fast;
  for (int i = 0; i < 64; ++i) fast.push_back(i % 7 == 3 ? Fall() : Success());
  EXPECT_TRUE(IsSettled({fast, Times(64, Success())}));
}

TEST(SettledTest, EqualSuccessIsNotKnownToBeEqualSoon) {
  const std::vector<Results> results{Times(64, Success(20.0)), Times(64, Success(30.0))};
  EXPECT_FALSE(IsSettled(results));
}

TEST(SettledTest, DurationSettlesOnceTheRestIsWithinTheIndifference) {
  EXPECT_TRUE(IsSettled({Times(128, Success(20.0)), Times(128, Success(30.0))}));
}

TEST(SettledTest, FullTieIsSettledOnceItIsKnownToBeOne) {
  EXPECT_TRUE(IsSettled({Times(128, Success()), Times(128, Success())}));
  EXPECT_FALSE(IsSettled({Times(16, Success()), Times(16, Success())}));
}

TEST(SettledTest, OrderByChanceAgainstWhatIsKnownStaysOpen) {
  // Success is equal within the indifference, its sign favours `a` by one rollout of 1024, but `b`
  // is certainly quicker: Rank says a, the evidence for it is thin.
  const Results a = Times(1024, Success(30.0));
  const Results b = Times(500, Success(20.0)) + Times(1, Fall(20.0)) + Times(523, Success(20.0));
  EXPECT_THAT(Rank(SumUpAll({a, b}), RankingRule::kRisk), ElementsAre(0, 1));
  EXPECT_FALSE(IsSettled({a, b}));
}

TEST(SettledTest, OneAlternativeHasNoOrderToSettle) {
  EXPECT_TRUE(Settled({{Success()}}, 1, RankingRule::kRisk, {}));
}

TEST(SettledTest, ThesisSettlesOnceInAndOutAreCertain) {
  EXPECT_TRUE(IsSettled({Times(16, NoPath()), Times(16, Success())}, RankingRule::kThesis));
  EXPECT_TRUE(IsSettled({Times(16, NoPath()), Times(16, NoPath())}, RankingRule::kThesis));
  Results half;
  for (int i = 0; i < 64; ++i) half.push_back(i % 2 == 0 ? NoPath() : Success());
  EXPECT_FALSE(IsSettled({half, Times(64, Success())}, RankingRule::kThesis));
}

TEST(SettledTest, ThesisComparesConfidences) {
  EXPECT_TRUE(
      IsSettled({Times(32, Success(30.0, 60)), Times(32, Success(45.0))}, RankingRule::kThesis));
}

TEST(SettledTest, OnlyBestIgnoresTheOrderBehind) {
  const std::vector<Results> results{Times(64, Fall(20.0)), Times(64, Success()),
                                     Times(64, Fall(30.0))};
  SettleParams params;
  EXPECT_FALSE(Settled(results, 64, RankingRule::kRisk, params));
  params.only_best = true;
  EXPECT_TRUE(Settled(results, 64, RankingRule::kRisk, params));
}

TEST(SettledTest, OnlyTheFirstRolloutsCount) {
  const std::vector<Results> results{Times(16, Success()) + Times(48, Fall()),
                                     Times(64, Success())};
  EXPECT_FALSE(Settled(results, 16, RankingRule::kRisk, {}));
  EXPECT_TRUE(Settled(results, 64, RankingRule::kRisk, {}));
}

TEST(SettledTest, BrokenParametersAreRefused) {
  const std::vector<Results> results{{Success()}, {Success()}};
  EXPECT_THROW(Settled(results, 0, RankingRule::kRisk, {}), std::logic_error);
  EXPECT_THROW(Settled(results, 2, RankingRule::kRisk, {}), std::logic_error);
  EXPECT_THROW(Settled(results, 1, RankingRule::kRisk, {0.0, 0.05, false}), std::logic_error);
  EXPECT_THROW(Settled(results, 1, RankingRule::kRisk, {0.05, 1.0, false}), std::logic_error);
}

/// The look (of 16, 32, ..., 256) at which an order is settled, or 0 if it never is.
int SettlesAt(const std::vector<Behaviour>& behaviours, const base::Rng& rng, bool independent,
              int* first) {
  std::vector<Results> results;
  for (std::size_t a = 0; a < behaviours.size(); ++a) {
    results.push_back(InventAll(behaviours[a], independent ? rng.Fork(1000 + a) : rng, 256));
  }
  for (int look = 16; look <= 256; look *= 2) {
    if (!Settled(results, look, RankingRule::kRisk, {})) continue;
    std::vector<Evidence> evidence;
    for (const Results& of_one : results) evidence.push_back(SumUp(of_one, look));
    *first = Rank(evidence, RankingRule::kRisk)[0];
    return look;
  }
  return 0;
}

TEST(SettledTest, FiveInHundredSettleOnTheWrongOneAtMost) {
  // Truth: 0 fails more often than 1 by more than the indifference; so settling on 0 is an error.
  constexpr int kRepetitions = 1000;
  int wrong = 0;
  int right = 0;
  for (int seed = 0; seed < kRepetitions; ++seed) {
    int first = -1;
    const base::Rng rng = base::Rng(17).Fork(seed);
    const int look = SettlesAt({{0.35}, {0.2}}, rng, true, &first);
    wrong += look > 0 && first == 0;
    right += look > 0 && first == 1;
  }
  EXPECT_LE(wrong, kRepetitions / 20);
  EXPECT_GT(right, kRepetitions / 4);  // or the test could not fail
  RecordProperty("wrong", wrong);
  RecordProperty("right", right);
}

TEST(SettledTest, CommonRandomNumbersSettleEarlier) {
  int paired = 0;
  int apart = 0;
  for (int seed = 0; seed < 100; ++seed) {
    int first = -1;
    const base::Rng rng = base::Rng(18).Fork(seed);
    paired += SettlesAt({{0.3}, {0.15}}, rng, false, &first) > 0;
    apart += SettlesAt({{0.3}, {0.15}}, rng, true, &first) > 0;
  }
  EXPECT_GT(paired, apart);
}

}  // namespace
}  // namespace hires::imagination
