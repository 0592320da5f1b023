#include "hires/imagination/prices.h"

#include <gmock/gmock.h>

#include "hires/base/text.h"
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

TEST(EstimateCostTest, MeanIsThatOfTheRolloutsAndLiesWithin) {
  const auto results = Times(15, Success(30.0)) + Times(1, Fall(14.0));
  const auto cost = EstimateCost(results, 16, Simple());
  ASSERT_TRUE(cost.has_value());
  EXPECT_DOUBLE_EQ(cost->mean, (15 * 30.0 + 114.0) / 16.0);
  EXPECT_LT(cost->lower, cost->mean);
  EXPECT_LT(cost->mean, cost->upper);
  EXPECT_GE(cost->lower, 0.0);
  EXPECT_LE(cost->upper, 400.0);
}

TEST(EstimateCostTest, OnlyTheFirstOnesCount) {
  const auto results = Times(8, Success(30.0)) + Times(8, Fall(30.0));
  EXPECT_EQ(EstimateCost(results, 8, Simple())->mean, 30.0);
}

TEST(EstimateCostTest, WithoutPricesOrRolloutsThereIsNone) {
  EXPECT_FALSE(EstimateCost(Times(8, Success()), 8, {}).has_value());
  EXPECT_FALSE(EstimateCost({}, 0, Simple()).has_value());
  EXPECT_THROW(EstimateCost({}, 1, Simple()), std::logic_error);
}

TEST(EstimateCostTest, FlawlessRolloutsLeaveRoomForAFailureNobodySaw) {
  // 64 flawless ones do not exclude one fall in 50, which costs 2 s in the mean.
  const auto cost = EstimateCost(Times(64, Success(30.0)), 64, Simple());
  EXPECT_GT(cost->upper, 32.0);
}

TEST(EstimateCostTest, CoversTheExpectedCost) {
  int misses = 0;
  for (int i = 0; i < 2000; ++i) {
    base::Rng rng = base::Rng(77).Fork(i);
    std::vector<RolloutResult> results;
    for (int n = 0; n < 64; ++n) {
      results.push_back(rng.Bernoulli(0.1) ? Fall(20.0) : Success(20.0));
    }
    const auto cost = EstimateCost(results, 64, Simple());
    misses += cost->lower > 30.0 || cost->upper < 30.0;
  }
  EXPECT_LE(misses, 100);
}

}  // namespace
}  // namespace hires::imagination::prices_test
