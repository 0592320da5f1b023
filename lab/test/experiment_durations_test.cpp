#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/src/durations/duration_fit.h"
#include "lab/src/experiment/kinds.h"

namespace hires::lab::experiment_durations_test {
namespace {

using imagination::RolloutResult;

constexpr int kNumCases = 100;

double ValueOf(const Findings& findings, const std::string& name) {
  for (const Measure& measure : findings.measures) {
    if (measure.name == name) return measure.value;
  }
  ADD_FAILURE() << "no measure " << name;
  return std::nan("");
}

RolloutResult Lasting(double duration) {
  RolloutResult result;
  result.outcome = imagination::Outcome::kSucceeded;
  result.action_finished = true;
  result.counts = {1, 0, 0};
  result.duration = duration;
  return result;
}

const char kDrive[] = "move_base_param";

TEST(FitDurationsTest, EachModelFitsWhatItIsNamedAfter) {
  const DurationRows rows{{"a", 10.0, 14.0, 3.0}, {"b", 20.0, 26.0, 4.0}};
  const auto fit = [&](DurationModel model) { return FitDurations(model, rows); };
  EXPECT_EQ(fit(DurationModel::kAsPlayed).At(7.0), 7.0);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kConstant).At(7.0), 20.0);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kStartTime).At(7.0), 12.0);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kTimeScale).At(7.0), 7.0 * 660.0 / 500.0);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kStartAndScale).start_time, 2.0);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kStartAndScale).time_scale, 1.2);
  EXPECT_DOUBLE_EQ(fit(DurationModel::kAsPlayed).noise, std::sqrt(12.5));
}

TEST(FitDurationsTest, RowsThatDetermineNothingGiveNoNumber) {
  EXPECT_TRUE(std::isnan(FitDurations(DurationModel::kStartTime, {}).At(1.0)));
  EXPECT_TRUE(
      std::isnan(FitDurations(DurationModel::kStartAndScale, {{"a", 10.0, 14.0, 1.0}}).At(1.0)));
}

TEST(FitDurationsTest, NumbersThatMadeTheRowsAreFound) {
  for (int seed = 0; seed < kNumCases; ++seed) {
    base::Rng rng(seed);
    const double start = rng.Uniform(0.0, 5.0), scale = rng.Uniform(0.5, 2.0);
    DurationRows rows;
    for (int i = 0; i < 6; ++i) {
      const double played = rng.Uniform(5.0, 30.0);
      rows.push_back({std::to_string(i / 2), played, start + scale * played, 1.0});
    }
    const DurationFit fit = FitDurations(DurationModel::kStartAndScale, rows);
    EXPECT_NEAR(fit.start_time, start, 1e-8);
    EXPECT_NEAR(fit.time_scale, scale, 1e-8);
  }
}

DurationPredictor Starting(DurationRows rows) {
  return {"scene", DurationModel::kStartTime, std::move(rows)};
}

TEST(PredictLeftOutTest, ARouteIsPredictedByNumbersOfTheOthers) {
  // Without a: b and c start 2 and 4 s late, 3 s; without b 2.5 s; without c 1.5 s.
  const auto predictions = PredictLeftOut(
      {Starting({{"a", 10.0, 11.0, 1.0}, {"b", 10.0, 12.0, 1.0}, {"c", 10.0, 14.0, 1.0}})});
  EXPECT_THAT(predictions.predicted, testing::ElementsAre(13.0, 12.5, 11.5));
  EXPECT_DOUBLE_EQ(predictions.mean_error, (2.0 + 0.5 + 2.5) / 3.0);
  EXPECT_DOUBLE_EQ(predictions.largest_error, 2.5);
  EXPECT_DOUBLE_EQ(predictions.FoldOf("c").fit.start_time, 1.5);
}

TEST(PredictLeftOutTest, RowsOfOneRouteAreLeftOutTogether) {
  const auto predictions = PredictLeftOut(
      {Starting({{"a", 10.0, 19.0, 1.0}, {"a", 20.0, 29.0, 1.0}, {"b", 10.0, 11.0, 1.0}})});
  EXPECT_THAT(predictions.predicted, testing::ElementsAre(11.0, 21.0, 19.0));
  EXPECT_DOUBLE_EQ(predictions.error.estimate, 8.0) << "two routes, each off by 8 s";
}

TEST(PredictLeftOutTest, WhatWasMeasuredOfARouteDoesNotChangeItsPrediction) {
  for (int seed = 0; seed < kNumCases; ++seed) {
    base::Rng rng(seed);
    std::vector<DurationPredictor> predictors(2);
    for (int i = 0; i < 8; ++i) {
      const double played = rng.Uniform(5.0, 30.0), measured = rng.Uniform(5.0, 30.0);
      predictors[0].rows.push_back({std::to_string(i / 2), played, measured, 1.0});
      predictors[1].rows.push_back({std::to_string(i / 2), rng.Uniform(5.0, 30.0), measured, 1.0});
    }
    predictors[0].model = DurationModel::kStartTime;
    predictors[1].model = DurationModel::kStartAndScale;
    const auto before = PredictLeftOut(predictors);
    for (DurationPredictor& predictor : predictors) {
      predictor.rows[0].measured += 50.0;
      predictor.rows[1].measured -= 20.0;
    }
    const auto after = PredictLeftOut(predictors);
    EXPECT_EQ(after.predicted[0], before.predicted[0]);
    EXPECT_EQ(after.predicted[1], before.predicted[1]);
    EXPECT_NE(after.predicted[2], before.predicted[2]);
  }
}

TEST(PredictLeftOutTest, TheOneThatPredictsTheOtherRoutesIsChosen) {
  const DurationRows wrong{
      {"a", 1.0, 12.0, 1.0}, {"b", 9.0, 13.0, 1.0}, {"c", 2.0, 14.0, 1.0}, {"d", 5.0, 15.0, 1.0}};
  const DurationRows right{{"a", 10.0, 12.0, 1.0},
                           {"b", 11.0, 13.0, 1.0},
                           {"c", 12.0, 14.0, 1.0},
                           {"d", 13.0, 15.0, 1.0}};
  const auto predictions = PredictLeftOut({Starting(wrong), Starting(right)});
  EXPECT_NEAR(predictions.mean_error, 0.0, 1e-12);
  for (const DurationFold& fold : predictions.folds) EXPECT_EQ(fold.predictor, 1u);
}

/// Two routes there and back with one motion set, nothing else.
DurationsConfig ThereAndBack() {
  DurationsConfig durations;
  durations.rows = {{kDrive, "fast", "a", "b", {10.0, 0.1}, {12.0, 0.2}},
                    {kDrive, "fast", "b", "a", {20.0, 0.1}, {23.0, 0.2}}};
  return durations;
}

TEST(DurationsTest, BothReadingsStandInEveryTableAndTheWorseOneCounts) {
  const Findings findings =
      SumUpDurations(ThereAndBack(), {{{Lasting(18.0), Lasting(20.0)}, {Lasting(13.0)}}});
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_fast_a_b"), 19.0);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "sigma_fast_a_b"), 1.0);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_fast_b_a"), 13.0);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_error_simulated_from_to"), 8.0);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_error_simulated_to_from"), 2.0);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_error_real_from_to"), 8.5);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_error_real_to_from"), 2.5);
  // With two routes nothing can be chosen but what was played.
  EXPECT_DOUBLE_EQ(ValueOf(findings, "predicted_error_to_from"), 2.5);
  EXPECT_DOUBLE_EQ(ValueOf(findings, "predicted_error_worse"), 8.5);
  EXPECT_EQ(findings.tables[1].rows[2],
            (std::vector<std::string>{"drives", "scene", "real, 6.2", "8.50", "10.00", "2.50",
                                      "4.00", "8.50"}));
}

TEST(DurationsTest, SlowerRoutesAreThoseOfTheSecondMotionSet) {
  DurationsConfig durations = ThereAndBack();
  durations.rows.push_back({kDrive, "slow", "a", "b", {}, {}});
  durations.rows.push_back({kDrive, "slow", "b", "a", {}, {}});
  const Findings findings = SumUpDurations(
      durations, {{{Lasting(11.0)}, {Lasting(13.0)}, {Lasting(17.0)}, {Lasting(12.0)}}});
  EXPECT_EQ(ValueOf(findings, "slower_routes"), 1.0);
  EXPECT_EQ(ValueOf(findings, "failed"), 0.0);
}

TEST(DurationsTest, AnActionThatNeverSucceedsIsNoNumberAndStaysOne) {
  RolloutResult failed = Lasting(10.0);
  failed.action_finished = false;
  const Findings findings = SumUpDurations(ThereAndBack(), {{{failed}, {Lasting(20.0)}}});
  EXPECT_EQ(ValueOf(findings, "failed"), 1.0);
  EXPECT_TRUE(std::isnan(ValueOf(findings, "mean_fast_a_b")));
  EXPECT_TRUE(std::isnan(ValueOf(findings, "sigma_fast_a_b")));
  EXPECT_TRUE(std::isnan(ValueOf(findings, "mean_error_real_from_to")));
  EXPECT_TRUE(std::isnan(ValueOf(findings, "predicted_error_worse")));
}

TEST(DurationsTest, TorsoAndArmsArePredictedApartFromDrives) {
  DurationsConfig durations = ThereAndBack();
  durations.rows.push_back({"tuck_arms", "", "open", "folded", {}, {8.0, 0.3}});
  durations.rows.push_back({"tuck_arms", "", "folded", "open", {}, {5.0, 0.1}});
  const Findings findings = SumUpDurations(
      durations, {{{Lasting(10.0)}, {Lasting(20.0)}, {Lasting(7.0)}, {Lasting(4.5)}}});
  EXPECT_DOUBLE_EQ(ValueOf(findings, "mean_error_arms_real_from_to"), 0.75);
  // 7.0 + 0.5 against 8.0, 4.5 + 1.0 against 5.0.
  EXPECT_DOUBLE_EQ(ValueOf(findings, "predicted_error_arms_from_to"), 0.5);
  // 4.5 + (5 - 7) against 8.0, 7.0 + (8 - 4.5) against 5.0.
  EXPECT_DOUBLE_EQ(ValueOf(findings, "predicted_error_arms_to_from"), 5.5);
  EXPECT_EQ(findings.tables.back().rows[1][3], "7.50 ± 0.10") << "noise of the other direction";
}

TEST(DurationsTest, NamesOfMeasuresDoNotDependOnWhatWasPlayed) {
  const DurationsConfig durations = ThereAndBack();
  const auto nothing = SumUpDurations(durations, NothingPlayed(durations)).measures;
  const auto played = SumUpDurations(durations, {{{Lasting(18.0)}, {Lasting(13.0)}}}).measures;
  ASSERT_EQ(nothing.size(), played.size());
  for (std::size_t i = 0; i < played.size(); ++i) EXPECT_EQ(nothing[i].name, played[i].name);
}

}  // namespace
}  // namespace hires::lab::experiment_durations_test
