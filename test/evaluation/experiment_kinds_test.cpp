#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "evaluation/experiment/kinds.h"

namespace hires::evaluation::experiment_kinds_test {
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
  const Findings findings = SumUpToppleLoop(Loop(), {{{fast}, {fast}}, {{slow}}});
  EXPECT_NEAR(ValueOf(findings, "shaking_ratio"), 0.09 / 0.0275, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "shaking_ratio_10hz"), 3.0, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "topple_ratio"), 4.0, 1e-12);
  EXPECT_TRUE(std::isinf(ValueOf(findings, "topple_ratio_10hz")));
  EXPECT_EQ(ValueOf(findings, "falls_fast"), 4.0);
  EXPECT_EQ(ValueOf(findings, "duration_fast"), 20.0);
  EXPECT_EQ(ValueOf(findings, "failed_share_fast"), 0.0);
  EXPECT_NEAR(ValueOf(findings, "confidence_fast"), 1000.0 / (1000.0 + 900.0 + 900.0), 1e-12);
}

TEST(ToppleLoopTest, TheReferenceStandsBesideWithItsPublishedConfidence) {
  const Findings findings = SumUpToppleLoop(Loop(), {{}, {}});
  const auto& rows = findings.tables[0].rows;
  EXPECT_EQ(rows[5], (std::vector<std::string>{"reference, fast", "179054", "165906", "12735",
                                               "413", "0.535"}));
  EXPECT_EQ(rows[6].back(), "0.731");
  EXPECT_TRUE(std::isnan(ValueOf(findings, "topple_ratio")));
}

}  // namespace
}  // namespace hires::evaluation::experiment_kinds_test
