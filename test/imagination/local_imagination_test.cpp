#include "hires/imagination/local_imagination.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "imagination/room_rollouts.h"
#include "support/messages.h"

namespace hires::imagination::local_imagination_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::SomeUncertainty;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<base::ActionCall> kActions{{"move_base_param", {"east", "fast"}},
                                             {"move_base_param", {"east", "slow"}}};

SchedulerParams AtMost(int rollouts) {
  SchedulerParams params;
  params.rollouts = rollouts;
  params.first_look = 4;
  return params;
}

TEST(ImagineLocallyTest, TheNumberOfThreadsChangesNothing) {
  const RolloutSetup setup = RoomRollouts(Room(), "tower", SomeUncertainty());
  const Report one = ImagineLocally(setup, kActions, AtMost(8), 1);
  ASSERT_THAT(one.ranking, SizeIs(2));
  for (const int threads : {2, 3}) {
    const Report more = ImagineLocally(setup, kActions, AtMost(8), threads);
    EXPECT_EQ(more.outcome, one.outcome);
    EXPECT_EQ(more.recommended, one.recommended);
    EXPECT_EQ(more.why, one.why);
    EXPECT_EQ(more.simulated_seconds, one.simulated_seconds);
    ASSERT_THAT(more.ranking, SizeIs(2));
    for (int place = 0; place < 2; ++place) {
      const Evidence& a = more.ranking[place].evidence;
      const Evidence& b = one.ranking[place].evidence;
      EXPECT_EQ(more.ranking[place].action, one.ranking[place].action);
      EXPECT_EQ(a.counts, b.counts);
      EXPECT_EQ(a.num_rollouts, b.num_rollouts);
      EXPECT_EQ(a.duration.mean, b.duration.mean);
      EXPECT_EQ(a.max_tilt.p95, b.max_tilt.p95);
      EXPECT_EQ(a.failures, b.failures);
      EXPECT_TRUE(more.ranking[place].final_robot == one.ranking[place].final_robot);
    }
  }
}

TEST(ImagineLocallyTest, ItPlaysWhatPlayRolloutPlays) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill", SomeUncertainty());
  const Report report = ImagineLocally(setup, {kActions[0]}, AtMost(2), 2);
  std::vector<RolloutResult> results;
  for (int i = 0; i < 2; ++i) results.push_back(*PlayRollout(setup, kActions[0], i));
  const Evidence expected = SumUp(results);
  ASSERT_THAT(report.ranking, SizeIs(1));
  EXPECT_EQ(report.ranking[0].evidence.counts, expected.counts);
  EXPECT_EQ(report.ranking[0].evidence.duration.mean, expected.duration.mean);
  EXPECT_EQ(report.seed, setup.seed);
}

TEST(ImagineLocallyTest, ItAnswersByWhatTheCallerPlays) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  std::atomic<int> played{0};
  const PlayOne play = [&](int alternative, int index, const RolloutHooks&) {
    ++played;
    RolloutResult result;
    result.outcome = Outcome::kSucceeded;
    result.action_finished = true;
    result.counts.notopple = 100;
    result.duration = 10.0 * (alternative + 1) + index;
    return std::make_optional(result);
  };
  SchedulerParams params = AtMost(4);
  params.early_stop = false;
  const Report report = ImagineLocally(setup, kActions, params, 2, play);
  EXPECT_EQ(played, 8);
  ASSERT_THAT(report.ranking, SizeIs(2));
  EXPECT_EQ(report.ranking[0].action, kActions[0]) << "the quicker one";
  EXPECT_NEAR(report.ranking[0].evidence.duration.mean, 11.5, 1e-12);
  EXPECT_NEAR(report.ranking[1].evidence.duration.mean, 21.5, 1e-12);
}

TEST(ImagineLocallyTest, RefusesABadRequestBeforePlaying) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  bool asked = false;
  const auto cancelled = [&] { return asked = true; };
  EXPECT_THAT(
      ConfigErrorOf([&] {
        ImagineLocally(setup, {kActions[0], {"move_base", {"moon"}}}, AtMost(4), 1, {}, cancelled);
      }),
      HasSubstr("area 'moon' is unknown"));
  EXPECT_FALSE(asked);
}

TEST(ImagineLocallyTest, TheLastInterimIsTheWhole) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  Interim last;
  int count = 0;
  ImagineLocally(setup, kActions, AtMost(4), 2, [&](const Interim& interim) {
    EXPECT_GE(interim.progress.fraction, last.progress.fraction);
    last = interim;
    ++count;
  });
  EXPECT_GE(count, 1);
  EXPECT_EQ(last.progress.fraction, 1.0);
  EXPECT_EQ(last.num_workers, 2);
  EXPECT_THAT(last.ranking, SizeIs(2));
}

TEST(ImagineLocallyTest, CancelledItStopsWithoutPlayingAll) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill", SomeUncertainty());
  SchedulerParams params = AtMost(100000);
  params.early_stop = false;
  const Report report = ImagineLocally(setup, kActions, params, 2, {}, [] { return true; });
  EXPECT_EQ(report.outcome, ImaginationOutcome::kCancelled);
}

TEST(ImagineLocallyTest, WithoutThreadsThereIsNoWorker) {
  SchedulerParams params = AtMost(4);
  params.worker_wait = 0.0;
  const Report report = ImagineLocally(RoomRollouts(Room(), "mill"), kActions, params, 0);
  EXPECT_EQ(report.outcome, ImaginationOutcome::kNoWorker);
  EXPECT_THAT(report.ranking, IsEmpty());
}

TEST(ImagineLocallyTest, RefusesBadParameters) {
  EXPECT_THAT(
      ConfigErrorOf([] { ImagineLocally(RoomRollouts(Room(), "mill"), kActions, AtMost(0), 1); }),
      HasSubstr("rollouts"));
}

}  // namespace
}  // namespace hires::imagination::local_imagination_test
