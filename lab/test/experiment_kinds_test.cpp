#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "lab/src/experiment/kinds.h"
#include "lab/src/statistics.h"

namespace hires::lab::experiment_kinds_test {
namespace {

using imagination::Outcome;
using imagination::RolloutResult;

double ValueOf(const Findings& findings, const std::string& name) {
  for (const Measure& measure : findings.measures) {
    if (measure.name == name) return measure.value;
  }
  ADD_FAILURE() << "no measure " << name;
  return std::nan("");
}

Interval IntervalOf(const Findings& findings, const std::string& name) {
  for (const NamedInterval& each : findings.intervals) {
    if (each.name == name) return each.interval;
  }
  ADD_FAILURE() << "no interval " << name;
  return {};
}

RolloutResult Result(int notopple, int shaking, int topple, int falls, double duration = 10.0) {
  RolloutResult result;
  result.outcome = falls == 0 ? Outcome::kSucceeded : Outcome::kFailed;
  result.action_finished = true;
  result.counts = {notopple, shaking, topple};
  result.falls = falls;
  result.duration = duration;
  result.simulated = duration + 0.5;
  return result;
}

Leg Driven(const std::string& to, const RolloutResult& result) {
  Leg leg;
  leg.to = to;
  leg.result = result;
  leg.clearance = 0.5;
  return leg;
}

const std::vector<Goal> kThree{{"a", {}}, {"b", {}}, {"c", {}}};

TEST(ShuffledGoalsTest, VisitsEveryGoalOnceARoundAndNeverTwiceInARow) {
  for (int seed = 0; seed < 100; ++seed) {
    const auto order = ShuffledGoals(kThree, 30, base::Rng(seed));
    ASSERT_EQ(order.size(), 30u);
    EXPECT_NE(order.front(), "a") << "the robot stands there";
    for (std::size_t i = 1; i < order.size(); ++i) EXPECT_NE(order[i], order[i - 1]);
    for (std::size_t i = 0; i < order.size(); i += 3) {
      EXPECT_EQ(std::set<std::string>(order.begin() + i, order.begin() + i + 3).size(), 3u);
    }
  }
}

TEST(ShuffledGoalsTest, DependsOnTheSeedAlone) {
  EXPECT_EQ(ShuffledGoals(kThree, 30, base::Rng(1)), ShuffledGoals(kThree, 30, base::Rng(1)));
  EXPECT_NE(ShuffledGoals(kThree, 30, base::Rng(1)), ShuffledGoals(kThree, 30, base::Rng(2)));
  EXPECT_EQ(ShuffledGoals(kThree, 4, base::Rng(1)).size(), 4u);
}

class LegsTest : public testing::Test {
 protected:
  LegsTest() {
    config_.goals = {{"a", {}}, {"b", {}}};
    config_.kind = LegsConfig{4, 1, "fast"};
    stage_.xy_tolerance = 0.2;
    stage_.yaw_tolerance = 0.17;
  }
  ExperimentConfig config_;
  Stage stage_;
};

TEST_F(LegsTest, CountsWhatWasReachedTouchedAndMissed) {
  Leg good = Driven("b", Result(1, 0, 0, 0, 12.0)), far = Driven("a", Result(1, 0, 0, 0, 14.0));
  good.distance = 0.1;
  far.distance = 0.25;
  far.yaw_error = 0.1;
  Leg stuck = Driven("b", Result(1, 0, 0, 0)), crash = Driven("a", Result(1, 0, 0, 0));
  stuck.result.action_finished = crash.result.action_finished = false;
  stuck.result.failure = base::FailureCode::kNoPath;
  crash.result.failure = base::FailureCode::kRobotCollision;
  crash.touched = "base / table1";
  crash.clearance = 0.0;
  const Findings findings = SumUpLegs(config_, stage_, {{good, far}, {stuck, crash}});
  EXPECT_EQ(ValueOf(findings, "legs"), 4.0);
  EXPECT_EQ(ValueOf(findings, "reached_share"), 0.5);
  EXPECT_EQ(ValueOf(findings, "contacts"), 1.0);
  EXPECT_EQ(ValueOf(findings, "beyond_tolerance"), 1.0);
  EXPECT_EQ(ValueOf(findings, "max_distance"), 0.25);
  EXPECT_EQ(ValueOf(findings, "min_clearance"), 0.0);
  EXPECT_EQ(ValueOf(findings, "mean_duration"), 13.0);
  EXPECT_EQ(ValueOf(findings, "min_visits"), 2.0);
  EXPECT_EQ(findings.rows.size(), 4u);
  EXPECT_EQ(findings.rows[3]["touched"], "base / table1");
  EXPECT_EQ(findings.rows[3]["chain"], 1);
  EXPECT_EQ(findings.tables[1].rows.size(), 3u) << "heads and two problems";
}

TEST_F(LegsTest, NoLegsHoldNoExpectationAboutShares) {
  const Findings findings = SumUpLegs(config_, stage_, {});
  EXPECT_TRUE(std::isnan(ValueOf(findings, "reached_share")));
  EXPECT_EQ(ValueOf(findings, "min_visits"), 0.0);
}

const PairedConfig kPaired{2, "a", "b", {"fast", "slow"}};

TEST(PairedTest, DifferencesAreTakenPairByPair) {
  const std::vector<Rollouts> rollouts{
      {Result(80, 20, 0, 0), Result(50, 40, 10, 1), Result(70, 30, 0, 0)},
      {Result(90, 10, 0, 0), Result(80, 20, 0, 0), Result(100, 0, 0, 0)}};
  const Findings findings = SumUpPaired(kPaired, rollouts);
  // Differences 0.1, 0.2, 0.3: mean 0.2, deviation 0.1, t of 2 degrees 4.302653.
  EXPECT_NEAR(ValueOf(findings, "shaking_difference"), 0.2, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "shaking_difference_lower"), 0.2 - 0.2484138, 1e-6);
  EXPECT_NEAR(ValueOf(findings, "fall_difference"), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(ValueOf(findings, "fall_p_value"), 1.0);
  EXPECT_NEAR(ValueOf(findings, "shaking_share_fast"), 0.3, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "fall_share_fast"), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(ValueOf(findings, "failed_slow"), 0.0);
  EXPECT_EQ(findings.rows.size(), 6u);
}

TEST(PairedTest, PairsThatBothFallSayNothing) {
  const Rollouts fallen{Result(1, 1, 1, 1), Result(1, 1, 1, 2)};
  const Findings findings = SumUpPaired(kPaired, {fallen, fallen});
  EXPECT_EQ(ValueOf(findings, "fall_difference"), 0.0);
  EXPECT_LT(ValueOf(findings, "fall_difference_lower"), 0.0);
}

ToppleLoopConfig Loop() {
  ToppleLoopConfig loop;
  loop.route = {"a", "b"};
  loop.motion_sets = {"fast", "slow"};
  loop.references["fast"] = {{165906, 12735, 413}, 18090.0};
  loop.references["slow"] = {{165596, 6031, 90}, 17350.0};
  return loop;
}

TEST(ToppleLoopTest, RatiosAreThoseOfTheShares) {
  Leg fast = Driven("b", Result(900, 90, 10, 2)), slow = Driven("b", Result(1940, 55, 5, 1));
  fast.counts_10hz = {450, 45, 5};
  slow.counts_10hz = {970, 30, 0};
  const Findings findings = SumUpToppleLoop(Loop(), 1, {{{fast}, {fast}}, {{slow}}});
  EXPECT_NEAR(ValueOf(findings, "shaking_ratio"), 0.09 / 0.0275, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "shaking_ratio_10hz"), 3.0, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "topple_ratio"), 4.0, 1e-12);
  EXPECT_TRUE(std::isinf(ValueOf(findings, "topple_ratio_10hz")));
  EXPECT_EQ(ValueOf(findings, "falls_fast"), 4.0);
  EXPECT_EQ(ValueOf(findings, "duration_fast"), 20.0);
  EXPECT_EQ(ValueOf(findings, "failed_share_fast"), 0.0);
  EXPECT_NEAR(ValueOf(findings, "confidence_fast"), 1000.0 / (1000.0 + 900.0 + 900.0), 1e-12);
}

TEST(ToppleLoopTest, TellsCountsAndSharesAtBothRates) {
  Leg fast = Driven("b", Result(900, 90, 10, 2)), slow = Driven("b", Result(1940, 55, 5, 1));
  fast.counts_10hz = {450, 45, 4};
  slow.counts_10hz = {970, 30, 0};
  const Findings findings = SumUpToppleLoop(Loop(), 1, {{{fast}, {fast}}, {{slow}}});
  EXPECT_EQ(ValueOf(findings, "notopple_count_fast"), 1800.0);
  EXPECT_EQ(ValueOf(findings, "all_count_fast"), 2000.0);
  EXPECT_EQ(ValueOf(findings, "notopple_count_fast_10hz"), 900.0);
  EXPECT_EQ(ValueOf(findings, "shaking_count_fast_10hz"), 90.0);
  EXPECT_EQ(ValueOf(findings, "topple_count_fast_10hz"), 8.0);
  EXPECT_EQ(ValueOf(findings, "all_count_fast_10hz"), 998.0);
  EXPECT_EQ(ValueOf(findings, "all_count_slow_10hz"), 1000.0);
  EXPECT_NEAR(ValueOf(findings, "topple_share_fast_10hz"), 8.0 / 998.0, 1e-15);
  EXPECT_NEAR(ValueOf(findings, "topple_share_fast"), 0.01, 1e-15);
  // That no slow sample at 10 Hz is one of toppling bounds the ratio nowhere.
  EXPECT_TRUE(std::isinf(IntervalOf(findings, "topple_ratio_10hz").upper));
  EXPECT_EQ(IntervalOf(findings, "topple_share_slow_10hz").upper, 0.0);
}

/// Rounds of the route a, b: of 100 samples at 10 Hz the first leg shakes in none, the second in so
/// many; twice as many at 20 Hz.
std::vector<Leg> Rounds(const std::vector<int>& shaking) {
  std::vector<Leg> chain;
  for (const int second : shaking) {
    for (const int count : {0, second}) {
      chain.push_back(Driven("b", Result(2 * (100 - count), 2 * count, 0, 0)));
      chain.back().counts_10hz = {100 - count, count, 0};
    }
  }
  return chain;
}

/// Of each round.
std::vector<double> ShakingSharesOf(const std::vector<int>& shaking) {
  std::vector<double> shares;
  for (const int count : shaking) shares.push_back(count / 200.0);
  return shares;
}

std::vector<int> DrawnCounts(int num, int below, base::Rng rng) {
  std::vector<int> counts(num);
  for (int& count : counts) count = rng.Index(below);
  return counts;
}

double Width(const Interval& interval) { return interval.upper - interval.lower; }

TEST(ToppleLoopTest, EqualRoundsLeaveNoDoubtThoughTheirLegsDiffer) {
  const std::vector<int> fast(10, 20), slow(8, 10);
  const Findings findings =
      SumUpToppleLoop(Loop(), 1, {{Rounds(fast), Rounds(fast)}, {Rounds(slow)}});
  EXPECT_EQ(ValueOf(findings, "independent_parts_fast"), 20.0);
  EXPECT_EQ(ValueOf(findings, "independent_parts_slow"), 8.0);
  for (const char* suffix : {"", "_10hz"}) {
    const Interval share = IntervalOf(findings, std::string("shaking_share_fast") + suffix);
    EXPECT_EQ(share.estimate, 0.1);
    EXPECT_EQ(share.lower, 0.1);
    EXPECT_EQ(share.upper, 0.1);
    const Interval ratio = IntervalOf(findings, std::string("shaking_ratio") + suffix);
    EXPECT_NEAR(ratio.estimate, 2.0, 1e-12);
    EXPECT_EQ(Width(ratio), 0.0);
  }
  const TextTable& table = findings.tables[1];
  EXPECT_NE(table.title.find("resampling 20 and 8 rounds of the route"), std::string::npos);
  EXPECT_EQ(table.rows[2][2], "0.10000 (0.10000 .. 0.10000)");
  EXPECT_EQ(table.rows[2][4], "2.00 (2.00 .. 2.00)");
}

TEST(ToppleLoopTest, OfManyRoundsIntervalsAreTheNormalOnes) {
  constexpr int kRounds = 400;
  const std::vector<int> fast = DrawnCounts(kRounds, 41, base::Rng(3)),
                         slow = DrawnCounts(kRounds, 21, base::Rng(4));
  const Findings findings = SumUpToppleLoop(Loop(), 1, {{Rounds(fast)}, {Rounds(slow)}});
  const Interval fast_mean = MeanInterval(ShakingSharesOf(fast)),
                 slow_mean = MeanInterval(ShakingSharesOf(slow));
  for (const char* suffix : {"", "_10hz"}) {
    // An end is off by 0.06 standard errors, which is what 2000 resamples are worth. Single legs as
    // parts would give half as much again.
    const Interval share = IntervalOf(findings, std::string("shaking_share_fast") + suffix);
    const double error = Width(fast_mean) / 2.0 / 1.96;
    EXPECT_NEAR(share.estimate, fast_mean.estimate, 1e-12);
    EXPECT_NEAR(share.lower, fast_mean.lower, 0.25 * error);
    EXPECT_NEAR(share.upper, fast_mean.upper, 0.25 * error);
    // Relative errors of both add up in squares.
    const Interval ratio = IntervalOf(findings, std::string("shaking_ratio") + suffix);
    const double half = ratio.estimate * std::hypot(Width(fast_mean) / 2.0 / fast_mean.estimate,
                                                    Width(slow_mean) / 2.0 / slow_mean.estimate);
    EXPECT_NEAR(ratio.lower, ratio.estimate - half, 0.15 * half);
    EXPECT_NEAR(ratio.upper, ratio.estimate + half, 0.15 * half);
  }
}

TEST(ToppleLoopTest, WhereAChainHasOneTruthItIsOnePart) {
  Chains chains;
  std::vector<double> shares;
  for (int c = 0; c < 20; ++c) {
    chains.push_back(Rounds(std::vector<int>(9, 2 * c)));  // all rounds of a chain are alike
    shares.push_back(2 * c / 200.0);
  }
  ToppleLoopConfig loop = Loop();
  const Interval by_round =
      IntervalOf(SumUpToppleLoop(loop, 1, {chains, chains}), "shaking_share_fast");
  loop.one_truth_per_chain = true;
  const Findings findings = SumUpToppleLoop(loop, 1, {chains, chains});
  const Interval by_chain = IntervalOf(findings, "shaking_share_fast");
  EXPECT_EQ(ValueOf(findings, "independent_parts_fast"), 20.0);
  EXPECT_NE(findings.tables[1].title.find("20 and 20 chains"), std::string::npos);
  const double half = 1.96 * Deviation(shares) / std::sqrt(20.0);
  EXPECT_NEAR(Width(by_chain), 2.0 * half, 0.15 * half);
  EXPECT_NEAR(Width(by_chain) / Width(by_round), 3.0, 0.4) << "nine rounds a chain";
}

TEST(ToppleLoopTest, IntervalsDependOnTheSeedAloneAndTheirNamesOnNothing) {
  const std::vector<Chains> played{{Rounds(DrawnCounts(30, 41, base::Rng(3)))},
                                   {Rounds(DrawnCounts(30, 21, base::Rng(4)))}};
  const Findings once = SumUpToppleLoop(Loop(), 1, played),
                 again = SumUpToppleLoop(Loop(), 1, played),
                 other = SumUpToppleLoop(Loop(), 2, played),
                 nothing = SumUpToppleLoop(Loop(), 1, {{}, {}});
  ASSERT_EQ(once.intervals.size(), 18u) << "three kinds, two rates, two shares and a ratio";
  ASSERT_EQ(nothing.intervals.size(), 18u);
  bool differs = false;
  for (std::size_t i = 0; i < once.intervals.size(); ++i) {
    const std::string& name = once.intervals[i].name;
    EXPECT_EQ(nothing.intervals[i].name, name);
    EXPECT_TRUE(std::isnan(nothing.intervals[i].interval.upper)) << name;
    if (name.rfind("topple", 0) == 0) continue;  // none came
    EXPECT_EQ(once.intervals[i].interval.estimate, ValueOf(once, name)) << name;
    EXPECT_EQ(once.intervals[i].interval.lower, again.intervals[i].interval.lower) << name;
    EXPECT_EQ(once.intervals[i].interval.upper, again.intervals[i].interval.upper) << name;
    differs = differs || once.intervals[i].interval.upper != other.intervals[i].interval.upper ||
              once.intervals[i].interval.lower != other.intervals[i].interval.lower;
  }
  EXPECT_TRUE(differs);
}

TEST(ToppleLoopTest, TheReferenceStandsBesideWithItsPublishedConfidence) {
  const Findings findings = SumUpToppleLoop(Loop(), 1, {{}, {}});
  const auto& rows = findings.tables[0].rows;
  EXPECT_EQ(rows[5], (std::vector<std::string>{"reference, fast", "179054", "165906", "12735",
                                               "413", "0.535"}));
  EXPECT_EQ(rows[6].back(), "0.731");
  EXPECT_TRUE(std::isnan(ValueOf(findings, "topple_ratio")));
}

}  // namespace
}  // namespace hires::lab::experiment_kinds_test
