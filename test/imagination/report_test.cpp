#include "hires/imagination/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "imagination/rollout_examples.h"

namespace hires::imagination::report_test {
namespace {

using test_support::Fall;
using test_support::NoPath;
using test_support::Success;
using test_support::Times;
using test_support::operator+;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<base::ActionCall> kActions{{"move_base_param", {"east", "fast"}},
                                             {"move_base_param", {"east", "slow"}}};

SchedulerParams AllOf4() {
  SchedulerParams params;
  params.rollouts = 4;
  params.first_look = 4;
  params.early_stop = false;
  params.deadline = 10.0;
  params.worker_wait = 1.0;
  params.criteria.min_success = 0.3;  // four flawless rollouts reach it: 40 % at least
  return params;
}

/// One worker plays what it is given from lists of results, for at most `limit` rollouts.
void PlayAll(Scheduler* scheduler, const std::vector<std::vector<RolloutResult>>& results,
             int limit = 1000) {
  std::vector<Command> commands = scheduler->Handle(WorkerJoined{0}, 0.1);
  while (!commands.empty() && !scheduler->finished()) {
    const auto* assign = std::get_if<Assign>(&commands.front());
    if (assign == nullptr) return;
    for (int i = assign->first_index; i < assign->first_index + assign->count; ++i) {
      if (limit-- <= 0) return;
      scheduler->Handle(RolloutFinished{0, assign->assignment, assign->alternative, i,
                                        results[assign->alternative][i]},
                        0.2);
    }
    commands = scheduler->Handle(AssignmentFinished{0, assign->assignment}, 0.3);
  }
}

/// Where a rollout ended: its index and alternative can be told from the pose.
RolloutResult EndingAt(RolloutResult result, double x) {
  result.simulated = 10.0;
  result.final_robot.X_MB.x = x;
  result.final_world.objects.resize(1);
  return result;
}

Report Make(const Scheduler& scheduler) { return MakeReport(scheduler, kActions, 7, 1.5); }

/// Three workers play what they are given, and who got work last tells first, the last rollout
/// first.
void PlayBackwards(Scheduler* scheduler, const std::vector<std::vector<RolloutResult>>& results) {
  std::vector<Assign> open;
  const auto collect = [&](const std::vector<Command>& commands) {
    for (const Command& command : commands) {
      if (const auto* assign = std::get_if<Assign>(&command)) open.push_back(*assign);
    }
  };
  for (const int worker : {0, 1, 2}) collect(scheduler->Handle(WorkerJoined{worker}, 0.1));
  while (!open.empty() && !scheduler->finished()) {
    const Assign work = open.back();
    open.pop_back();
    for (int i = work.first_index + work.count - 1; i >= work.first_index; --i) {
      scheduler->Handle(RolloutFinished{work.worker, work.assignment, work.alternative, i,
                                        results[work.alternative][i]},
                        0.2);
    }
    collect(scheduler->Handle(AssignmentFinished{work.worker, work.assignment}, 0.3));
  }
}

TEST(ReportTest, AnyOrderOfArrivalGivesTheSameReasonsToTheBit) {
  SchedulerParams params = AllOf4();
  params.rollouts = 32;
  params.criteria = {
      RankingRule::kCost,
      0.5,
      {{{base::FailureCode::kObjectFell, 600.0}, {base::FailureCode::kOther, 50.0}}, 300.0}};
  std::vector<std::vector<RolloutResult>> results(2);
  for (int i = 0; i < 32; ++i) {
    results[0].push_back(i % 9 == 4 ? Fall(20.0 + 0.1 * i) : Success(20.0 + 0.3 * i));
    results[1].push_back(i % 20 == 7 ? NoPath() : Success(31.0 + 0.7 * i));
  }
  Scheduler forwards(params, 2, 0.0), backwards(params, 2, 0.0);
  PlayAll(&forwards, results);
  PlayBackwards(&backwards, results);
  const Report one = Make(forwards), other = Make(backwards);
  ASSERT_TRUE(one.by_cost && one.by_cost->next && one.by_cost->turning);
  EXPECT_EQ(one.why, other.why);
  EXPECT_EQ(one.by_cost->prices, other.by_cost->prices);
  EXPECT_EQ(one.by_cost->next->probability, other.by_cost->next->probability);
  EXPECT_EQ(one.by_cost->next->failures_more_upper, other.by_cost->next->failures_more_upper);
  EXPECT_EQ(one.by_cost->next->time_saved, other.by_cost->next->time_saved);
  EXPECT_EQ(one.by_cost->turning->price, other.by_cost->turning->price);
  EXPECT_EQ(one.recommended, 0);
  EXPECT_EQ(one.by_cost->next->other, 1) << "a place of the ranking";
  EXPECT_EQ(one.ranking[0].alternative, 1);
  EXPECT_EQ(one.by_cost->turning->other, 1);
}

TEST(ReportTest, WhatIsKeptIsToldApartFromWhatWasPlayed) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  PlayAll(&scheduler,
          {Times(4, EndingAt(Success(40.0), 1.0)), Times(4, EndingAt(Success(42.0), 2.0))});
  const Report report = MakeReport(scheduler, kActions, 7, 1.5, {{0, 3}, {1, 0}, {1, 4}});
  EXPECT_EQ(report.kept.rollouts, 2) << "the fifth is not behind the ranking";
  EXPECT_EQ(report.simulated_seconds, 80.0);
  EXPECT_EQ(report.played_seconds(), 60.0);
}

TEST(ReportTest, RanksTheBestFirstAndSaysWhy) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  const std::vector<RolloutResult> slow{EndingAt(Success(40.0), 1.0), EndingAt(Success(43.0), 2.0),
                                        EndingAt(Success(41.0), 3.0), EndingAt(Success(42.0), 4.0)};
  PlayAll(&scheduler, {Times(4, EndingAt(Fall(), 9.0)), slow});
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kRanked);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.recommended, 0);
  ASSERT_THAT(report.ranking, SizeIs(2));
  EXPECT_EQ(report.ranking[0].action.arguments[1], "slow");
  EXPECT_EQ(report.ranking[1].action.arguments[1], "fast");
  EXPECT_EQ(report.ranking[0].evidence.success.num_rollouts, 4);
  EXPECT_EQ(report.seed, 7u);
  EXPECT_EQ(report.wall_seconds, 1.5);
  EXPECT_NEAR(report.simulated_seconds, 80.0, 1e-12);
  EXPECT_THAT(report.why, HasSubstr("slow"));
}

TEST(ReportTest, FinalStatesAreThoseOfTheMedianRollout) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  const std::vector<RolloutResult> slow{EndingAt(Success(40.0), 1.0), EndingAt(Success(43.0), 2.0),
                                        EndingAt(Success(41.0), 3.0), EndingAt(Success(42.0), 4.0)};
  PlayAll(&scheduler, {Times(4, NoPath()), slow});
  const Report report = Make(scheduler);
  ASSERT_THAT(report.ranking, SizeIs(2));
  EXPECT_EQ(report.ranking[0].final_robot.X_MB.x, 3.0);  // 41 s
  EXPECT_THAT(report.ranking[0].final_world.objects, SizeIs(1));
  EXPECT_THAT(report.ranking[1].final_world.objects, IsEmpty()) << "none finished";
  const auto without = PredictionsOf(scheduler, scheduler.result()->ranking, kActions, false);
  ASSERT_THAT(without, SizeIs(2));
  EXPECT_THAT(without[0].final_world.objects, IsEmpty());
}

TEST(ReportTest, AllFailingIsSaidAndNothingRecommended) {
  SchedulerParams params = AllOf4();
  params.criteria.min_success = 0.7;
  Scheduler scheduler(params, 2, 0.0);
  PlayAll(&scheduler, {Times(4, NoPath()), Times(4, NoPath())});
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kAllFailed);
  EXPECT_EQ(report.recommended, -1);
  EXPECT_THAT(report.ranking, SizeIs(2));
  EXPECT_THAT(report.why, HasSubstr("all alternatives fail"));
}

TEST(ReportTest, TooFewRolloutsAreUndecidedAndSayHowManyWouldDecide) {
  SchedulerParams params = AllOf4();
  params.criteria.min_success = 0.5;
  Scheduler scheduler(params, 2, 0.0);
  PlayAll(&scheduler, {Times(4, Success()), Times(4, Fall())});
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kUndecided);
  EXPECT_EQ(report.recommended, -1);
  EXPECT_THAT(report.ranking, SizeIs(2));
  EXPECT_THAT(report.why, HasSubstr("about 6 rollouts decide"));
}

TEST(ReportTest, WithoutWorkersThereIsNoNumber) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  scheduler.Tick(1.5);
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kNoWorker);
  EXPECT_THAT(report.ranking, IsEmpty());
  EXPECT_EQ(report.recommended, -1);
  EXPECT_EQ(report.simulated_seconds, 0.0);
  EXPECT_THAT(report.why, HasSubstr("no worker is there to imagine it"));
}

TEST(ReportTest, UnusableWorkersAreNamed) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  const auto commands = scheduler.Handle(WorkerJoined{3}, 0.1);
  const int assignment = std::get<Assign>(commands.front()).assignment;
  scheduler.Handle(AssignmentFailed{3, assignment, "world differs", true}, 0.2);
  scheduler.Tick(5.0);
  ASSERT_TRUE(scheduler.finished());
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kNoWorker);
  EXPECT_THAT(report.why, HasSubstr("world differs"));
}

TEST(ReportTest, ADeadlineBeforeAnythingWasComparedIsSaid) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  PlayAll(&scheduler, {Times(4, Success()), Times(4, Success())}, 0);
  scheduler.Tick(11.0);
  ASSERT_TRUE(scheduler.finished());
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kNothingFinished);
  EXPECT_THAT(report.ranking, IsEmpty());
  EXPECT_THAT(report.why, HasSubstr("deadline"));
}

TEST(ReportTest, CutShortItCountsWhatTheRankingRestsOn) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  PlayAll(&scheduler, {Times(4, EndingAt(Success(), 1.0)), Times(4, EndingAt(Success(), 1.0))}, 5);
  scheduler.Tick(11.0);
  ASSERT_TRUE(scheduler.finished());
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kUndecided);
  EXPECT_FALSE(report.complete);
  const int common = report.ranking.at(0).evidence.num_rollouts;
  EXPECT_GE(common, 1);
  EXPECT_LE(common, 2);
  EXPECT_NEAR(report.simulated_seconds, 2 * common * 10.0, 1e-12);
}

TEST(ReportTest, CancelledIsSaid) {
  Scheduler scheduler(AllOf4(), 2, 0.0);
  scheduler.Cancel(0.5);
  const Report report = Make(scheduler);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kCancelled);
  EXPECT_EQ(report.why, "cancelled");
}

TEST(ReportTest, ThereIsNoReportBeforeTheEnd) {
  const Scheduler scheduler(AllOf4(), 2, 0.0);
  EXPECT_THROW(Make(scheduler), std::logic_error);
}

}  // namespace
}  // namespace hires::imagination::report_test
