#include "loop/task_loop.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "loop/support/task_setup.h"
#include "reports/task/timeline.h"
#include "support/log_catcher.h"
#include "support/rounds.h"

namespace hires::loop::task_loop_test {
namespace {

using test_support::kConfig;
using test_support::StandsOnTable1;
using test_support::TheSetup;
using testing::Contains;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

LoopOrder Topple(const std::string& imagination, std::uint64_t seed = 1) {
  LoopOrder order;
  order.scenario = kConfig + "scenarios/topple.yaml";
  order.imagination = imagination;
  order.seed = seed;
  order.rollouts = 8;  // the fewest that can decide
  return order;
}

/// Everything that was told and everything that is true, to the last bit.
std::string Bits(const LoopRun& run) {
  nlohmann::ordered_json json = reports::ToJson(run.report);
  for (const auto& [name, fate] : run.truth.objects) {
    const auto& p = fate.X_MO.translation;
    json["truth"][name] = {p.x(), p.y(), p.z(), fate.max_tilt, fate.falls};
  }
  json["contact"] = run.truth.contact;
  json["seconds"] = run.virtual_seconds;
  return json.dump();
}

TEST(TaskLoopTest, ATaskIsDoneWithoutImagining) {
  HIRES_LONG_CASE();
  const LoopRun run = PlayTask(TheSetup(), Topple("off"));
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_TRUE(run.report.status.imaginations.empty());
  EXPECT_EQ(run.truth.contact, "");
}

TEST(TaskLoopTest, WhatIsImaginedIsDoneAndTheSameForAnyNumberOfThreads) {
  // With a seed of which all 8 succeed: fewer decide nothing, and what is asked again keeps its
  // seed.
  LoopOrder order = Topple("", 2);
  const LoopRun run = PlayTask(TheSetup(), order);
  ASSERT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_TRUE(StandsOnTable1(run, "peppermill1"));
  ASSERT_FALSE(run.report.status.imaginations.empty());
  EXPECT_EQ(run.report.status.imaginations.back().outcome, ImaginedOutcome::kRanked);
  order.threads = 2;
  EXPECT_EQ(Bits(PlayTask(TheSetup(), order)), Bits(run));
}

TEST(TaskLoopTest, AnotherSeedIsAnotherTruth) {
  const auto bits = [](std::uint64_t seed) {
    LoopOrder order = Topple("off", seed);
    order.time_limit = 5.0;
    return Bits(PlayTask(TheSetup(), order));
  };
  EXPECT_NE(bits(2), bits(1));
}

TEST(TaskLoopTest, WhoeverCancelsHasARobotThatStands) {
  int num_asked = 0;
  const LoopRun run =
      PlayTask(TheSetup(), Topple("off"), {}, [&] { return ++num_asked > 40; });  // 8 s
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kPreempted);
  EXPECT_LT(run.virtual_seconds, 20.0);
}

TEST(TaskLoopTest, WhatWasPlayedForACancelledImaginationCounts) {
  LoopOrder order = Topple("");
  order.rollouts = 32;
  int num_asked = 0;
  const LoopRun run = PlayTask(TheSetup(), order, {}, [&] { return ++num_asked > 15; });  // 3 s
  ASSERT_EQ(run.report.outcome, AchieveOutcome::kPreempted);
  ASSERT_EQ(run.report.status.imaginations.size(), 1u);
  const ImaginedStep& imagined = run.report.status.imaginations[0];
  ASSERT_EQ(imagined.outcome, ImaginedOutcome::kCancelled);
  ASSERT_EQ(imagined.predictions.size(), 2u);
  EXPECT_EQ(imagined.recommended, -1) << "nobody wants to know";
  int num_rollouts = 0;
  for (const auto& prediction : imagined.predictions)
    num_rollouts += prediction.evidence.num_rollouts;
  EXPECT_GE(num_rollouts, 16);
  EXPECT_LT(num_rollouts, 64) << "it was cut short";
  EXPECT_GT(imagined.simulated_seconds, 10.0 * num_rollouts) << "a drive takes longer";
  EXPECT_GT(imagined.wall_seconds, 1.0);
  EXPECT_LT(imagined.wall_seconds, 3.5);
}

TEST(TaskLoopTest, ItEndsWhenItsTimeIsOver) {
  LoopOrder order = Topple("off");
  order.time_limit = 5.0;
  const LoopRun run = PlayTask(TheSetup(), order);
  EXPECT_TRUE(run.is_timed_out);
  EXPECT_NEAR(run.virtual_seconds, 5.0, 0.1);
}

const execution::StepStatus* FirstDriveOf(const LoopRun& run) {
  const auto& steps = run.report.status.steps;
  const auto drive = std::find_if(steps.begin(), steps.end(),
                                  [](const auto& step) { return step.action.name == "move_base"; });
  return drive == steps.end() ? nullptr : &*drive;
}

TEST(TaskLoopTest, ADryRunsFirstDriveLastsAsLongAsThePlayedOne) {
  LoopOrder order = Topple("", 2);
  order.dry_run = true;
  const LoopRun dry = PlayTask(TheSetup(), order);
  ASSERT_EQ(dry.report.outcome, AchieveOutcome::kDryRun) << dry.report.reason;
  order = Topple("off", 2);
  order.time_limit = 40.0;  // of the whole task no more is wanted
  const LoopRun played = PlayTask(TheSetup(), order);
  const execution::StepStatus *planned = FirstDriveOf(dry), *driven = FirstDriveOf(played);
  ASSERT_NE(planned, nullptr);
  ASSERT_NE(driven, nullptr);
  ASSERT_TRUE(driven->finished);
  EXPECT_FALSE(planned->started) << "nothing was begun";
  const auto& asked = dry.report.status.imaginations.back();
  EXPECT_EQ(ToString(asked.action), "move_base(premanipulationareaeastcounter1)");
  const auto& duration = asked.predictions.at(0).evidence.duration;
  EXPECT_GT(duration.mean, 5.0);
  EXPECT_NEAR(planned->expected_finish - planned->expected_start, duration.mean, 1e-6);
  // What begins and ends a step takes the monitor up to a tick each.
  const double spread = 3.0 * duration.sd + 0.2;
  EXPECT_NEAR(*driven->finished - *driven->started, duration.mean, spread);
  EXPECT_LT(spread, 0.5 * duration.mean) << "or everything would fit";
}

TEST(TaskLoopTest, WhatBeginsWhereTheRobotStandsIsImaginedAsSureAsItIsOfThat) {
  LoopOrder order = Topple("");
  order.dry_run = true;
  const auto imagine = [&](const std::string& truth) {
    order.truth = truth;
    const test_support::LogCatcher log;
    const LoopRun run = PlayTask(TheSetup(), order);
    EXPECT_EQ(run.report.outcome, AchieveOutcome::kDryRun) << run.report.reason;
    return log.lines;
  };
  EXPECT_THAT(imagine("same"), Not(Contains(HasSubstr("start=here")))) << "nobody says how sure";
  // Told its start with sd 0.03 m and 0.02 rad, it has seen one scan since.
  EXPECT_THAT(imagine("filter"), Contains(ContainsRegex("start=here spread_x=0\\.0[23]")));
}

TEST(TaskLoopTest, ATaskThatMakesNoSenseIsRefused) {
  LoopOrder order = Topple("off");
  order.task = "sreve_coffee_to_guest guest1";
  try {
    PlayTask(TheSetup(), order);
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("serve_coffee_to_guest"));
  }
}

}  // namespace
}  // namespace hires::loop::task_loop_test
