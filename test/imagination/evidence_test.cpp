#include "hires/imagination/evidence.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "imagination/rollout_examples.h"

namespace hires::imagination::evidence_test {
namespace {

using Code = base::FailureCode;
using test_support::Fall;
using test_support::NoPath;
using test_support::Success;
using test_support::Times;
using test_support::operator+;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(ConfidenceTest, EquationGivesTheWorkedExamples) {
  EXPECT_DOUBLE_EQ(Confidence({640, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(Confidence({628, 12, 0}), 640.0 / 748.0);
  EXPECT_NEAR(Confidence({628, 12, 0}), 0.856, 5e-4);
  EXPECT_NEAR(Confidence({639, 0, 1}), 0.866, 5e-4);
  EXPECT_NEAR(Confidence({711, 12, 0}), 0.87, 5e-3);
  EXPECT_DOUBLE_EQ(Confidence({0, 0, 7}), 0.01);
}

TEST(ConfidenceTest, TotalsOfTheToppleExperimentGiveThePrintedValues) {  // table 6.5
  EXPECT_NEAR(Confidence({165906, 12735, 413}), 0.535, 5e-4);
  EXPECT_NEAR(Confidence({165596, 6031, 90}), 0.731, 5e-4);
}

TEST(ConfidenceTest, NoSampleIsNoConfidence) { EXPECT_EQ(Confidence({}), 0.0); }

TEST(ConfidenceTest, CoefficientsAreTaken) {
  EXPECT_DOUBLE_EQ(Confidence({1, 1, 1}, {4.0, 2.0, 1.0}), 3.0 / 7.0);
}

TEST(FailureOfTest, SuccessHasNone) { EXPECT_FALSE(FailureOf(Success())); }

TEST(FailureOfTest, OwnFailureIsKept) { EXPECT_EQ(FailureOf(NoPath()), Code::kNoPath); }

TEST(FailureOfTest, ASuccessThatIsNoneGetsAFailure) {
  RolloutResult unfinished = Success();
  unfinished.action_finished = false;
  EXPECT_EQ(FailureOf(unfinished), Code::kUnfinished);
  RolloutResult fallen = Success();
  fallen.falls = 1;
  EXPECT_EQ(FailureOf(fallen), Code::kObjectFell);
  RolloutResult unseen = Success();
  unseen.counts = {};
  EXPECT_EQ(FailureOf(unseen), Code::kNoSamples);
}

TEST(FailureOfTest, AFailureWithoutACodeIsNamed) {
  RolloutResult late;
  late.outcome = Outcome::kTimedOut;
  EXPECT_EQ(FailureOf(late), Code::kTimedOut);
  RolloutResult silent = Success();
  silent.outcome = Outcome::kFailed;
  EXPECT_EQ(FailureOf(silent), Code::kOther);
}

TEST(DefectTest, SoundResultHasNone) {
  EXPECT_EQ(Defect(Success()), "");
  EXPECT_EQ(Defect(NoPath()), "");
}

TEST(DefectTest, NumbersThatAreNoneAreNamed) {
  RolloutResult result = Success();
  result.duration = std::nan("");
  EXPECT_THAT(Defect(result), HasSubstr("duration is nan s, wanted"));
  result = Success();
  result.max_tilt = -0.1;
  EXPECT_THAT(Defect(result), HasSubstr("max_tilt is -0.1 rad"));
  result = Success();
  result.duration = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Defect(result), HasSubstr("duration is inf"));
  result = Success();
  result.counts.shaking = -3;
  EXPECT_THAT(Defect(result), HasSubstr("shaking -3"));
  result = Success();
  result.simulated = std::nan("");
  EXPECT_THAT(Defect(result), HasSubstr("simulated is nan s"));
  result = Success();
  result.final_robot.X_MB.yaw = std::nan("");
  EXPECT_THAT(Defect(result), HasSubstr("robot's final pose"));
  result = Success();
  result.final_world.objects.resize(1);
  result.final_world.objects[0].name = "mug1";
  result.final_world.objects[0].X_MO.translation.x() = std::nan("");
  EXPECT_THAT(Defect(result), HasSubstr("final pose of mug1"));
}

TEST(DefectTest, AReachIsEverythingOrDiscs) {
  RolloutResult result = Success();
  result.reach.discs.push_back({{1.0, 2.0}, 0.5});
  EXPECT_THAT(Defect(result), HasSubstr("everything and on discs"));
  result.reach.is_everything = false;
  EXPECT_EQ(Defect(result), "");
  result.reach.discs[0].radius = -0.5;
  EXPECT_THAT(Defect(result), HasSubstr("-0.5 m around (1, 2)"));
  result.reach.discs.clear();
  EXPECT_THAT(Defect(result), HasSubstr("depends on nothing"));
}

TEST(SumUpTest, NothingGivesNothing) {
  const Evidence evidence = SumUp({});
  EXPECT_EQ(evidence.num_rollouts, 0);
  EXPECT_EQ(evidence.confidence_mean, 0.0);
  EXPECT_EQ(evidence.success.upper, 1.0);
  EXPECT_EQ(evidence.median_rollout, -1);
}

TEST(SumUpTest, MixedRolloutsAreCountedByHand) {
  const Evidence evidence = SumUp({Success(30.0, 12), Fall(20.0, 1), NoPath(), Success(40.0)});
  EXPECT_EQ(evidence.num_rollouts, 4);
  EXPECT_DOUBLE_EQ(evidence.success.share, 0.5);
  EXPECT_DOUBLE_EQ(evidence.fall_share, 0.25);
  EXPECT_DOUBLE_EQ(evidence.action_failed_share, 0.25);
  EXPECT_EQ(evidence.falls, 1);
  EXPECT_EQ(evidence.counts, (OutcomeCounts{628 + 639 + 20 + 640, 12, 1}));
  EXPECT_DOUBLE_EQ(evidence.confidence_mean, (640.0 / 748.0 + 640.0 / 739.0 + 0.0 + 1.0) / 4.0);
  EXPECT_DOUBLE_EQ(evidence.confidence_pooled, 1940.0 / (1927.0 + 120.0 + 100.0));
  EXPECT_THAT(evidence.failures, ElementsAre(Pair(base::Failure(Code::kObjectFell), 1),
                                             Pair(base::Failure(Code::kNoPath), 1)));
}

TEST(SumUpTest, DurationsAreThoseOfFinishedActionsOnly) {
  const Evidence evidence = SumUp({Success(30.0), NoPath(), Fall(20.0), Success(40.0)});
  EXPECT_DOUBLE_EQ(evidence.duration.mean, 30.0);
  EXPECT_DOUBLE_EQ(evidence.duration.sd, std::sqrt(200.0 / 3.0));
  EXPECT_EQ(evidence.duration.p50, 30.0);
  EXPECT_EQ(evidence.duration.p95, 40.0);
  EXPECT_THAT(evidence.durations, ElementsAre(20.0, 30.0, 40.0));
  EXPECT_EQ(evidence.median_rollout, 0);
}

TEST(QuantileTest, IsTheSmallestValueWithThatShareAtOrBelowIt) {
  EXPECT_EQ(Quantile({1.0, 2.0, 3.0, 4.0}, 25), 1.0);
  EXPECT_EQ(Quantile({1.0, 2.0, 3.0, 4.0}, 26), 2.0);
  EXPECT_EQ(Quantile({1.0, 2.0, 3.0, 4.0}, 0), 1.0);
  EXPECT_EQ(Quantile({1.0, 2.0, 3.0, 4.0}, 100), 4.0);
  EXPECT_THROW(Quantile({}, 50), std::logic_error);
}

TEST(DefectOfTest, WhatIsNoListOfDurationsIsNamed) {
  const auto defect = [](std::vector<double> durations) {
    Evidence evidence = SumUp({Success(1.0), Success(2.0)});
    evidence.durations = std::move(durations);
    return DefectOf(evidence);
  };
  EXPECT_EQ(defect({}), "");
  EXPECT_EQ(defect({1.0, 1.0}), "");
  EXPECT_THAT(defect({2.0, 1.0}), HasSubstr("ascending"));
  EXPECT_THAT(defect({1.0, std::nan("")}), HasSubstr("finite"));
  EXPECT_EQ(defect({1.0, 2.0, 3.0}), "there are 3 durations of 2 rollouts");
}

TEST(DefectOfTest, WhatIsNoListOfTiltsIsNamed) {
  Evidence evidence = SumUp({Success(1.0), Success(2.0)});
  EXPECT_EQ(DefectOf(evidence), "");
  evidence.max_tilts = {0.2, 0.1};
  EXPECT_EQ(DefectOf(evidence), "tilts are not in ascending order");
}

TEST(SumUpTest, TiltsAreThoseOfRolloutsWithSamplesInAscendingOrder) {
  RolloutResult steep = Success(1.0), flat = Success(2.0), unwatched = Success(3.0);
  steep.max_tilt = 0.5;
  flat.max_tilt = 0.125;
  unwatched.counts = {};
  const Evidence evidence = SumUp({steep, unwatched, flat});
  EXPECT_THAT(evidence.max_tilts, ElementsAre(0.125, 0.5));
}

TEST(SumUpTest, QuantilesAreValuesThatOccurred) {
  std::vector<RolloutResult> results;
  for (int i = 100; i >= 1; --i) results.push_back(Success(i));
  const Evidence evidence = SumUp(results);
  EXPECT_EQ(evidence.duration.p50, 50.0);  // the lower one of 50 and 51
  EXPECT_EQ(evidence.duration.p95, 95.0);
  EXPECT_EQ(results[evidence.median_rollout].duration, 50.0);
}

TEST(SumUpTest, MedianRolloutIsTheFirstOfEquals) {
  const Evidence evidence = SumUp({NoPath(), Success(7.0), Success(7.0), Success(7.0)});
  EXPECT_EQ(evidence.median_rollout, 1);
}

TEST(SumUpTest, TiltQuantilesLeaveOutRolloutsWithoutSamples) {
  RolloutResult missing;
  missing.failure = Code::kObjectNotSeen;
  const Evidence evidence = SumUp({missing, Fall(), missing});
  EXPECT_EQ(evidence.max_tilt.p50, 1.57);
  EXPECT_EQ(evidence.max_tilt.p95, 1.57);
}

TEST(SumUpTest, MissingObjectIsAFailureAndNeverAConfidence) {
  RolloutResult missing = Success();
  missing.counts = {};
  const Evidence evidence = SumUp(Times(16, missing));
  EXPECT_EQ(evidence.confidence_mean, 0.0);
  EXPECT_EQ(evidence.confidence_pooled, 0.0);
  EXPECT_EQ(evidence.success.share, 0.0);
  EXPECT_EQ(evidence.action_failed_share, 1.0);
  EXPECT_EQ(evidence.median_rollout, -1);
  EXPECT_THAT(evidence.failures, ElementsAre(Pair(base::Failure(Code::kNoSamples), 16)));
}

TEST(SumUpTest, PooledConfidenceVanishesWhenMostActionsFailed) {
  EXPECT_GT(SumUp(Times(2, Success()) + Times(2, NoPath())).confidence_pooled, 0.99);
  EXPECT_EQ(SumUp(Times(2, Success()) + Times(3, NoPath())).confidence_pooled, 0.0);
}

TEST(SumUpTest, PrefixIsTheSameAsAShorterList) {
  const auto results = Times(3, Success(20.0, 4)) + Times(2, Fall(25.0));
  const Evidence of_prefix = SumUp(results, 4);
  const Evidence of_list = SumUp(Times(3, Success(20.0, 4)) + Times(1, Fall(25.0)));
  EXPECT_EQ(of_prefix.num_rollouts, 4);
  EXPECT_EQ(of_prefix.confidence_mean, of_list.confidence_mean);
  EXPECT_EQ(of_prefix.duration.sd, of_list.duration.sd);
  EXPECT_EQ(of_prefix.failures, of_list.failures);
  EXPECT_THROW(SumUp(results, 6), std::logic_error);
  EXPECT_THROW(SumUp(results, -1), std::logic_error);
}

TEST(SumUpTest, OrderOfRolloutsChangesNoCountAndNoQuantile) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(11).Fork(seed);
    auto results = test_support::InventAll({0.3, 0.1, 30.0, 20}, rng, 1 + rng.Index(40));
    const Evidence forward = SumUp(results);
    std::reverse(results.begin(), results.end());
    const Evidence backward = SumUp(results);
    EXPECT_EQ(forward.counts, backward.counts);
    EXPECT_EQ(forward.failures, backward.failures);
    EXPECT_EQ(forward.success.lower, backward.success.lower);
    EXPECT_EQ(forward.duration.p50, backward.duration.p50);
    EXPECT_EQ(forward.max_tilt.p95, backward.max_tilt.p95);
    EXPECT_NEAR(forward.confidence_mean, backward.confidence_mean, 1e-12);
  }
}

TEST(DefectTest, SamplesOfNothingAreNone) {
  RolloutResult result = test_support::Success();
  result.nothing_watched = true;
  EXPECT_EQ(Defect(result), "nothing was watched, but there are 640 samples");
  result.counts = {};
  EXPECT_EQ(Defect(result), "");
}

TEST(SumUpTest, WithNothingToWatchSuccessIsTheConfidence) {
  RolloutResult good = test_support::Success();
  good.nothing_watched = true;
  good.counts = {};
  RolloutResult bad = test_support::NoPath();
  bad.nothing_watched = true;
  bad.counts = {};
  const Evidence evidence = SumUp({good, good, good, bad});
  EXPECT_EQ(evidence.confidence_pooled, 1.0);
  EXPECT_EQ(evidence.confidence_mean, 0.75);
  EXPECT_EQ(evidence.success.share, 0.75);
  EXPECT_EQ(evidence.action_failed_share, 0.25);
  EXPECT_EQ(SumUp({good, bad, bad}).confidence_pooled, 0.0);
  EXPECT_FALSE(FailureOf(good));
}

TEST(SumUpTest, NamesTheWorstAndTheFirstFailedRollout) {
  auto results = Times(2, Success()) + Times(1, NoPath()) + Times(2, Fall());
  results[1].max_tilt = 2.0;  // leaned most of all, and did not fall
  const Evidence evidence = SumUp(results);
  EXPECT_EQ(evidence.first_failed, 2);
  EXPECT_EQ(evidence.worst_rollout, 3);
  EXPECT_EQ(SumUp(results, 2).worst_rollout, 1);
  EXPECT_EQ(SumUp(results, 2).first_failed, -1);
  EXPECT_EQ(SumUp(results, 0).worst_rollout, -1);
}

TEST(SumUpTest, CountsWhatBeganIt) {
  auto results = Times(4, Success());
  results[1].first_cause = results[3].first_cause = "late_command";
  results[2].first_cause = "turning";
  EXPECT_THAT(SumUp(results).first_causes,
              ElementsAre(Pair("late_command", 2), Pair("turning", 1)));
}

}  // namespace
}  // namespace hires::imagination::evidence_test
