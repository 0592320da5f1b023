#include "lab/src/decision/decision_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "lab/test/decision_examples.h"

namespace hires::lab::decision_report_test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

DecisionSetting AllOf(const std::string& truth = "foreign") {
  return {truth, 1, AllArms(), "0123456789abcdef", "fast"};
}

/// Imagination chose fast where that went well, else slow; once it did nothing.
DecisionReport Example(const std::string& truth = "foreign") {
  return SumUpDecisions(AllOf(truth),
                        {DecisionOf(2, "slow", true), DecisionOf(1, "fast", false),
                         DecisionOf(3, "", false), DecisionOf(4, "slow", true)},
                        SimplePrices());
}

const ArmComparison& Against(const ScaledVerdict& verdict, const std::string& arm) {
  for (const ArmComparison& comparison : verdict.comparisons) {
    if (comparison.arm == arm) return comparison;
  }
  throw std::logic_error("no such comparison");
}

TEST(DecisionReportTest, CostsAreWorkedByHand) {
  const DecisionReport report = Example();
  const auto& arms = report.verdicts.front().arms;
  // 10, 20, 60 (not begun), 20
  EXPECT_NEAR(arms.at(kImaginationArm).cost.estimate, 27.5, 1e-12);
  EXPECT_NEAR(arms.at(kSlowArm).cost.estimate, 20.0, 1e-12);
  // 10, 110, 10, 110; expected: 10 and a quarter of 100
  EXPECT_NEAR(arms.at(kFastArm).cost.estimate, 60.0, 1e-12);
  EXPECT_NEAR(arms.at(kFastArm).expected->estimate, 35.0, 1e-12);
  EXPECT_EQ(arms.at(kFastArm).falls, 2);
  EXPECT_NEAR(arms.at(kFastArm).success.estimate, 0.5, 1e-12);
  EXPECT_EQ(arms.at(kDefaultArm).cost.estimate, arms.at(kFastArm).cost.estimate);
  EXPECT_EQ(report.verdicts.front().best_constant, kSlowArm);
}

TEST(DecisionReportTest, TheOracleKnowsTheTruthsMean) {
  const DecisionReport report = Example();
  const auto& arms = report.verdicts.front().arms;
  EXPECT_NEAR(arms.at(kOracleArm).cost.estimate, 20.0, 1e-12) << "slow: 20 s against 35 s";
  EXPECT_EQ(arms.at(kOracleArm).regret->estimate, 0.0);
  EXPECT_NEAR(arms.at(kFastArm).regret->estimate, 40.0, 1e-12);
  EXPECT_NEAR(arms.at(kFastArm).expected_regret->estimate, 15.0, 1e-12);
  EXPECT_EQ(arms.at(kFastArm).expected_regret->lower, arms.at(kFastArm).expected_regret->upper);
  EXPECT_NEAR(arms.at(kOracleArm).simulated_seconds, 4.0 * (100.0 + 60.0), 1e-9);
}

TEST(DecisionReportTest, PricesMoveTheOracle) {
  // At half the price fast costs 10 + 12.5 s in the mean, at a tenth it would win.
  const DecisionReport report = Example();
  ASSERT_THAT(report.verdicts, SizeIs(3));
  EXPECT_EQ(report.verdicts[1].scale, 0.5);
  EXPECT_NEAR(report.verdicts[1].arms.at(kFastArm).expected->estimate, 22.5, 1e-12);
  EXPECT_NEAR(report.verdicts[2].arms.at(kFastArm).expected->estimate, 60.0, 1e-12);
  EXPECT_NEAR(report.verdicts[2].arms.at(kImaginationArm).cost.estimate, 42.5, 1e-12);
}

TEST(DecisionReportTest, ComparisonsAreOfTheSameTasks) {
  const DecisionReport report = Example();
  const ArmComparison& fast = Against(report.verdicts.front(), kFastArm);
  // 0, -90, +50, -90
  EXPECT_NEAR(fast.cost.estimate, -32.5, 1e-12);
  EXPECT_EQ(fast.num_differ, 3);
  EXPECT_EQ(fast.success.only_first, 2);
  EXPECT_EQ(fast.success.only_second, 1);
  EXPECT_NEAR(fast.sign_p_value, 1.0, 1e-12) << "two cheaper, one dearer: 2 * 1/2";
  EXPECT_NEAR(fast.t_free_p_value, 0.5, 1e-12) << "of 8 signs: (+-90 +-90 +-50), 130 or farther";
}

TEST(DecisionReportTest, JsonHasTheAgreedFields) {
  const auto json = ToJson(Example(), "hires_lab experiment decision");
  for (const std::string& arm : AllArms()) {
    const auto& found = json["arms"][arm];
    for (const char* interval : {"cost", "regret"}) {
      for (const char* field : {"mean", "lower", "upper"}) {
        EXPECT_TRUE(found[interval][field].is_number()) << arm << interval << field;
      }
    }
    for (const char* field :
         {"success", "falls", "simulated_seconds", "wall_seconds", "processor_seconds"}) {
      EXPECT_TRUE(found[field].is_number()) << arm << field;
    }
    EXPECT_THAT(found["tasks"], SizeIs(4)) << arm;
  }
  EXPECT_EQ(json["arms"][kImaginationArm]["tasks"][0]["task"], 1) << "in order";
  EXPECT_TRUE(json["arms"][kImaginationArm]["tasks"][2]["chosen"].is_null());
  EXPECT_EQ(json["truth"], "foreign");
  EXPECT_EQ(json["calibration"]["steps"], 8);
}

TEST(DecisionReportTest, WithoutAnOracleThereIsNeitherRegretNorExpectation) {
  DecisionRecord record = DecisionOf(1, "slow", false);
  record.oracle.clear();
  DecisionSetting setting = AllOf();
  setting.arms = {kImaginationArm, kSlowArm};
  const DecisionReport report = SumUpDecisions(setting, {record}, SimplePrices());
  EXPECT_FALSE(report.verdicts.front().arms.at(kSlowArm).regret);
  EXPECT_TRUE(ToJson(report, "")["arms"][kSlowArm]["regret"].is_null());
  EXPECT_FALSE(Against(report.verdicts.front(), kSlowArm).expected) << "one play is no expectation";
  EXPECT_TRUE(ToJson(report, "")["arms"][kSlowArm]["expected_cost"].is_null());
}

TEST(DecisionReportTest, SaysWhichConstantTheDomainsDefaultIsAndHowOftenImaginationWasUndecided) {
  EXPECT_THAT(DecisionText(Example()), HasSubstr("domain_default (always fast)"));
  DecisionRecord open = DecisionOf(1, "slow", true);
  for (Advice& advice : open.imagined.decided[kImaginationArm].advice) {
    advice.outcome = imagination::ImaginationOutcome::kUndecided;
  }
  const DecisionReport report = SumUpDecisions(AllOf(), {open}, SimplePrices());
  const DecisionArm& arm = report.verdicts.front().arms.at(kImaginationArm);
  EXPECT_EQ(arm.num_undecided, 1);
  EXPECT_EQ(arm.tasks.front().motion_set, "slow");
  EXPECT_EQ(ToJson(report, "")["arms"][kImaginationArm]["undecided"], 1);
}

TEST(DecisionReportTest, SaysWhatTheTruthSameIs) {
  EXPECT_THAT(DecisionText(Example("same")), HasSubstr("imagination's own model"));
  EXPECT_THAT(DecisionText(Example()), Not(HasSubstr("imagination's own model")));
}

TEST(CalibrateTest, CountsStepsDurationsAndActions) {
  const CalibrationReport report = *Example().calibration;
  EXPECT_EQ(report.num_steps, 8);
  // Slow was said to succeed with 1 and did; fast with 3/4 and did twice in four.
  EXPECT_NEAR(report.brier.score, (2.0 * 0.0625 + 2.0 * 0.5625) / 8.0, 1e-12);
  EXPECT_EQ(report.num_durations, 6);
  // Two of five for slow, two of four for fast: 0.4 .. 0.6 and 0.5 .. 0.75.
  EXPECT_EQ(report.pit[4] + report.pit[5] + report.pit[6] + report.pit[7], 6);
  EXPECT_EQ(report.duration_coverage.estimate, 1.0);
  EXPECT_EQ(report.num_actions, 2);
  EXPECT_NEAR(report.correlation.estimate, 1.0, 1e-12);
  EXPECT_EQ(report.rank_violation, 0.0);
  EXPECT_EQ(report.success_coverage.estimate, 1.0) << "0.75 in 0.2 .. 0.99, 1 in 0.4 .. 1";
  EXPECT_EQ(report.groups.front().name, "fast");
  EXPECT_NEAR(report.groups.front().predicted, 0.75, 1e-12);
  EXPECT_EQ(report.groups.front().num_success, 2);
}

}  // namespace
}  // namespace hires::lab::decision_report_test
