#include "reports/episode/episode_compare.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace hires::reports::episode_compare_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kSurprise = 0.05;

EpisodeStep Step(ActionFate fate, double duration) {
  EpisodeStep step;
  step.action = {"move_torso", {"torsoupposture"}};
  step.fate = fate;
  step.duration = duration;
  if (fate == ActionFate::kFailed) step.failure = base::FailureCode::kTimedOut;
  return step;
}

imagination::RolloutResult Result(bool is_success, double duration) {
  imagination::RolloutResult result;
  result.outcome = is_success ? imagination::Outcome::kSucceeded : imagination::Outcome::kFailed;
  result.action_finished = is_success;
  result.nothing_watched = true;
  result.duration = duration;
  return result;
}

/// Successes that took 1, 2, ... s, and failures.
ImaginedAction Imagined(int num_success, int num_failed) {
  std::vector<imagination::RolloutResult> results;
  ImaginedAction imagined;
  for (int i = 1; i <= num_success; ++i) results.push_back(Result(true, i));
  for (int i = 0; i < num_failed; ++i) results.push_back(Result(false, 0.0));
  imagined.evidence = imagination::SumUp(results);
  return imagined;
}

TEST(CompareStepTest, ADurationWithinWhatWasImaginedIsAsImagined) {
  const auto compared = CompareStep(Step(ActionFate::kSucceeded, 16.5), Imagined(64, 0), kSurprise);
  EXPECT_EQ(compared.verdict, StepVerdict::kAsImagined);
  EXPECT_DOUBLE_EQ(*compared.percentile, 25.0);  // 16 of 64 are shorter
}

TEST(CompareStepTest, EqualDurationsCountHalf) {
  const auto compared = CompareStep(Step(ActionFate::kSucceeded, 32.0), Imagined(64, 0), kSurprise);
  EXPECT_DOUBLE_EQ(*compared.percentile, 100.0 * 31.5 / 64.0);
}

TEST(CompareStepTest, ADurationBeyondAllIsASurpriseOnlyWhereEnoughWereImagined) {
  // Beyond all n: chance 1 / (n + 1), which is below 0.025 from n = 40 on.
  EXPECT_EQ(CompareStep(Step(ActionFate::kSucceeded, 99.0), Imagined(40, 0), kSurprise).verdict,
            StepVerdict::kSlower);
  EXPECT_EQ(CompareStep(Step(ActionFate::kSucceeded, 99.0), Imagined(39, 0), kSurprise).verdict,
            StepVerdict::kTooFewDurations);
  EXPECT_EQ(CompareStep(Step(ActionFate::kSucceeded, 0.5), Imagined(40, 0), kSurprise).verdict,
            StepVerdict::kFaster);
  EXPECT_EQ(CompareStep(Step(ActionFate::kSucceeded, 0.5), Imagined(39, 0), kSurprise).verdict,
            StepVerdict::kTooFewDurations);
}

TEST(CompareStepTest, WhereAlmostAllFailedAsItDidNoDurationIsAskedFor) {
  const auto compared = CompareStep(Step(ActionFate::kFailed, 3.0), Imagined(1, 63), kSurprise);
  EXPECT_EQ(compared.verdict, StepVerdict::kAsImagined);
}

TEST(CompareStepTest, WhereEveryRolloutFailedADurationHasNoPercentile) {
  const auto compared = CompareStep(Step(ActionFate::kSucceeded, 3.0), Imagined(0, 64), kSurprise);
  EXPECT_EQ(compared.verdict, StepVerdict::kSucceededAgainst);
  EXPECT_FALSE(compared.percentile.has_value());
}

TEST(CompareStepTest, SuccessAndFailureAreHeldAgainstTheInterval) {
  const auto verdict = [](ActionFate fate, int num_success, int num_failed) {
    return CompareStep(Step(fate, 3.0), Imagined(num_success, num_failed), kSurprise).verdict;
  };
  EXPECT_EQ(verdict(ActionFate::kFailed, 60, 4), StepVerdict::kFailedAgainst);
  EXPECT_EQ(verdict(ActionFate::kFailed, 4, 60), StepVerdict::kAsImagined);
  EXPECT_EQ(verdict(ActionFate::kSucceeded, 4, 60), StepVerdict::kSucceededAgainst);
  EXPECT_EQ(verdict(ActionFate::kSucceeded, 32, 32), StepVerdict::kUndecided);
  EXPECT_EQ(verdict(ActionFate::kFailed, 32, 32), StepVerdict::kUndecided);
}

TEST(CompareStepTest, WhatCannotBeImaginedIsNotCompared) {
  ImaginedAction refused;
  refused.refusal = "the start is in collision";
  const auto compared = CompareStep(Step(ActionFate::kSucceeded, 3.0), refused, kSurprise);
  EXPECT_EQ(compared.verdict, StepVerdict::kNotCompared);
  EXPECT_EQ(compared.why, refused.refusal);
  EpisodeStep cut = Step(ActionFate::kUnknown, 3.0);
  cut.why_not = "its result was not recorded";
  EXPECT_EQ(CompareStep(cut, {}, kSurprise).why, cut.why_not);
}

/// Rollouts that ended by a failure each, beside successes.
ImaginedAction FailedBy(int num_success, const base::Failure& failure, int num_failed) {
  std::vector<imagination::RolloutResult> results;
  for (int i = 1; i <= num_success; ++i) results.push_back(Result(true, i));
  for (int i = 0; i < num_failed; ++i) {
    results.push_back(Result(false, 0.0));
    results.back().failure = failure;
  }
  return {imagination::SumUp(results), {}};
}

const base::Failure kVoid{base::FailureCode::kPhysicsBroke, {"mug"}, "mug gained energy"};

TEST(CompareStepTest, VoidRolloutsSayNothing) {
  const EpisodeStep done = Step(ActionFate::kSucceeded, 20.0);
  const auto all = CompareStep(done, FailedBy(0, kVoid, 40), kSurprise);
  EXPECT_EQ(all.verdict, StepVerdict::kNotCompared);
  EXPECT_EQ(all.why, "every rollout is void");
  const auto most = CompareStep(done, FailedBy(40, kVoid, 60), kSurprise);
  EXPECT_EQ(most.verdict, StepVerdict::kAsImagined);
  EXPECT_EQ(most.imagined.evidence.num_rollouts, 40);
  EXPECT_DOUBLE_EQ(most.imagined.evidence.success.share, 1.0);
  EXPECT_DOUBLE_EQ(most.imagined.evidence.action_failed_share, 0.0);
  const auto none = CompareStep(done, FailedBy(0, base::FailureCode::kTimedOut, 40), kSurprise);
  EXPECT_EQ(none.verdict, StepVerdict::kSucceededAgainst);
}

TEST(EpisodeReportTest, TheTableTellsOfWhatMostRolloutsFailedOrAreVoid) {
  const EpisodeStep done = Step(ActionFate::kSucceeded, 20.0);
  const base::Failure blocked{base::FailureCode::kStartBlocked, {}, "the start is off the map"};
  const std::string text = EpisodeTable({CompareStep(done, FailedBy(0, blocked, 8), kSurprise),
                                         CompareStep(done, FailedBy(60, blocked, 4), kSurprise),
                                         CompareStep(done, FailedBy(60, kVoid, 4), kSurprise)});
  EXPECT_THAT(text,
              HasSubstr("step 1: of its rollouts 8 failed by start_blocked: the start is off"));
  EXPECT_THAT(text, Not(HasSubstr("step 2")));
  EXPECT_THAT(text,
              HasSubstr("step 3: of its rollouts 4 void by physics_broke: mug gained energy"));
}

TEST(EpisodeReportTest, WhatSeveralStepsHaveInCommonIsToldOnce) {
  EpisodeStep cut = Step(ActionFate::kUnknown, 3.0);
  cut.why_not = "its result was not recorded";
  const ComparedStep same = CompareStep(cut, {}, kSurprise);
  const ComparedStep other = CompareStep(Step(ActionFate::kSucceeded, 3.0), {}, kSurprise);
  const std::string text = EpisodeTable({same, other, same});
  EXPECT_THAT(text, HasSubstr("steps 1, 3: its result was not recorded\n"));
  EXPECT_THAT(text, HasSubstr("step 2: no rollout was played\n"));
}

TEST(EpisodeReportTest, TableSummaryAndJsonSayWhatWasImaginedAndWhatHappened) {
  ImaginedAction refused;
  refused.refusal = "no way";
  const std::vector<ComparedStep> steps{
      CompareStep(Step(ActionFate::kSucceeded, 35.0), Imagined(64, 0), kSurprise),
      CompareStep(Step(ActionFate::kFailed, 3.0), Imagined(60, 4), kSurprise),
      CompareStep(Step(ActionFate::kSucceeded, 3.0), refused, kSurprise)};
  EXPECT_THAT(EpisodeTable(steps),
              AllOf(HasSubstr("move_torso(torsoupposture)"), HasSubstr("timed_out"),
                    HasSubstr("failed against the prediction"), HasSubstr("step 3: no way")));
  // The mean of 1 .. 64 is 32.5.
  EXPECT_THAT(EpisodeSummary(steps),
              AllOf(HasSubstr("3 steps: 1 as imagined, 1 failed against the prediction, "
                              "1 not compared"),
                    HasSubstr("1 durations: +2.50 s")));
  const auto json = EpisodeJson(steps);
  EXPECT_EQ(json["steps"][0]["verdict"], "as imagined");
  EXPECT_EQ(json["steps"][1]["failure"]["failure"], "timed_out");
  EXPECT_TRUE(json["steps"][2]["imagined"].is_null());
  EXPECT_TRUE(json["steps"][2]["percentile"].is_null());
  EXPECT_DOUBLE_EQ(json["duration_error_mean"], 2.5);
}

TEST(ImagineStepTest, AStepIsImaginedAlikeByAnyNumberOfThreads) {
  const auto setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml"));
  EpisodeStep step;
  step.start = imagination::MakeStartState(setup, "premanipulationareaeastcounter1",
                                           std::vector<std::string>{});
  step.action = {"move_base_blind", {"manipulationareaeastcounter1"}};
  const ReplayParams params{4, 7};
  const auto one = ImagineStep(setup, step, params, 0, {1, {}, {}});
  const auto two = ImagineStep(setup, step, params, 0, {2, {}, {}});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->refusal, "");
  EXPECT_EQ(one->evidence.num_rollouts, 4);
  EXPECT_FALSE(one->evidence.durations.empty());
  EXPECT_EQ(one->evidence.durations, two->evidence.durations);
  step.action = {"move_base_blind", {"nowhere"}};
  EXPECT_THAT(ImagineStep(setup, step, params, 0, {1, {}, {}})->refusal, HasSubstr("nowhere"));
}

}  // namespace
}  // namespace hires::reports::episode_compare_test
