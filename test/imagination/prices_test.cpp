#include "hires/imagination/prices.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "hires/base/text.h"
#include "hires/imagination/evidence.h"
#include "imagination/answer/confidence_sequence.h"
#include "imagination/rollout_examples.h"
#include "support/log_catcher.h"
#include "support/messages.h"

namespace hires::imagination::prices_test {
namespace {

using hires::test_support::ConfigErrorOf;
using test_support::Fall;
using test_support::NoPath;
using test_support::Success;
using test_support::Times;
using test_support::operator+;
using testing::AllOf;
using testing::HasSubstr;

Prices Configured() {
  return ReadPrices(base::ParamReader::FromFile(HIRES_SOURCE_DIR "/config/prices.yaml"));
}

/// The configured file with one line changed, or taken out.
std::string WhyRefused(const std::string& word, const std::string& line) {
  std::string yaml = base::ReadTextFile(HIRES_SOURCE_DIR "/config/prices.yaml", 1u << 16);
  const std::size_t begin = yaml.find("\n" + word + ":") + 1;
  yaml.replace(begin, yaml.find('\n', begin) - begin, line);
  return ConfigErrorOf([&] { ReadPrices(base::ParamReader::FromString(yaml, "prices.yaml")); });
}

Prices Simple() {
  return {{{base::FailureCode::kObjectFell, 100.0}, {base::FailureCode::kOther, 50.0}}, 300.0};
}

TEST(ReadPricesTest, EveryCodeThatEndsARolloutHasItsPrice) {
  const Prices prices = Configured();
  for (const base::FailureInfo& info : base::AllFailures()) {
    EXPECT_EQ(prices.of.count(info.code), EndsRollouts(info.code) ? 1u : 0u) << info.word;
  }
}

TEST(ReadPricesTest, FileWithoutRobotTipsTakesTheDefaultWithOneWarning) {
  std::string yaml = base::ReadTextFile(HIRES_SOURCE_DIR "/config/prices.yaml", 1u << 16);
  const std::size_t line = yaml.find("robot_tips:");
  yaml.erase(line, yaml.find('\n', line) - line);
  const hires::test_support::LogCatcher log;
  const Prices prices = ReadPrices(base::ParamReader::FromString(yaml, "prices.yaml"));
  EXPECT_EQ(prices.of.at(base::FailureCode::kRobotTips), 900.0);
  EXPECT_THAT(log.lines, testing::ElementsAre(AllOf(HasSubstr("robot_tips"), HasSubstr("900"))));
  EXPECT_EQ(Configured().of.at(base::FailureCode::kRobotTips), 900.0);
  EXPECT_EQ(log.lines.size(), 1u) << "the file that has it is not warned of";
}

TEST(ReadPricesTest, ACollisionIsTheWorst) {
  const Prices prices = Configured();
  EXPECT_EQ(prices.Highest(), 300.0 + prices.of.at(base::FailureCode::kRobotCollision));
}

TEST(ReadPricesTest, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(WhyRefused("object_fell", "object_fel: 600.0"),
              AllOf(HasSubstr("prices.yaml"), HasSubstr("failure code 'object_fel' is unknown"),
                    HasSubstr("object_fell")));
  EXPECT_THAT(WhyRefused("object_fell", "motors_halted: 600.0"),
              HasSubstr("no imagined rollout ends with this code"));
  EXPECT_THAT(WhyRefused("object_fell", ""),
              AllOf(HasSubstr("object_fell"), HasSubstr("no price")));
  EXPECT_THAT(WhyRefused("object_fell", "object_fell: -1.0"), HasSubstr("object_fell is '-1.0'"));
  EXPECT_THAT(WhyRefused("late", ""), HasSubstr("late"));
  EXPECT_THAT(WhyRefused("not_done", "not_done: -1.0"), HasSubstr("not_done is '-1.0'"));
  EXPECT_THAT(WhyRefused("object_fell", "object_fell: dear"), HasSubstr("object_fell"));
}

TEST(CostOfTest, IsTheDurationPlusThePriceOfTheFailure) {
  EXPECT_EQ(CostOf(Success(32.0), Simple()), 32.0);
  EXPECT_EQ(CostOf(Fall(20.0), Simple()), 120.0);
}

TEST(CostOfTest, EverySecondBeyondTheDeadlineCosts) {
  Prices prices = Simple();
  prices.late = 2.0;
  EXPECT_EQ(CostOf(Success(32.0), prices), 32.0) << "there is no deadline";
  prices.deadline = 30.0;
  EXPECT_EQ(CostOf(Success(30.0), prices), 30.0);
  EXPECT_EQ(CostOf(Success(32.0), prices), 36.0);
  EXPECT_EQ(CostOf(Fall(35.0), prices), 145.0);
  EXPECT_EQ(prices.Highest(), 300.0 + 2.0 * 270.0 + 100.0);
}

TEST(CostOfTest, ScaledPricesLeaveTheDurationAlone) {
  Prices prices = Simple();
  prices.late = 2.0;
  prices.not_done = 300.0;
  prices.deadline = 30.0;
  const Prices doubled = Scaled(prices, 2.0);
  EXPECT_EQ(CostOf(Fall(35.0), doubled), 35.0 + 20.0 + 200.0);
  EXPECT_EQ(doubled.not_done, 600.0);
}

TEST(CostOfTest, WhatHasNoPriceCostsAsOther) {
  RolloutResult odd = Fall(20.0);
  odd.failure = base::FailureCode::kMotorsHalted;
  EXPECT_EQ(CostOf(odd, Simple()), 70.0);
}

TEST(CostOfTest, NoRolloutCountsAsLongerThanTheLimit) {
  EXPECT_EQ(CostOf(Success(1e6), Simple()), 300.0);
}

TEST(CostOfTest, NothingIsCostlyWithoutPrices) {
  EXPECT_THROW(CostOf(Success(), {}), std::logic_error);
}

/// By the rollouts of one alternative alone.
std::optional<ExpectedCost> CostOfOne(const std::vector<RolloutResult>& results, int num_rollouts,
                                      const Prices& prices) {
  return SumUp(results, num_rollouts, IntervalKind::kConfidenceSequence, prices).cost;
}

// ---------------------------------------------------------------- pseudo-failure

TEST(PseudoPenaltyTest, IsTheMeanOverAllFailuresOfTheRequest) {
  const auto one = Times(3, Fall()) + Times(5, Success()), other = Times(1, NoPath());
  EXPECT_DOUBLE_EQ(PseudoPenalty({{&one, 8}, {&other, 1}}, Simple()), (3 * 100.0 + 50.0) / 4.0);
  EXPECT_DOUBLE_EQ(PseudoPenalty({{&one, 2}, {&other, 0}}, Simple()), 100.0) << "the first ones";
}

TEST(PseudoPenaltyTest, WithoutFailuresIsThatOfDroppingThePayload) {
  auto results = Times(8, Success());
  EXPECT_EQ(PseudoPenalty({{&results, 8}}, Simple()), 100.0);
  for (RolloutResult& result : results) result.nothing_watched = true;
  EXPECT_EQ(PseudoPenalty({{&results, 8}}, Simple()), 50.0) << "there is no payload";
}

// ---------------------------------------------------------------- expected cost

TEST(EstimateCostTest, MeanAddsTheExpectedPenaltyToTheMeanDuration) {
  const auto results = Times(15, Success(30.0)) + Times(1, Fall(14.0));
  const auto cost = CostOfOne(results, 16, Simple());
  ASSERT_TRUE(cost.has_value());
  // Beta(1 1/2, 15 1/2) has the mean 1.5 / 17; one failure and one pseudo-failure of 100 s.
  EXPECT_DOUBLE_EQ(cost->mean, (15 * 30.0 + 14.0) / 16.0 + 1.5 / 17.0 * 100.0);
  EXPECT_LT(cost->lower, cost->mean);
  EXPECT_LT(cost->mean, cost->upper);
  EXPECT_LE(cost->upper, 400.0);
}

TEST(EstimateCostTest, OnePriorPerAlternativeWhateverTheFailureCodes) {
  const auto mixed = Times(14, Success(30.0)) + Times(1, Fall(30.0)) + Times(1, NoPath());
  const auto cost = CostOfOne(mixed, 16, Simple());
  EXPECT_EQ(cost->posterior.failures, 2.0);
  EXPECT_DOUBLE_EQ(cost->posterior.FailureProbability(), 2.5 / 17.0);
  EXPECT_DOUBLE_EQ(cost->posterior.penalty, (100.0 + 50.0 + 75.0) / 3.0);
}

TEST(EstimateCostTest, FailuresOfOthersSetThePenaltyOfTheUnseenOne) {
  const auto flawless = Times(16, Success(30.0)), blocked = Times(16, NoPath());
  const auto evidence =
      SumUpRequest({{&flawless, 16}, {&blocked, 16}}, IntervalKind::kClopperPearson, Simple());
  EXPECT_DOUBLE_EQ(evidence[0].cost->mean, 30.0 + 0.5 / 17.0 * 50.0);
}

TEST(EstimateCostTest, OnlyTheFirstOnesCount) {
  const auto results = Times(8, Success(30.0)) + Times(8, Fall(30.0));
  EXPECT_DOUBLE_EQ(CostOfOne(results, 8, Simple())->mean, 30.0 + 0.5 / 9.0 * 100.0);
}

TEST(EstimateCostTest, WithoutPricesOrRolloutsThereIsNone) {
  EXPECT_FALSE(CostOfOne(Times(8, Success()), 8, {}).has_value());
  EXPECT_FALSE(CostOfOne({}, 0, Simple()).has_value());
  EXPECT_THROW(CostOfOne({}, 1, Simple()), std::logic_error);
}

TEST(EstimateCostTest, FlawlessRolloutsLeaveRoomForAFailureNobodySaw) {
  // 64 flawless ones do not exclude one fall in 50, which costs 2 s in the mean.
  EXPECT_GT(CostOfOne(Times(64, Success(30.0)), 64, Simple())->upper, 32.0);
}

TEST(EstimateCostTest, LowerEndIsNoShorterThanAnyObservedDrive) {
  base::Rng rng(5);
  std::vector<RolloutResult> results;
  for (int i = 0; i < 64; ++i) results.push_back(Success(rng.Normal(15.7, 0.8)));
  const auto cost = CostOfOne(results, 64, Configured());  // printed as 0.0 .. 89.0 s in 0.3.0
  EXPECT_GT(cost->lower, 15.0);
  EXPECT_LT(cost->upper, 16.7 + 0.12 * 600.0);
  EXPECT_GE(CostOfOne({results.front()}, 1, Configured())->lower, results.front().duration);
  EXPECT_LE(CostOfOne({results.front()}, 1, Configured())->upper, 300.0 + 600.0);
}

/// Which durations and failures rollouts are drawn from.
struct Drive {
  double duration, deviation;  ///< [s]
  double detour;               ///< share of rollouts that take twice as long
  double falling, blocked;     ///< shares of failures

  RolloutResult Draw(base::Rng* rng) const {
    double time = rng->Normal(duration, deviation);
    if (rng->Bernoulli(detour)) time *= 2.0;
    const double luck = rng->Uniform(0.0, 1.0);
    if (luck < falling) return Fall(time);
    RolloutResult result = Success(time);
    if (luck < falling + blocked) result.failure = base::FailureCode::kNoPath;
    if (luck < falling + blocked) result.outcome = Outcome::kFailed;
    return result;
  }
  double Expected(const Prices& prices) const {
    return duration * (1.0 + detour) + falling * prices.of.at(base::FailureCode::kObjectFell) +
           blocked * prices.of.at(base::FailureCode::kNoPath);
  }
};

TEST(EstimateCostTest, CoversTheExpectedCostAndIsNarrowerThanBefore) {
  const Prices prices = Configured();
  constexpr int kRuns = 300, kFormerRuns = 10;
  fmt::print("drive                 rollouts  covered  width  width in 0.3.0\n");
  for (const Drive& drive : {Drive{15.7, 0.8, 0.0, 0.0, 0.0}, Drive{15.7, 0.8, 0.0, 0.005, 0.0},
                             Drive{15.7, 0.8, 0.0, 0.1, 0.0}, Drive{15.7, 0.8, 0.1, 0.03, 0.02},
                             Drive{30.0, 5.0, 0.2, 0.2, 0.1}}) {
    for (const int n : {8, 16, 64, 400}) {
      int covered = 0;
      double width = 0.0, former = 0.0;
      for (int run = 0; run < kRuns; ++run) {
        base::Rng rng = base::Rng(77).Fork(run);
        std::vector<RolloutResult> results;
        MeanSequence range(0.0, prices.Highest(), kAlpha);
        for (int i = 0; i < n; ++i) results.push_back(drive.Draw(&rng));
        const auto cost = CostOfOne(results, n, prices);
        const double expected = drive.Expected(prices);
        covered += cost->lower <= expected && expected <= cost->upper;
        width += cost->upper - cost->lower;
        if (run >= kFormerRuns) continue;
        for (const RolloutResult& result : results) range.Add(CostOf(result, prices));
        former += range.Bounds().upper - range.Bounds().lower;
      }
      fmt::print("{:4.1f} s, {:4.1f} % fail  {:8}  {:5.1f} %  {:5.1f}  {:5.1f} s\n", drive.duration,
                 100.0 * (drive.falling + drive.blocked), n, 100.0 * covered / kRuns, width / kRuns,
                 former / kFormerRuns);
      EXPECT_GE(covered, 0.95 * kRuns) << n;
      EXPECT_LT(width / kRuns, 1.08 * former / kFormerRuns) << n;  // fewer runs: noise
    }
  }
}

}  // namespace
}  // namespace hires::imagination::prices_test
