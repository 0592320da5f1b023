#include "hires/imagination/rollout_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/text.h"
#include "imagination/room_rollouts.h"
#include "support/messages.h"

namespace hires::imagination::rollout_recording_test {
namespace {

using hires::test_support::ConfigErrorOf;
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

TEST(ParseRolloutChoiceTest, NamesAndNumbersOfEachRank) {
  using Kind = RolloutChoice::Kind;
  EXPECT_EQ(ParseRolloutChoice("worst").kind, Kind::kWorst);
  EXPECT_EQ(ParseRolloutChoice("median@2").kind, Kind::kMedian);
  EXPECT_EQ(ParseRolloutChoice("median@2").rank, 2);
  EXPECT_EQ(ParseRolloutChoice("first_fall").kind, Kind::kFirstFailed);
  EXPECT_EQ(ParseRolloutChoice("37@4").index, 37);
  EXPECT_EQ(ParseRolloutChoice("37@4").rank, 4);
}

TEST(ParseRolloutChoiceTest, AnythingElseIsRefused) {
  for (const char* text : {"", "best", "-1", "1.5", "3@", "worst@x", "37 "}) {
    EXPECT_THAT(ConfigErrorOf([&] { ParseRolloutChoice(text); }),
                AllOf(HasSubstr(std::string("'") + text + "'"), HasSubstr("first_fall")))
        << text;
  }
  EXPECT_THAT(ConfigErrorOf([] { ParseRolloutChoice("worst@0"); }), HasSubstr("from 1"));
}

TEST(IndexOfTest, WhatWasNotPlayedIsRefused) {
  Evidence evidence;
  evidence.num_rollouts = 8;
  EXPECT_EQ(IndexOf({RolloutChoice::Kind::kIndex, 7, 1}, evidence), 7);
  EXPECT_THAT(ConfigErrorOf([&] {
                IndexOf({RolloutChoice::Kind::kIndex, 8, 1}, evidence);
              }),
              HasSubstr("no rollout 8: 8 were played"));
  EXPECT_THAT(ConfigErrorOf([&] {
                IndexOf({RolloutChoice::Kind::kFirstFailed, 0, 1}, evidence);
              }),
              HasSubstr("all succeeded"));
}

TEST(RecordRolloutTest, TwoHundredPlayedAgainAreThoseThatWereImagined) {
  const RolloutSetup setup = Disturbed();
  std::vector<RolloutResult> results;
  for (int i = 0; i < 200; ++i) results.push_back(*PlayRollout(setup, kFast, i));
  const Evidence evidence = SumUp(results);
  ASSERT_GT(evidence.falls, 0);  // both kinds are there
  ASSERT_LT(evidence.falls, 200);
  for (int i = 0; i < 200; ++i) {
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

TEST(RecordRolloutTest, SaysWhatHappensInItsOrder) {
  const RolloutSetup setup = Disturbed();
  int falls = -1;
  for (int i = 0; falls < 0; ++i) {
    ASSERT_LT(i, 200);
    if (PlayRollout(setup, kFast, i)->falls > 0) falls = i;
  }
  const RolloutRecording recording = Record(setup, falls);
  EXPECT_EQ(recording.objects, std::vector<std::string>{"load"});
  std::string story;
  double before = 0.0;
  for (const RolloutEvent& event : recording.events) {
    EXPECT_GE(event.time, before);
    before = event.time;
    story += event.text + "; ";
  }
  EXPECT_LT(story.find("load leans"), story.find("load topples"));
  EXPECT_THAT(story, HasSubstr("ends: object_fell"));
}

TEST(RecordRolloutTest, TheTableHasALineForEachSample) {
  const RolloutRecording recording = Record(RoomRollouts(Room(), "mill"), 0);
  ASSERT_GT(recording.samples.size(), 100u);
  for (std::size_t i = 1; i < recording.samples.size(); ++i) {
    EXPECT_NEAR(recording.samples[i].time - recording.samples[i - 1].time, 0.05, 1e-9);
  }
  const std::string csv = ToCsv(recording);
  const std::vector<std::string> lines = base::Split(csv, '\n');
  EXPECT_EQ(lines.size(), recording.samples.size() + 2);  // the header, and what ends the last
  EXPECT_THAT(lines[0], AllOf(HasSubstr("time,x,y,z,"),
                              HasSubstr("jerk,load.x,load.y,load.z,load.tilt,event")));
  const std::size_t columns = base::Split(lines[0], ',').size();
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    EXPECT_EQ(base::Split(lines[i], ',').size(), columns) << lines[i];
  }
}

TEST(RecordRolloutTest, ItCanBeCancelled) {
  EXPECT_FALSE(RecordRollout(RoomRollouts(Room(), "mill"), kFast, 0, [] { return true; }));
}

}  // namespace
}  // namespace hires::imagination::rollout_recording_test
