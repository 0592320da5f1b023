#include "hires/imagination/imagine_answer.h"

#include <gmock/gmock.h>

namespace hires::imagination::imagine_answer_test {
namespace {

using execution::StepStatus;
using testing::ElementsAre;
using testing::IsEmpty;
using Outcome = execution::ImagineAnswered::Outcome;

Prediction Way(const std::string& set, double mean) {
  Prediction prediction;
  prediction.action = {"move_base_param", {"table1", set}};
  prediction.evidence.duration.mean = mean;
  for (int i = 1; i <= 40; ++i) prediction.evidence.durations.push_back(mean - 3.0 + 0.1 * i);
  prediction.evidence.duration.p95 = mean + 3.0;
  prediction.evidence.failures = {{base::FailureCode::kNoPath, 1},
                                  {base::FailureCode::kObjectFell, 4}};
  return prediction;
}

Report Ranked() {
  Report report;
  report.outcome = report.found = ImaginationOutcome::kRanked;
  report.ranking = {Way("slow", 20.0), Way("fast", 12.0)};
  report.recommended = 0;
  report.why = "slow is better";
  return report;
}

TEST(ImagineAnswerTest, WhatIsRecommendedComesWithItsDuration) {
  const auto answer = AnswerOf(7, Ranked(), false, {"Mug1", "bowl1", "mug1"});
  EXPECT_EQ(answer.request, 7);
  EXPECT_EQ(answer.outcome, Outcome::kRanked);
  EXPECT_THAT(answer.recommended.arguments, ElementsAre("table1", "slow"));
  EXPECT_EQ(answer.duration, 20.0);
  EXPECT_DOUBLE_EQ(answer.duration_low, 17.2);  // the second of 40
  EXPECT_EQ(answer.duration_high, 23.0);
  EXPECT_THAT(answer.failed, IsEmpty());
  EXPECT_THAT(answer.depends_on, ElementsAre("bowl1", "mug1"));
}

TEST(ImagineAnswerTest, ANearTieIsRanked) {
  Report report = Ranked();
  report.outcome = ImaginationOutcome::kClose;
  EXPECT_EQ(AnswerOf(7, report, false, {}).outcome, Outcome::kRanked);
  EXPECT_EQ(AnswerOf(7, report, false, {}).duration, 20.0);
  report.found = ImaginationOutcome::kClose;
  report.outcome = ImaginationOutcome::kCancelled;
  report.why = "slow is better; stopped by a cancellation";
  EXPECT_EQ(AnswerOf(7, report, true, {}).outcome, Outcome::kRanked);
  EXPECT_EQ(AnswerOf(7, report, true, {}).why,
            "slow is better; stopped by a cancellation at its deadline");
}

TEST(ImagineAnswerTest, WhereAllFailedEachWayIsNamedWithItsMainFailure) {
  Report report = Ranked();
  report.outcome = ImaginationOutcome::kAllFailed;
  report.recommended = -1;
  const auto answer = AnswerOf(1, report, false, {});
  EXPECT_EQ(answer.outcome, Outcome::kAllFailed);
  const base::Failure fell(base::FailureCode::kObjectFell);
  EXPECT_THAT(answer.failures, ElementsAre(fell, fell));
  EXPECT_EQ(answer.failed[1].arguments[1], "fast");
}

TEST(ImagineAnswerTest, WhatWasFoundUntilItsTimeWasOverCounts) {
  Report report = Ranked();
  report.outcome = ImaginationOutcome::kCancelled;
  EXPECT_EQ(AnswerOf(1, report, true, {}).outcome, Outcome::kRanked);
  EXPECT_EQ(AnswerOf(1, report, false, {}).outcome, Outcome::kUnavailable);
  report.found = ImaginationOutcome::kCancelled;
  EXPECT_EQ(AnswerOf(1, report, true, {}).outcome, Outcome::kNothingFinished);
}

TEST(ImagineAnswerTest, ARankingThatRecommendsNothingIsInvalid) {
  for (const int recommended : {-1, 2}) {
    Report report = Ranked();
    report.recommended = recommended;
    EXPECT_EQ(AnswerOf(1, report, false, {}).outcome, Outcome::kInvalid) << recommended;
  }
}

StepStatus Step(int plan, int index, const std::string& set, std::optional<double> started) {
  StepStatus status;
  status.plan = plan;
  status.index = index;
  status.action = {"move_base_param", {"table1", set}};
  status.started = started;
  return status;
}

TEST(DispatchTest, AStepThatARepairTookOverBeganInTheLaterPlan) {
  const base::ActionTemplate action{"!move_base_param", {{"Table1"}, {"slow", "fast"}}};
  const std::vector<StepStatus> first{Step(0, 11, "fast", 3.0)};
  EXPECT_EQ(DispatchOf(first, 0, 11, action), 3.0);
  EXPECT_EQ(DispatchOf(first, 2, 5, action), std::nullopt);
  const std::vector<StepStatus> all{Step(0, 11, "fast", {}), Step(0, 12, "fast", 1.0),
                                    Step(1, 4, "medium", 2.0), Step(1, 5, "slow", 7.0),
                                    Step(2, 5, "fast", 9.0)};
  EXPECT_EQ(DispatchOf(all, 0, 11, action), 7.0);
  EXPECT_EQ(DispatchOf(all, 2, 5, action), 9.0);
}

}  // namespace
}  // namespace hires::imagination::imagine_answer_test
