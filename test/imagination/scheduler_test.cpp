#include "hires/imagination/scheduler.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "hires/base/error.h"
#include "imagination/rollout_examples.h"
#include "support/log_catcher.h"

namespace hires::imagination::scheduler_test {
namespace {

using test_support::Behaviour;
using test_support::Fall;
using test_support::Invent;
using test_support::InventAll;
using test_support::NoPath;
using test_support::Success;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Rollout `index` of `alternative`.
using Play = std::function<RolloutResult(int alternative, int index)>;

Play PlayInvented(const std::vector<Behaviour>& behaviours, const base::Rng& seed) {
  return [=](int alternative, int index) { return Invent(behaviours[alternative], seed, index); };
}

Play PlaySlowIsBetter() {
  return [](int alternative, int) { return alternative == 0 ? Fall() : Success(); };
}

template <typename T>
std::vector<T> Only(const std::vector<Command>& commands) {
  std::vector<T> found;
  for (const Command& command : commands) {
    if (const T* wanted = std::get_if<T>(&command)) found.push_back(*wanted);
  }
  return found;
}

/// Keeps the log quiet about the faults that a test makes on purpose.
using QuietLog = hires::test_support::LogCatcher;

/// Hands over all results of an assignment and its end; what the scheduler says to the end.
std::vector<Command> Complete(const Assign& work, const Play& play, double now,
                              Scheduler* scheduler) {
  for (int i = work.first_index; i < work.first_index + work.count; ++i) {
    scheduler->Handle(RolloutFinished{work.worker, work.assignment, work.alternative, i,
                                      play(work.alternative, i)},
                      now);
  }
  return scheduler->Handle(AssignmentFinished{work.worker, work.assignment}, now);
}

/// One worker plays until the scheduler has finished (or 1000 rollouts); each assignment takes a
/// second.
/// @return how many rollouts it played.
int PlayAlone(const Play& play, Scheduler* scheduler, double now = 0.0) {
  int played = 0;
  auto work = Only<Assign>(scheduler->Handle(WorkerJoined{1}, now));
  while (!scheduler->finished() && !work.empty() && played < 1000) {
    played += work.front().count;
    work = Only<Assign>(Complete(work.front(), play, now += 1.0, scheduler));
  }
  return played;
}

bool IsDecided(const std::vector<std::vector<RolloutResult>>& results, int num_rollouts,
               const SchedulerParams& params) {
  if (params.criteria.rule == RankingRule::kCost) return false;  // as all are played
  std::vector<const std::vector<RolloutResult>*> prefixes;
  for (const auto& of_one : results) prefixes.push_back(&of_one);
  return Decided(prefixes, num_rollouts, params.criteria, params.settle);
}

/// The obvious road: play all of a round in order, then decide.
Ranking Sequentially(const SchedulerParams& params, int num_alternatives, const Play& play) {
  const bool is_adaptive = params.early_stop && params.criteria.rule == RankingRule::kCost;
  const bool is_one = is_adaptive && num_alternatives == 1;
  const int first = params.early_stop
                        ? std::min(params.rollouts, params.first_look * (is_one ? 4 : 1))
                        : params.rollouts;
  std::vector<std::vector<RolloutResult>> results(num_alternatives);
  std::vector<int> counts(num_alternatives, first);
  Ranking ranking;
  while (true) {
    std::vector<RolloutPrefix> request;
    for (int a = 0; a < num_alternatives; ++a) {
      for (int i = results[a].size(); i < counts[a]; ++i) results[a].push_back(play(a, i));
      request.push_back({&results[a], counts[a]});
    }
    const bool is_fixed = first == params.rollouts || (num_alternatives == 1 && !is_adaptive);
    ranking.evidence = SumUpRequest(
        request, is_fixed ? IntervalKind::kClopperPearson : IntervalKind::kConfidenceSequence,
        params.criteria.prices);
    const std::vector<int> before = counts;
    if (is_adaptive) {
      const auto more = NextRound(ranking.evidence, params.criteria, params.rollouts);
      for (int a = 0; a < num_alternatives; ++a) counts[a] += more[a];
    } else if (num_alternatives == 1 || !IsDecided(results, counts[0], params)) {
      counts.assign(counts.size(), NextLook(counts[0], params));
    }
    if (counts == before) break;
  }
  ranking.num_rollouts = *std::min_element(counts.begin(), counts.end());
  ranking.order = Rank(ranking.evidence, params.criteria);
  ranking.recommended = Recommended(ranking.evidence, params.criteria);
  return ranking;
}

void ExpectSameEvidence(const Evidence& a, const Evidence& b) {
  EXPECT_EQ(a.num_rollouts, b.num_rollouts);
  EXPECT_EQ(a.confidence_mean, b.confidence_mean);
  EXPECT_EQ(a.confidence_pooled, b.confidence_pooled);
  EXPECT_EQ(a.success.lower, b.success.lower);
  EXPECT_EQ(a.duration.mean, b.duration.mean);
  EXPECT_EQ(a.duration.sd, b.duration.sd);
  EXPECT_EQ(a.duration.p95, b.duration.p95);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.failures, b.failures);
  EXPECT_EQ(a.median_rollout, b.median_rollout);
}

void ExpectSameRanking(const Ranking& a, const Ranking& b) {
  EXPECT_EQ(a.num_rollouts, b.num_rollouts);
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.recommended, b.recommended);
  ASSERT_EQ(a.evidence.size(), b.evidence.size());
  for (std::size_t i = 0; i < a.evidence.size(); ++i) {
    ExpectSameEvidence(a.evidence[i], b.evidence[i]);
  }
}

// ---------------------------------------------------------------- parameters

TEST(SchedulerParamsTest, DefaultsAreValid) { EXPECT_NO_THROW(CheckParams({})); }

TEST(SchedulerParamsTest, FieldsOutOfRangeAreNamed) {
  const auto message_of = [](const std::function<void(SchedulerParams*)>& spoil) {
    SchedulerParams params;
    spoil(&params);
    try {
      Scheduler(params, 2, 0.0);
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of([](auto* p) { p->rollouts = 0; }),
              HasSubstr("rollouts is 0, wanted between 1 and 100000"));
  EXPECT_THAT(message_of([](auto* p) { p->rollouts = 100001; }), HasSubstr("rollouts is 100001"));
  EXPECT_THAT(message_of([nan](auto* p) { p->deadline = nan; }), HasSubstr("deadline is nan"));
  EXPECT_THAT(message_of([](auto* p) { p->worker_wait = -1.0; }), HasSubstr("worker_wait is -1"));
  EXPECT_THAT(message_of([](auto* p) { p->first_look = 0; }), HasSubstr("first_look is 0"));
  EXPECT_THAT(message_of([](auto* p) { p->batch = 0; }), HasSubstr("batch is 0"));
  EXPECT_THAT(message_of([](auto* p) { p->max_attempts = 0; }), HasSubstr("max_attempts is 0"));
  EXPECT_THAT(message_of([](auto* p) { p->criteria.min_success = 1.0; }),
              HasSubstr("min_success is 1"));
  EXPECT_THAT(message_of([](auto* p) { p->criteria.max_regret = -1.0; }),
              HasSubstr("max_regret is -1, wanted between 0 and 100000"));
  EXPECT_THAT(message_of([](auto* p) { p->criteria.rule = RankingRule::kCost; }),
              HasSubstr("needs prices"));
  EXPECT_THAT(message_of([](auto* p) { p->settle.alpha = 1.0; }), HasSubstr("alpha is 1"));
  EXPECT_THAT(message_of([](auto* p) { p->settle.indifference = 0.0; }),
              HasSubstr("indifference is 0"));
}

const char* const kYaml =
    "{rollouts: 128, deadline: 20.0, worker_wait: 5.0, early_stop: false, ranking: thesis, "
    "min_success: 0.75, first_look: 8, batch: 2, max_attempts: 3, alpha: 0.01, indifference: 0.1, "
    "only_best: true}";

TEST(SchedulerParamsTest, EveryKeyIsRead) {
  const auto params = ReadSchedulerParams(base::ParamReader::FromString(kYaml, "test"));
  EXPECT_EQ(params.rollouts, 128);
  EXPECT_EQ(params.deadline, 20.0);
  EXPECT_EQ(params.worker_wait, 5.0);
  EXPECT_FALSE(params.early_stop);
  EXPECT_EQ(params.criteria.rule, RankingRule::kThesis);
  EXPECT_EQ(params.criteria.min_success, 0.75);
  EXPECT_EQ(params.first_look, 8);
  EXPECT_EQ(params.batch, 2);
  EXPECT_EQ(params.max_attempts, 3);
  EXPECT_EQ(params.settle.alpha, 0.01);
  EXPECT_EQ(params.settle.indifference, 0.1);
  EXPECT_TRUE(params.settle.only_best);
}

TEST(SchedulerParamsTest, KeysThatCostDoesNotReadAreAcceptedWithAWarning) {
  std::string yaml = kYaml;
  yaml.replace(yaml.find("thesis"), 6, "cost");
  const QuietLog log;
  const auto params = ReadSchedulerParams(base::ParamReader::FromString(yaml, "test"));
  EXPECT_EQ(params.settle.alpha, 0.01) << "for requests by risk";
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("alpha does not affect `ranking: cost`"),
                                     HasSubstr("indifference"), HasSubstr("only_best")));
}

TEST(SchedulerParamsTest, KeysOfOtherRankingsAndMaxRegretMayBeLeftOut) {
  std::string yaml = kYaml;
  yaml.replace(yaml.find(", alpha"), std::string::npos, ", max_regret: 0.5}");
  const auto params = ReadSchedulerParams(base::ParamReader::FromString(yaml, "test"));
  EXPECT_EQ(params.criteria.max_regret, 0.5);
  EXPECT_EQ(params.settle.alpha, 0.05);
}

TEST(SchedulerParamsTest, WrongYamlIsRefused) {
  const auto read = [](const std::string& from, const std::string& to) {
    std::string yaml = kYaml;
    yaml.replace(yaml.find(from), from.size(), to);
    ReadSchedulerParams(base::ParamReader::FromString(yaml, "test"));
  };
  EXPECT_THROW(read("rollouts: 128", "rollouts: 0"), base::ConfigError);
  EXPECT_THROW(read("rollouts: 128, ", ""), base::ConfigError);
  EXPECT_THROW(read("ranking: thesis", "ranking: best"), base::ConfigError);
  EXPECT_THROW(read("batch: 2", "batch: 2, bacth: 2"), base::ConfigError);
  EXPECT_THROW(read("min_success: 0.75", "min_success: 0.0"), base::ConfigError);
  EXPECT_THROW(read("alpha: 0.01", "alpha: 1.5"), base::ConfigError);
}

TEST(SchedulerTest, NoAlternativeIsRefused) {
  EXPECT_THROW(Scheduler({}, 0, 0.0), std::logic_error);
}

// ---------------------------------------------------------------- pure functions

TEST(NextLookTest, DoublesAndEndsAtTheLastRollout) {
  SchedulerParams params;
  params.rollouts = 100;
  EXPECT_EQ(NextLook(0, params), 16);
  EXPECT_EQ(NextLook(15, params), 16);
  EXPECT_EQ(NextLook(16, params), 32);
  EXPECT_EQ(NextLook(63, params), 64);
  EXPECT_EQ(NextLook(64, params), 100);
  EXPECT_EQ(NextLook(100, params), 100);
  params.rollouts = 5;
  EXPECT_EQ(NextLook(0, params), 5);
  params.rollouts = 100000;
  EXPECT_EQ(NextLook(99999, params), 100000);
}

TEST(EstimateTimeLeftTest, GoesOnAtTheSamePace) {
  EXPECT_EQ(EstimateTimeLeft(0, 10, 5.0, std::nullopt), std::nullopt);
  EXPECT_EQ(EstimateTimeLeft(0, 10, 5.0, 7.0), 7.0);
  EXPECT_EQ(EstimateTimeLeft(2, 10, 5.0, std::nullopt), 20.0);
  EXPECT_EQ(EstimateTimeLeft(2, 10, 5.0, 7.0), 7.0);
  EXPECT_EQ(EstimateTimeLeft(2, 10, 5.0, -1.0), 0.0);
  EXPECT_EQ(EstimateTimeLeft(10, 10, 5.0, 7.0), 0.0);
  EXPECT_THROW(EstimateTimeLeft(11, 10, 5.0, 7.0), std::logic_error);
}

// ---------------------------------------------------------------- the plain course

TEST(SchedulerTest, StopsAtTheFirstLookWhereTheRankingIsSettled) {
  Scheduler scheduler({}, 2, 0.0);
  EXPECT_EQ(PlayAlone(PlaySlowIsBetter(), &scheduler), 32);
  ASSERT_TRUE(scheduler.finished());
  const SchedulerResult& result = *scheduler.result();
  EXPECT_EQ(result.outcome, ImaginationOutcome::kRanked);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.ranking.num_rollouts, 16);
  EXPECT_EQ(result.ranking.recommended, 1);
  EXPECT_THAT(result.ranking.order, ElementsAre(1, 0));
}

TEST(SchedulerTest, PlaysAllWithoutEarlyStop) {
  SchedulerParams params;
  params.early_stop = false;
  Scheduler scheduler(params, 2, 0.0);
  EXPECT_EQ(PlayAlone(PlaySlowIsBetter(), &scheduler), 128);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 64);
  EXPECT_TRUE(scheduler.result()->complete);
}

TEST(SchedulerTest, OneAlternativeIsPlayedToTheEnd) {
  Scheduler scheduler({}, 1, 0.0);
  EXPECT_EQ(PlayAlone([](int, int) { return Success(); }, &scheduler), 64);
  EXPECT_EQ(scheduler.result()->ranking.recommended, 0);
}

TEST(SchedulerTest, OneRolloutEachReproducesTheOriginal) {
  SchedulerParams params;
  params.rollouts = 1;
  params.criteria.rule = RankingRule::kThesis;
  Scheduler scheduler(params, 2, 0.0);
  const Play play = [](int alternative, int) {
    return alternative == 0 ? Success(32.01, 12) : Success(45.27);
  };
  EXPECT_EQ(PlayAlone(play, &scheduler), 2);
  EXPECT_EQ(scheduler.result()->ranking.recommended, 1);
  EXPECT_NEAR(scheduler.result()->ranking.evidence[0].confidence_mean, 0.856, 5e-4);
}

TEST(SchedulerTest, AllFailingIsAnOutcomeOfItsOwn) {
  Scheduler scheduler({}, 2, 0.0);
  PlayAlone([](int, int) { return NoPath(); }, &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kAllFailed);
  EXPECT_EQ(scheduler.result()->ranking.recommended, std::nullopt);
  EXPECT_TRUE(scheduler.result()->complete);
}

TEST(SchedulerTest, FirstAssignmentsAreSingleRolloutsOfEachAlternative) {
  Scheduler scheduler({}, 3, 0.0);
  std::vector<int> alternatives;
  for (int worker = 1; worker <= 4; ++worker) {
    const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{worker}, 0.0));
    ASSERT_EQ(work.size(), 1u);
    EXPECT_EQ(work[0].worker, worker);
    EXPECT_EQ(work[0].count, 1);
    alternatives.push_back(work[0].alternative);
  }
  EXPECT_THAT(alternatives, ElementsAre(0, 1, 2, 0));
}

TEST(SchedulerTest, BatchesGrowAndShrinkTowardsTheLook) {
  SchedulerParams params;
  params.early_stop = false;
  Scheduler scheduler(params, 1, 0.0);
  std::vector<int> counts;
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  while (!work.empty()) {
    counts.push_back(work[0].count);
    work = Only<Assign>(Complete(work[0], PlaySlowIsBetter(), 1.0, &scheduler));
  }
  EXPECT_EQ(counts.front(), 1);
  EXPECT_LT(counts.back(), params.batch);
  EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), params.batch);
}

TEST(SchedulerTest, WorkersWithoutWorkBeginTheNextLookAndNoneBeyond) {
  Scheduler scheduler({}, 2, 0.0);
  int last = -1;
  int given = 0;
  for (int worker = 0; worker < 100; ++worker) {
    for (const Assign& work : Only<Assign>(scheduler.Handle(WorkerJoined{worker}, 0.0))) {
      last = std::max(last, work.first_index + work.count - 1);
      given += work.count;
    }
  }
  EXPECT_EQ(given, 64);  // two looks of two alternatives
  EXPECT_EQ(last, 31);
}

TEST(SchedulerTest, EndOfTheRankingCancelsWhatIsUnderWay) {
  Scheduler scheduler({}, 2, 0.0);
  const auto slow_worker = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{2}, 0.0));
  // Worker 2 plays everything but the first rollout, which worker 1 has.
  while (!work.empty()) {
    work = Only<Assign>(Complete(work[0], PlaySlowIsBetter(), 1.0, &scheduler));
  }
  EXPECT_FALSE(scheduler.finished());
  EXPECT_EQ(scheduler.ProgressAt(1.0).done, 63);
  const auto other = Only<Assign>(scheduler.Handle(WorkerJoined{3}, 2.0));
  EXPECT_THAT(other, IsEmpty());  // nothing beyond the next look
  const auto commands =
      scheduler.Handle(RolloutFinished{1, slow_worker[0].assignment, 0, 0, Fall()}, 3.0);
  ASSERT_TRUE(scheduler.finished());
  const auto cancelled = Only<CancelAssignment>(commands);
  ASSERT_EQ(cancelled.size(), 1u);
  EXPECT_EQ(cancelled[0].assignment, slow_worker[0].assignment);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 16);  // the rest is thrown away
  EXPECT_EQ(scheduler.Prefix(1).size(), 16u);
}

TEST(SchedulerTest, NothingMattersAfterTheEnd) {
  Scheduler scheduler({}, 2, 0.0);
  PlayAlone(PlaySlowIsBetter(), &scheduler);
  EXPECT_THAT(scheduler.Handle(WorkerJoined{7}, 99.0), IsEmpty());
  EXPECT_THAT(scheduler.Tick(1e9), IsEmpty());
  EXPECT_THAT(scheduler.Cancel(1e9), IsEmpty());
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kRanked);
  EXPECT_EQ(scheduler.WakeAt(), std::nullopt);
  EXPECT_EQ(scheduler.ProgressAt(1e9).time_left, 0.0);
}

// ---------------------------------------------------------------- good enough

Play Always(const RolloutResult& result) {
  return [=](int, int) { return result; };
}

/// The first `num_success` of each `period` rollouts succeed.
Play SuccessesOf(int num_success, int period) {
  return [=](int, int index) { return index % period < num_success ? Success() : Fall(); };
}

SchedulerParams AtMost(int rollouts, double min_success = 0.5) {
  SchedulerParams params;
  params.rollouts = rollouts;
  params.criteria.min_success = min_success;
  return params;
}

TEST(SchedulerTest, FourGoodRolloutsCutOffAreUndecidedAndNoBan) {
  SchedulerParams params = AtMost(64);
  params.deadline = 4.5;
  Scheduler scheduler(params, 1, 0.0);
  PlayAlone(Always(Success()), &scheduler);  // a rollout a second at first
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kUndecided);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 4);
  EXPECT_EQ(scheduler.result()->ranking.recommended, std::nullopt);
}

TEST(SchedulerTest, OneOfFourHundredIsNotRecommended) {
  Scheduler scheduler(AtMost(400), 1, 0.0);
  PlayAlone(SuccessesOf(1, 400), &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kAllFailed);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 400);
}

TEST(SchedulerTest, AsOftenAsNotIsUndecidedAtTheEnd) {
  Scheduler scheduler(AtMost(64), 1, 0.0);
  PlayAlone(SuccessesOf(1, 2), &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kUndecided);
  EXPECT_TRUE(scheduler.result()->complete);
}

TEST(SchedulerTest, WhatIsWantedDecides) {
  const auto outcome = [](double min_success) {
    Scheduler scheduler(AtMost(64, min_success), 1, 0.0);
    PlayAlone(SuccessesOf(3, 4), &scheduler);  // 62.6 .. 85.0 %
    return scheduler.result()->outcome;
  };
  EXPECT_EQ(outcome(0.6), ImaginationOutcome::kRanked);
  EXPECT_EQ(outcome(0.75), ImaginationOutcome::kUndecided);
  EXPECT_EQ(outcome(0.9), ImaginationOutcome::kAllFailed);
}

TEST(SchedulerTest, AnOrderThatIsSettledDoesNotEndItWhileTheBestIsOpen) {
  // The second is clearly better, but it succeeds half of the time only.
  const Play play = [](int alternative, int index) {
    return alternative == 1 && index % 2 == 0 ? Success() : Fall();
  };
  Scheduler scheduler({}, 2, 0.0);
  EXPECT_EQ(PlayAlone(play, &scheduler), 128);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kUndecided);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 64);
}

TEST(SchedulerTest, ItEndsAtTheFirstLookAtWhichAllFailForCertain) {
  Scheduler scheduler({}, 2, 0.0);
  EXPECT_EQ(PlayAlone(Always(Fall()), &scheduler), 32);  // a tie: the order is not settled
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kAllFailed);
  EXPECT_TRUE(scheduler.result()->complete);
}

TEST(SchedulerTest, IntervalsFitHowTheRolloutsWereStopped) {
  const auto kind = [](SchedulerParams params, int num_alternatives) {
    Scheduler scheduler(params, num_alternatives, 0.0);
    PlayAlone(PlaySlowIsBetter(), &scheduler);
    return scheduler.result()->ranking.evidence[0].success.kind;
  };
  SchedulerParams all;
  all.early_stop = false;
  EXPECT_EQ(kind({}, 2), IntervalKind::kConfidenceSequence);
  EXPECT_EQ(kind(all, 2), IntervalKind::kClopperPearson);
  EXPECT_EQ(kind({}, 1), IntervalKind::kClopperPearson);          // played to the end
  EXPECT_EQ(kind(AtMost(16), 2), IntervalKind::kClopperPearson);  // no look before the last
  all.deadline = 5.0;
  EXPECT_EQ(kind(all, 2), IntervalKind::kConfidenceSequence);
}

TEST(SchedulerTest, ThesisNeedsNoMinimum) {
  SchedulerParams params = AtMost(1, 0.99);
  params.criteria.rule = RankingRule::kThesis;
  Scheduler scheduler(params, 1, 0.0);
  PlayAlone(Always(Fall()), &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kRanked);
}

// ---------------------------------------------------------------- by expected regret

SchedulerParams ByCost(int rollouts = 400) {
  SchedulerParams params;
  params.rollouts = rollouts;
  params.criteria = {
      RankingRule::kCost,
      0.5,
      {{{base::FailureCode::kObjectFell, 600.0}, {base::FailureCode::kOther, 50.0}}, 300.0}};
  return params;
}

/// Flawless ones that take so long [s].
Play Taking(const std::vector<double>& durations) {
  return [=](int alternative, int) { return Success(durations[alternative]); };
}

TEST(SchedulerByCostTest, StopsWhereTheExpectedRegretIsSmall) {
  Scheduler scheduler(ByCost(), 2, 0.0);
  PlayAlone(Taking({10.0, 200.0}), &scheduler);
  const SchedulerResult& result = *scheduler.result();
  EXPECT_EQ(result.outcome, ImaginationOutcome::kRanked);
  EXPECT_EQ(result.ranking.recommended, 0);
  EXPECT_TRUE(result.complete);
  EXPECT_LT(result.ranking.evidence[0].num_rollouts, 100);
  EXPECT_LE(CostOddsOf(result.ranking.evidence, scheduler.params().criteria, 0).regret, 2.0);
}

TEST(SchedulerByCostTest, NearTieIsClose) {
  Scheduler scheduler(ByCost(), 2, 0.0);
  PlayAlone(Taking({10.0, 10.5}), &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kClose);
  EXPECT_EQ(scheduler.result()->ranking.recommended, 0);
  EXPECT_TRUE(scheduler.result()->complete);
}

TEST(SchedulerByCostTest, SmallerMaxRegretPlaysOnToTheMaximum) {
  SchedulerParams params = ByCost(64);
  params.criteria.max_regret = 0.0;
  Scheduler scheduler(params, 2, 0.0);
  EXPECT_EQ(PlayAlone(Taking({10.0, 10.5}), &scheduler), 128);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kClose);
}

TEST(SchedulerByCostTest, NoEarlyStopPlaysExactlyTheGivenNumber) {
  SchedulerParams params = ByCost(40);
  params.early_stop = false;
  Scheduler scheduler(params, 2, 0.0);
  EXPECT_EQ(PlayAlone(Taking({10.0, 90.0}), &scheduler), 80);
  EXPECT_EQ(scheduler.result()->ranking.evidence[0].success.kind, IntervalKind::kClopperPearson);
}

TEST(SchedulerByCostTest, OneAlternativeEndsOnceItsSuccessIsDecided) {
  Scheduler scheduler(ByCost(), 1, 0.0);
  EXPECT_EQ(PlayAlone(Taking({10.0}), &scheduler), 64);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kRanked);
  Scheduler open(ByCost(), 1, 0.0);
  EXPECT_EQ(PlayAlone(SuccessesOf(1, 2), &open), 400);
  EXPECT_EQ(open.result()->outcome, ImaginationOutcome::kUndecided);
}

TEST(SchedulerByCostTest, AlternativesThatFailGetNoMoreRollouts) {
  const Play play = [](int alternative, int) {
    return alternative == 2 ? Fall(1.0) : Success(10.0 + 0.5 * alternative);
  };
  Scheduler scheduler(ByCost(), 3, 0.0);
  PlayAlone(play, &scheduler);
  const auto& evidence = scheduler.result()->ranking.evidence;
  EXPECT_EQ(evidence[2].num_rollouts, 16);
  EXPECT_GT(evidence[0].num_rollouts, 32);
  EXPECT_THAT(scheduler.result()->ranking.order, ElementsAre(0, 1, 2));
}

TEST(SchedulerByCostTest, CutShortItRestsOnWhatEachAlternativeHasAndSaysSo) {
  SchedulerParams params = ByCost();
  params.deadline = 12.5;
  Scheduler scheduler(params, 2, 0.0);
  PlayAlone(Taking({10.0, 90.0}), &scheduler);
  const SchedulerResult& result = *scheduler.result();
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.stopped_by, "the deadline");
  EXPECT_EQ(result.ranking.evidence[0].success.kind, IntervalKind::kConfidenceSequence);
  EXPECT_GE(result.ranking.num_rollouts, 7);
}

TEST(SchedulerByCostTest, IdleWorkersGoOnWithARoundLikeThePresentOne) {
  Scheduler scheduler(ByCost(), 2, 0.0);
  int given = 0, last = -1;
  for (int worker = 0; worker < 100; ++worker) {
    for (const Assign& work : Only<Assign>(scheduler.Handle(WorkerJoined{worker}, 0.0))) {
      last = std::max(last, work.first_index + work.count - 1);
      given += work.count;
    }
  }
  EXPECT_EQ(given, 64);
  EXPECT_EQ(last, 31);
}

// ---------------------------------------------------------------- cut short

TEST(SchedulerTest, RankingExistsFromTheFirstCommonRolloutOn) {
  Scheduler scheduler({}, 2, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  EXPECT_EQ(scheduler.RankingSoFar().num_rollouts, 0);
  EXPECT_EQ(scheduler.RankingSoFar().recommended, std::nullopt);
  work = Only<Assign>(Complete(work[0], PlaySlowIsBetter(), 1.0, &scheduler));
  EXPECT_EQ(scheduler.RankingSoFar().num_rollouts, 0);
  Complete(work[0], PlaySlowIsBetter(), 2.0, &scheduler);
  EXPECT_EQ(scheduler.RankingSoFar().num_rollouts, 1);
  EXPECT_THAT(scheduler.RankingSoFar().order, ElementsAre(1, 0));
  EXPECT_EQ(scheduler.RankingSoFar().recommended, std::nullopt);  // one rollout proves nothing
}

SchedulerParams WithDeadline(double deadline) {
  SchedulerParams params;
  params.deadline = deadline;
  return params;
}

TEST(SchedulerTest, DeadlineTakesTheBestCommonPrefix) {
  Scheduler scheduler(WithDeadline(12.5), 2, 100.0);
  EXPECT_EQ(scheduler.WakeAt(), 110.0);  // nobody has come yet
  PlayAlone(PlaySlowIsBetter(), &scheduler, 100.0);
  ASSERT_TRUE(scheduler.finished());
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kRanked);
  EXPECT_FALSE(scheduler.result()->complete);
  EXPECT_LT(scheduler.result()->ranking.num_rollouts, 16);
  EXPECT_GE(scheduler.result()->ranking.num_rollouts, 7);
  EXPECT_EQ(scheduler.result()->ranking.recommended, 1);
  EXPECT_EQ(scheduler.result()->ranking.evidence[1].success.kind,
            IntervalKind::kConfidenceSequence);
}

TEST(SchedulerTest, ResultAtTheDeadlineComesTooLate) {
  Scheduler scheduler(WithDeadline(5.0), 1, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const auto commands =
      scheduler.Handle(RolloutFinished{1, work[0].assignment, 0, 0, Success()}, 5.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kNothingFinished);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 0);
  EXPECT_EQ(scheduler.result()->ranking.recommended, std::nullopt);
  EXPECT_EQ(Only<CancelAssignment>(commands).size(), 1u);
}

TEST(SchedulerTest, ResultOfOneAlternativeAloneIsNoRanking) {
  Scheduler scheduler(WithDeadline(5.0), 2, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  Complete(work[0], PlaySlowIsBetter(), 1.0, &scheduler);
  scheduler.Tick(5.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kNothingFinished);
}

TEST(SchedulerTest, AllFailedUntilTheDeadlineIsSaidSo) {
  Scheduler scheduler(WithDeadline(12.5), 2, 0.0);
  PlayAlone([](int, int) { return Fall(); }, &scheduler);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kAllFailed);
  EXPECT_FALSE(scheduler.result()->complete);
}

TEST(SchedulerTest, NoWorkerEndsAfterTheWait) {
  Scheduler scheduler({}, 2, 50.0);
  EXPECT_EQ(scheduler.WakeAt(), 60.0);
  scheduler.Tick(59.9);
  EXPECT_FALSE(scheduler.finished());
  scheduler.Tick(60.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kNoWorker);
  EXPECT_FALSE(scheduler.result()->complete);
}

TEST(SchedulerTest, NoWorkerUntilTheDeadlineIsNotCalledNothingFinished) {
  Scheduler scheduler(WithDeadline(5.0), 2, 0.0);
  scheduler.Tick(5.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kNoWorker);
}

TEST(SchedulerTest, WaitBeginsAnewWhenTheLastWorkerIsLost) {
  Scheduler scheduler({}, 2, 0.0);
  scheduler.Handle(WorkerJoined{1}, 8.0);
  EXPECT_EQ(scheduler.WakeAt(), std::nullopt);
  scheduler.Handle(WorkerLost{1}, 30.0);
  EXPECT_EQ(scheduler.WakeAt(), 40.0);
  EXPECT_EQ(Only<Assign>(scheduler.Handle(WorkerJoined{2}, 39.0)).size(), 1u);
  EXPECT_FALSE(scheduler.finished());
}

TEST(SchedulerTest, LossOfAllWorkersKeepsTheRankingSoFar) {
  Scheduler scheduler({}, 2, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  for (int i = 0; i < 3; ++i) {
    work = Only<Assign>(Complete(work[0], PlaySlowIsBetter(), 1.0, &scheduler));
  }
  scheduler.Handle(WorkerLost{1}, 2.0);
  scheduler.Tick(12.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kUndecided);
  EXPECT_FALSE(scheduler.result()->complete);
  EXPECT_EQ(scheduler.result()->ranking.num_rollouts, 1);
  EXPECT_THAT(scheduler.result()->ranking.order, ElementsAre(1, 0));
}

TEST(SchedulerTest, CancelEndsEverything) {
  Scheduler scheduler({}, 2, 0.0);
  scheduler.Handle(WorkerJoined{1}, 0.0);
  scheduler.Handle(WorkerJoined{2}, 0.0);
  EXPECT_EQ(Only<CancelAssignment>(scheduler.Cancel(1.0)).size(), 2u);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kCancelled);
  EXPECT_EQ(scheduler.result()->found, ImaginationOutcome::kCancelled) << "nothing was finished";
}

/// What is found by one alternative of which `num_rollouts` were finished when it was cancelled.
ImaginationOutcome FoundWhenCancelled(const RolloutResult& result, int num_rollouts) {
  SchedulerParams params;
  params.rollouts = 100;
  params.batch = 1;
  Scheduler scheduler(params, 1, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  for (int i = 0; i < num_rollouts; ++i) {
    const Assign& assign = work.back();
    work = Only<Assign>(Complete(assign, Always(result), 1.0, &scheduler));
  }
  scheduler.Cancel(2.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kCancelled);
  return scheduler.result()->found;
}

TEST(SchedulerTest, WhatWasFoundUntilACancellationIsJudgedLikeEveryOtherEnd) {
  EXPECT_EQ(FoundWhenCancelled(Success(), 4), ImaginationOutcome::kUndecided) << "34 to 100 %";
  EXPECT_EQ(FoundWhenCancelled(Success(), 40), ImaginationOutcome::kRanked);
  EXPECT_EQ(FoundWhenCancelled(Fall(), 40), ImaginationOutcome::kAllFailed);
  EXPECT_EQ(FoundWhenCancelled(Fall(), 0), ImaginationOutcome::kCancelled);
}

TEST(SchedulerTest, AnHourPassesAtOnce) {
  Scheduler scheduler(WithDeadline(3600.0), 2, 0.0);
  scheduler.Handle(WorkerJoined{1}, 0.0);  // and never answers
  for (double now = 0.0; now < 3600.0; now += 1.0) scheduler.Tick(now);
  EXPECT_FALSE(scheduler.finished());
  scheduler.Tick(3600.0);
  EXPECT_EQ(scheduler.result()->outcome, ImaginationOutcome::kNothingFinished);
}

// ---------------------------------------------------------------- progress

TEST(SchedulerTest, ProgressCountsFromTheFirstAssignment) {
  Scheduler scheduler({}, 2, 0.0);
  EXPECT_EQ(scheduler.ProgressAt(3.0).fraction, 0.0);
  EXPECT_EQ(scheduler.ProgressAt(3.0).time_left, std::nullopt);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 4.0));
  Complete(work[0], PlaySlowIsBetter(), 6.0, &scheduler);
  const Progress progress = scheduler.ProgressAt(6.0);
  EXPECT_EQ(progress.done, 1);
  EXPECT_EQ(progress.total, 128);
  EXPECT_EQ(progress.fraction, 1.0 / 128.0);
  EXPECT_EQ(progress.time_left, 2.0 * 127.0);
}

// ---------------------------------------------------------------- faults

TEST(SchedulerTest, LostWorkIsGivenToTheNextOne) {
  Scheduler scheduler({}, 2, 0.0);
  const auto lost = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  scheduler.Handle(WorkerLost{1}, 1.0);
  const auto again = Only<Assign>(scheduler.Handle(WorkerJoined{2}, 2.0));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].alternative, lost[0].alternative);
  EXPECT_EQ(again[0].first_index, lost[0].first_index);
  EXPECT_NE(again[0].assignment, lost[0].assignment);
}

TEST(SchedulerTest, JoiningTwiceGivesBackWhatWasOwed) {
  Scheduler scheduler({}, 2, 0.0);
  const auto first = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const auto second = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 1.0));
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].first_index, first[0].first_index);
  EXPECT_NE(second[0].assignment, first[0].assignment);
}

TEST(SchedulerTest, LateResultOfALostWorkerIsIgnored) {
  Scheduler scheduler({}, 2, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  scheduler.Handle(WorkerLost{1}, 1.0);
  scheduler.Handle(RolloutFinished{1, work[0].assignment, 0, 0, Success()}, 2.0);
  EXPECT_EQ(scheduler.ProgressAt(2.0).done, 0);
  EXPECT_EQ(scheduler.num_mismatches(), 0);
}

TEST(SchedulerTest, RepeatedResultThatDiffersIsCountedAndNotTaken) {
  const QuietLog quiet;
  Scheduler scheduler({}, 2, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const RolloutFinished finished{1, work[0].assignment, 0, 0, Success()};
  scheduler.Handle(finished, 1.0);
  scheduler.Handle(finished, 1.0);
  EXPECT_EQ(scheduler.num_mismatches(), 0);
  scheduler.Handle(RolloutFinished{1, work[0].assignment, 0, 0, Fall()}, 1.0);
  EXPECT_EQ(scheduler.num_mismatches(), 1);
  EXPECT_EQ(scheduler.Prefix(0)[0].falls, 0);
  EXPECT_EQ(scheduler.ProgressAt(1.0).done, 1);
}

TEST(SchedulerTest, EventsThatMakeNoSenseDoNoHarm) {
  Scheduler scheduler({}, 2, 0.0);
  scheduler.Handle(WorkerLost{9}, 0.0);
  scheduler.Handle(AssignmentFinished{9, 4}, 0.0);
  scheduler.Handle(AssignmentFailed{9, 4, "?", true}, 0.0);
  scheduler.Handle(RolloutFinished{9, 4, -1, -5, Success()}, 0.0);
  scheduler.Handle(RolloutFinished{9, 4, 77, 1 << 30, Success()}, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  scheduler.Handle(AssignmentFinished{9, work[0].assignment}, 0.0);  // not his to finish
  EXPECT_THAT(scheduler.worker_problems(), IsEmpty());
  EXPECT_EQ(scheduler.ProgressAt(0.0).done, 0);
}

TEST(SchedulerTest, UnusableWorkerGetsNothingUntilItJoinsAnew) {
  const QuietLog quiet;
  Scheduler scheduler({}, 2, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const auto after =
      scheduler.Handle(AssignmentFailed{1, work[0].assignment, "hash of world differs", true}, 1.0);
  EXPECT_THAT(after, IsEmpty());
  EXPECT_THAT(scheduler.worker_problems(), ElementsAre("worker 1: hash of world differs"));
  EXPECT_EQ(scheduler.WakeAt(), 11.0);  // nobody usable is left
  EXPECT_EQ(Only<Assign>(scheduler.Handle(WorkerJoined{1}, 2.0)).size(), 1u);
}

TEST(SchedulerTest, WorkerThatAnswersNonsenseIsSetAside) {
  const QuietLog quiet;
  RolloutResult broken = Success();
  broken.duration = std::nan("");
  Scheduler scheduler({}, 2, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const auto after = scheduler.Handle(RolloutFinished{1, work[0].assignment, 0, 0, broken}, 1.0);
  EXPECT_EQ(Only<CancelAssignment>(after).size(), 1u);
  work = Only<Assign>(scheduler.Handle(WorkerJoined{2}, 1.0));
  scheduler.Handle(RolloutFinished{2, work[0].assignment, 0, 40, Success()}, 1.0);
  EXPECT_THAT(scheduler.worker_problems(),
              ElementsAre(HasSubstr("worker 1: rollout 0 of alternative 0: duration is nan"),
                          HasSubstr("worker 2: answered rollout 40 of alternative 0")));
  EXPECT_EQ(scheduler.ProgressAt(1.0).done, 0);
}

TEST(SchedulerTest, WorkerThatOnlyFailsIsSetAsideAndCondemnsNoRollout) {
  const QuietLog quiet;
  Scheduler scheduler({}, 2, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  int failures = 0;
  for (; !work.empty(); ++failures) {
    work = Only<Assign>(
        scheduler.Handle(AssignmentFailed{1, work[0].assignment, "out of memory", false}, 1.0));
  }
  EXPECT_EQ(failures, 2);
  EXPECT_THAT(scheduler.worker_problems(),
              ElementsAre("worker 1: failed 2 times in a row, last: out of memory"));
  EXPECT_EQ(PlayAlone(PlaySlowIsBetter(), &scheduler), 32);  // it joins anew, mended
  EXPECT_EQ(scheduler.result()->num_unplayable, 0);
}

TEST(SchedulerTest, WorkerThatFailsNowAndThenGoesOn) {
  const QuietLog quiet;
  Scheduler scheduler({}, 2, 0.0);
  auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  for (int round = 0; round < 4; ++round) {
    ASSERT_EQ(work.size(), 1u) << "after " << round << " failures";
    const Assign& one = work[0];
    scheduler.Handle(
        RolloutFinished{1, one.assignment, one.alternative, one.first_index, Success()}, 1.0);
    work = Only<Assign>(scheduler.Handle(AssignmentFailed{1, one.assignment, "tired", false}, 1.0));
  }
  EXPECT_THAT(scheduler.worker_problems(), testing::IsEmpty());
}

TEST(SchedulerTest, MissingResultsAreAskedForAgain) {
  Scheduler scheduler({}, 2, 0.0);
  const auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
  const auto again = Only<Assign>(scheduler.Handle(AssignmentFinished{1, work[0].assignment}, 1.0));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].first_index, work[0].first_index);
  EXPECT_EQ(again[0].alternative, work[0].alternative);
}

TEST(SchedulerTest, RolloutThatKillsItsWorkersCountsAsFailedInTheEnd) {
  const QuietLog quiet;
  SchedulerParams params;
  params.rollouts = 4;
  Scheduler scheduler(params, 1, 0.0);
  int deaths = 0;
  while (!scheduler.finished() && deaths < 100) {
    auto work = Only<Assign>(scheduler.Handle(WorkerJoined{1}, 0.0));
    while (!work.empty() && work[0].first_index != 2) {
      work = Only<Assign>(Complete(work[0], PlayInvented({{}}, base::Rng(1)), 0.0, &scheduler));
    }
    if (scheduler.finished()) break;
    ++deaths;
    scheduler.Handle(WorkerLost{1}, 0.0);
  }
  EXPECT_EQ(deaths, params.max_attempts);
  EXPECT_EQ(scheduler.result()->num_unplayable, 1);
  EXPECT_EQ(scheduler.result()->ranking.evidence[0].failures.at(base::FailureCode::kUnplayable), 1);
  EXPECT_EQ(scheduler.result()->ranking.evidence[0].success.share, 0.75);
}

// ---------------------------------------------------------------- any course, one answer

/// Workers that work, die, come back, stutter and repeat themselves, as chance has it.
class Fleet {
 public:
  Fleet(Play play, int num_workers, double fault_probability, base::Rng rng, Scheduler* scheduler)
      : play_(std::move(play)),
        num_workers_(num_workers),
        fault_probability_(fault_probability),
        rng_(rng),
        scheduler_(scheduler) {}

  /// Runs until the scheduler has finished, or `most_events` have happened.
  void Run(int most_events) {
    for (int i = 0; i < most_events && !scheduler_->finished(); ++i) {
      now_ += rng_.Uniform(0.0, 0.01);
      Move(rng_.Index(num_workers_));
    }
  }

 private:
  struct Job {
    Assign assign;
    std::vector<int> left;  // indices not yet sent, in any order
  };
  using Rollout = std::pair<int, int>;  // alternative, index

  void Move(int worker) {
    if (present_.count(worker) == 0) {
      present_.insert(worker);
      return Post(WorkerJoined{worker});
    }
    if (rng_.Bernoulli(fault_probability_)) return Misbehave(worker);
    const auto job = jobs_.find(worker);
    if (job != jobs_.end()) Work(worker, &job->second);
  }

  void Work(int worker, Job* job) {
    if (job->left.empty()) {
      const int assignment = job->assign.assignment;
      jobs_.erase(worker);
      return Post(AssignmentFinished{worker, assignment});
    }
    const auto next = job->left.begin() + rng_.Index(static_cast<int>(job->left.size()));
    const int index = *next;
    job->left.erase(next);
    const int alternative = job->assign.alternative;
    owner_.erase({alternative, index});
    done_.insert({alternative, index});
    sent_.push_back(
        {worker, job->assign.assignment, alternative, index, play_(alternative, index)});
    Post(sent_.back());
  }

  void Misbehave(int worker) {
    const int kind = rng_.Index(5);
    if (kind == 0) return Leave(worker, WorkerLost{worker});
    if (kind == 1) return Leave(worker, WorkerJoined{worker});  // back before its loss was noticed
    if (kind == 2 && !sent_.empty()) {
      return Post(RolloutFinished(sent_[rng_.Index(static_cast<int>(sent_.size()))]));
    }
    const auto job = jobs_.find(worker);
    if (job == jobs_.end()) return;
    const int assignment = job->second.assign.assignment;
    if (kind == 3) return Leave(worker, AssignmentFailed{worker, assignment, "tired", false});
    SendLateAfterLoss(worker, job->second);
  }

  /// The result was on its way when the worker was given up.
  void SendLateAfterLoss(int worker, const Job& job) {
    if (job.left.empty()) return;
    const RolloutFinished late{worker, job.assign.assignment, job.assign.alternative,
                               job.left.front(), play_(job.assign.alternative, job.left.front())};
    Leave(worker, WorkerLost{worker});
    Post(late);
  }

  /// Ends what the worker had, and tells.
  void Leave(int worker, const Event& event) {
    const auto job = jobs_.find(worker);
    if (job != jobs_.end()) {
      for (const int index : job->second.left) {
        owner_.erase({job->second.assign.alternative, index});
      }
      jobs_.erase(job);
    }
    if (std::holds_alternative<WorkerLost>(event)) present_.erase(worker);
    Post(event);
  }

  void Post(const Event& event) {
    const auto commands = scheduler_->Handle(event, now_);
    for (const Assign& assign : Only<Assign>(commands)) Accept(assign);
  }

  void Accept(const Assign& assign) {
    ASSERT_EQ(jobs_.count(assign.worker), 0u) << "a busy worker was given more";
    ASSERT_GE(assign.count, 1);
    Job job{assign, {}};
    for (int i = assign.first_index; i < assign.first_index + assign.count; ++i) {
      const Rollout rollout{assign.alternative, i};
      EXPECT_EQ(owner_.count(rollout), 0u) << "rollout " << i << " is with somebody already";
      EXPECT_EQ(done_.count(rollout), 0u) << "rollout " << i << " is in already";
      owner_[rollout] = assign.worker;
      job.left.push_back(i);
    }
    jobs_[assign.worker] = job;
  }

  Play play_;
  int num_workers_;
  double fault_probability_;
  base::Rng rng_;
  Scheduler* scheduler_;
  double now_{0.0};
  std::set<int> present_;
  std::map<int, Job> jobs_;
  std::map<Rollout, int> owner_;
  std::set<Rollout> done_;
  std::vector<RolloutFinished> sent_;
};

std::vector<Behaviour> SomeBehaviours(base::Rng* rng) {
  std::vector<Behaviour> behaviours(1 + rng->Index(4));
  for (Behaviour& behaviour : behaviours) {
    behaviour = {rng->Uniform(0.0, 0.6), rng->Uniform(0.0, 0.3), rng->Uniform(20.0, 40.0),
                 rng->Index(50)};
  }
  return behaviours;
}

Prices SomePrices() {
  return {{{base::FailureCode::kObjectFell, 100.0}, {base::FailureCode::kOther, 20.0}}, 300.0};
}

SchedulerParams SomeParams(base::Rng* rng) {
  SchedulerParams params;
  params.rollouts = 1 + rng->Index(300);
  params.worker_wait = 1e6;  // [s] longer than any of these courses
  params.early_stop = rng->Bernoulli(0.8);
  constexpr RankingRule kRules[] = {RankingRule::kRisk, RankingRule::kCost, RankingRule::kThesis};
  params.criteria = {kRules[rng->Index(3)], rng->Uniform(0.2, 0.9), SomePrices()};
  params.first_look = 1 + rng->Index(20);
  params.batch = 1 + rng->Index(8);
  params.max_attempts = 100;  // these workers are clumsy, their rollouts are not to blame
  return params;
}

TEST(SchedulerPropertyTest, AnyCourseGivesTheSequentialAnswerToTheBit) {
  const QuietLog quiet;
  int num_stopped_early = 0;
  for (int seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Rng rng = base::Rng(42).Fork(seed);
    const auto behaviours = SomeBehaviours(&rng);
    const auto params = SomeParams(&rng);
    const int num_alternatives = static_cast<int>(behaviours.size());
    const Play play = PlayInvented(behaviours, rng.Fork(1));
    Scheduler scheduler(params, num_alternatives, 0.0);
    Fleet fleet(play, 1 + rng.Index(8), rng.Uniform(0.0, 0.2), rng.Fork(2), &scheduler);
    fleet.Run(100000);
    ASSERT_TRUE(scheduler.finished());
    EXPECT_TRUE(scheduler.result()->complete);
    EXPECT_EQ(scheduler.result()->num_unplayable, 0);
    EXPECT_EQ(scheduler.num_mismatches(), 0);
    const Ranking expected = Sequentially(params, num_alternatives, play);
    ExpectSameRanking(scheduler.result()->ranking, expected);
    num_stopped_early += expected.num_rollouts < params.rollouts;
  }
  EXPECT_GT(num_stopped_early, 30);  // or the looks were not tested
}

TEST(SchedulerPropertyTest, OneTwoAndEightWorkersAgree) {
  for (int seed = 0; seed < 50; ++seed) {
    base::Rng rng = base::Rng(43).Fork(seed);
    const auto behaviours = SomeBehaviours(&rng);
    const auto params = SomeParams(&rng);
    std::vector<Ranking> rankings;
    for (const int workers : {1, 2, 8}) {
      Scheduler scheduler(params, static_cast<int>(behaviours.size()), 0.0);
      Fleet(PlayInvented(behaviours, rng.Fork(1)), workers, 0.0, rng.Fork(workers), &scheduler)
          .Run(100000);
      ASSERT_TRUE(scheduler.finished());
      rankings.push_back(scheduler.result()->ranking);
    }
    ExpectSameRanking(rankings[0], rankings[1]);
    ExpectSameRanking(rankings[0], rankings[2]);
  }
}

TEST(SchedulerPropertyTest, AtAnyMomentTheRankingIsThatOfTheCommonPrefix) {
  const QuietLog quiet;
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(44).Fork(seed);
    const auto behaviours = SomeBehaviours(&rng);
    const Play play = PlayInvented(behaviours, rng.Fork(1));
    Scheduler scheduler(SomeParams(&rng), static_cast<int>(behaviours.size()), 0.0);
    Fleet(play, 1 + rng.Index(8), 0.1, rng.Fork(2), &scheduler).Run(rng.Index(200));
    const Ranking ranking = scheduler.RankingSoFar();
    for (std::size_t a = 0; a < behaviours.size(); ++a) {
      const int count = ranking.evidence[a].num_rollouts;
      ASSERT_GE(static_cast<int>(scheduler.Prefix(a).size()), count);
      ExpectSameEvidence(ranking.evidence[a], SumUp(InventAll(behaviours[a], rng.Fork(1), count),
                                                    count, ranking.evidence[a].success.kind));
    }
  }
}

}  // namespace
}  // namespace hires::imagination::scheduler_test
