#include "hires/imagination/rollout_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "hires/base/text.h"
#include "imagination/room_rollouts.h"
#include "support/rounds.h"

namespace hires::imagination::rollout_recording_test {
namespace {

using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::SomeUncertainty;
using hires::test_support::TrayRobot;
using ::testing::AllOf;
using ::testing::HasSubstr;

const base::ActionCall kFast{"move_base_param", {"east", "fast"}};

/// A robot whose wheels stop at once when a command is late, which they are now and then.
RolloutSetup Disturbed() {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.stops_at_timeout = true;
  return RoomRollouts(Room(), "mill", SomeUncertainty(), robot);
}

RolloutRecording Record(const RolloutSetup& setup, int index) {
  const auto recording = RecordRollout(setup, kFast, index, {});
  EXPECT_TRUE(recording) << "nobody cancelled it";
  return recording.value_or(RolloutRecording());
}

TEST(RecordRolloutTest, ManyPlayedAgainAreThoseThatWereImagined) {
  const RolloutSetup setup = Disturbed();
  std::vector<RolloutResult> results;
  const int num_rollouts = hires::test_support::Rounds(200);
  for (int i = 0; i < num_rollouts; ++i) results.push_back(*PlayRollout(setup, kFast, i));
  const Evidence evidence = SumUp(results);
  ASSERT_GT(evidence.falls, 0);  // both kinds are there
  ASSERT_LT(evidence.falls, num_rollouts);
  for (int i = 0; i < num_rollouts; ++i) {
    const RolloutRecording recording = Record(setup, i);
    EXPECT_TRUE(SameOutcome(recording.result, results[i])) << i;
    EXPECT_TRUE(IsAmong(evidence, recording.result)) << i;
  }
}

TEST(RecordRolloutTest, AnotherRolloutIsNotAmongThem) {
  RolloutResult result = *PlayRollout(RoomRollouts(Room(), "mill"), kFast, 0);
  const Evidence evidence = SumUp({result});
  ASSERT_FALSE(FailureOf(result));
  result.duration += 0.001;
  EXPECT_FALSE(IsAmong(evidence, result));
  result.outcome = Outcome::kFailed;
  result.failure = base::FailureCode::kObjectFell;
  EXPECT_FALSE(IsAmong(evidence, result));
}

/// Number of the first rollout that falls.
int FirstFall(const RolloutSetup& setup) {
  for (int i = 0; i < 200; ++i) {
    if (PlayRollout(setup, kFast, i)->falls > 0) return i;
  }
  ADD_FAILURE() << "none of 200 falls";
  return 0;
}

double TimeOf(RolloutEvent::Kind kind, const RolloutRecording& recording) {
  for (const RolloutEvent& event : recording.events) {
    if (event.kind == kind) return event.time;
  }
  ADD_FAILURE() << "no event of kind " << static_cast<int>(kind);
  return 0.0;
}

TEST(RecordRolloutTest, SaysWhatHappensInItsOrder) {
  using Kind = RolloutEvent::Kind;
  const RolloutSetup setup = Disturbed();
  const RolloutRecording recording = Record(setup, FirstFall(setup));
  EXPECT_EQ(recording.objects, std::vector<std::string>{"load"});
  std::string story;
  double before = 0.0;
  for (const RolloutEvent& event : recording.events) {
    EXPECT_GE(event.time, before);
    before = event.time;
    story += event.text + "; ";
  }
  EXPECT_LT(TimeOf(Kind::kTips, recording), TimeOf(Kind::kFalls, recording));
  EXPECT_LT(TimeOf(Kind::kTips, recording), TimeOf(Kind::kLiftsOff, recording));
  EXPECT_EQ(TimeOf(Kind::kEnd, recording), recording.result.duration);
  EXPECT_THAT(story, AllOf(HasSubstr("load begins to tip ("), HasSubstr("load lifts off"),
                           HasSubstr("failed: object_fell")));
}

TEST(RecordRolloutTest, ACycleThatComesLateIsToldWithItsDelayBeforeTheBaseBrakes) {
  using Kind = RolloutEvent::Kind;
  RolloutSetup setup = RoomRollouts(Room(), "mill", R"(
late_cycle_probability: {distribution: fixed, value: 0.05, unit: share, source: test}
late_cycle_delay: {distribution: fixed, value: 0.5, unit: s, source: test}
)");
  const RolloutRecording recording = Record(setup, 0);
  const double late = TimeOf(Kind::kLateCycle, recording),
               braking = TimeOf(Kind::kTimedOut, recording);
  EXPECT_GT(braking, late);
  EXPECT_LT(braking, late + 0.5);
  EXPECT_NE(std::find_if(recording.events.begin(), recording.events.end(),
                         [](const RolloutEvent& e) { return e.text == "cycle late 0.50 s"; }),
            recording.events.end());
  for (const RolloutEvent& event : recording.events) {
    if (event.kind == Kind::kTimedOut) {
      EXPECT_LE(event.time, recording.result.duration);  // the end is no lack of commands
    }
  }
}

TEST(RecordRolloutTest, WhatTipsByALateCommandSaysSo) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.stops_at_timeout = true;
  const RolloutSetup setup = RoomRollouts(Room(), "mill", R"(
late_cycle_probability: {distribution: fixed, value: 0.05, unit: share, source: test}
late_cycle_delay: {distribution: fixed, value: 0.5, unit: s, source: test}
)",
                                          robot);
  std::string story;
  for (const RolloutEvent& event : Record(setup, FirstFall(setup)).events)
    story += event.text + "; ";
  EXPECT_THAT(story, HasSubstr("load begins to tip (late_command)"));
}

TEST(RecordRolloutTest, ItGoesOnForASecondAfterTheEnd) {
  const RolloutRecording recording = Record(RoomRollouts(Room(), "mill"), 0);
  EXPECT_NEAR(recording.samples.front().time, 0.05, 1e-9);  // since the action began
  const double after = recording.samples.back().time - recording.result.duration;
  EXPECT_GT(after, 0.9);
  EXPECT_LT(after, 3.1);
}

TEST(RecordRolloutTest, TheTableHasALineForEachSampleAndUnitsInItsHead) {
  const RolloutSetup setup = Disturbed();
  const RolloutRecording recording = Record(setup, FirstFall(setup));
  ASSERT_GT(recording.samples.size(), 100u);
  for (std::size_t i = 1; i < recording.samples.size(); ++i) {
    EXPECT_NEAR(recording.samples[i].time - recording.samples[i - 1].time, 0.05, 1e-9);
  }
  const std::string csv = ToCsv(recording);
  const std::vector<std::string> lines = base::Split(csv, '\n');
  EXPECT_EQ(lines.size(), recording.samples.size() + 2);  // the header, and what ends the last
  EXPECT_THAT(lines[0], AllOf(HasSubstr("time [s],x [m],y [m],z [m],"),
                              HasSubstr("jerk [m/s^3],load.x [m],load.y [m],load.z [m],"
                                        "load.tilt [rad],event")));
  const std::size_t columns = base::Split(lines[0], ',').size();
  std::string story;
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    // An event's own comma stands between quotation marks.
    const std::string numbers = lines[i].substr(0, lines[i].find('"'));
    EXPECT_EQ(base::Split(numbers, ',').size(), columns) << lines[i];
    for (const std::string& number : base::Split(numbers, ',')) EXPECT_LT(number.size(), 14u);
    story += lines[i];
  }
  for (const RolloutEvent& event : recording.events) EXPECT_THAT(story, HasSubstr(event.text));
}

TEST(RecordRolloutTest, ItCanBeCancelled) {
  EXPECT_FALSE(RecordRollout(RoomRollouts(Room(), "mill"), kFast, 0, [] { return true; }));
}

}  // namespace
}  // namespace hires::imagination::rollout_recording_test
