#include "reports/task/timeline.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::reports::timeline_test {
namespace {

using execution::StepPhase;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

execution::StepStatus Step(int index, const base::ActionCall& action, double started,
                           std::optional<double> finished) {
  execution::StepStatus step;
  step.index = index;
  step.action = action;
  step.phase = finished ? StepPhase::kDone : StepPhase::kRunning;
  step.started = started;
  step.finished = finished;
  return step;
}

/// Two steps side by side, the second one imagined while the first one ran.
loop::AchieveReport Report() {
  loop::AchieveReport report;
  report.task = "carry \"it\", please";
  report.outcome = loop::AchieveOutcome::kSucceeded;
  report.status.now = 1040.0;
  report.status.steps = {Step(1, {"move_base_param", {"area1", "slow"}}, 1020.0, 1040.0),
                         Step(0, {"pick_up", {"mug1"}}, 1002.0, 1012.0)};
  report.status.steps.emplace_back();  // never begun
  loop::ImaginedStep imagined;
  imagined.step = 1;
  imagined.action = {"move_base_param", {{"area1"}, {"slow", "fast"}}};
  imagined.requested = 1000.0;
  imagined.answered = 1008.0;
  imagined.dispatch = 1020.0;
  imagined.deadline = 1019.5;
  imagined.wall_seconds = 4.0;
  imagined.simulated_seconds = 800.0;
  imagined.outcome = loop::ImaginedOutcome::kRanked;
  imagined.predictions.resize(2);
  imagined.predictions[0].evidence.num_rollouts = 32;
  imagined.predictions[1].evidence.num_rollouts = 32;
  imagined.why = "slow is best";
  report.status.imaginations = {imagined};
  return report;
}

TEST(TimelineTest, CountsFromTheFirstBeginImaginationsAboveThenStepsByTheirBegin) {
  const Timeline timeline = MakeTimeline(Report());
  ASSERT_THAT(timeline.bars, SizeIs(3));
  EXPECT_EQ(timeline.duration, 40.0);
  EXPECT_EQ(timeline.bars[0].kind, TimelineBar::Kind::kImagination);
  EXPECT_EQ(timeline.bars[0].end, 8.0);
  EXPECT_EQ(timeline.bars[0].deadline, 19.5);
  EXPECT_EQ(timeline.bars[1].action, "pick_up(mug1)");
  EXPECT_EQ(timeline.bars[1].begin, 2.0);
  EXPECT_EQ(timeline.bars[2].end, 40.0);
}

TEST(TimelineTest, WhatStillRunsEndsNow) {
  loop::AchieveReport report = Report();
  report.status.steps[0].finished.reset();
  report.status.imaginations[0].answered.reset();
  report.status.now = 1050.0;
  const Timeline timeline = MakeTimeline(report);
  EXPECT_EQ(timeline.bars[0].end, 50.0);
  EXPECT_EQ(timeline.bars[2].end, 50.0);
}

TEST(TimelineTest, AStepThatOnlyHasAnotherOneImaginedIsLeftOut) {
  loop::AchieveReport report = Report();
  report.status.steps.push_back(Step(2, {"imagine", {"!move_base_param"}}, 1000.0, 1008.0));
  EXPECT_THAT(MakeTimeline(report).bars, SizeIs(3));
}

TEST(TimelineTest, NothingDoneIsAnEmptyTimeline) {
  const Timeline timeline = MakeTimeline({});
  EXPECT_THAT(timeline.bars, SizeIs(0));
  EXPECT_EQ(timeline.duration, 0.0);
  EXPECT_EQ(TimelineText(timeline), "");
}

TEST(TimelineTextTest, BarsStandWhereTheirTimeIs) {
  const std::vector<std::string> lines =
      base::Split(TimelineText(MakeTimeline(Report()), 40), '\n');
  ASSERT_THAT(lines, SizeIs(4));  // the last one is empty
  EXPECT_THAT(lines[0], StartsWith("~ move_base_param(area1, slow|fast)"));
  EXPECT_THAT(lines[0], HasSubstr("|~~~~~~~~                                |"));
  EXPECT_THAT(lines[1], HasSubstr("|  ##########                            |"));
  EXPECT_THAT(lines[2], StartsWith("> move_base_param(area1, slow)"));
  EXPECT_THAT(lines[2], HasSubstr("|                    ####################|"));
}

TEST(TimelineTextTest, AMomentIsOneCharacter) {
  loop::AchieveReport report = Report();
  report.status.steps[0].started = report.status.steps[0].finished;
  const std::vector<std::string> lines = base::Split(TimelineText(MakeTimeline(report), 40), '\n');
  EXPECT_THAT(lines[2], HasSubstr("|                                       #|"));
}

TEST(TimelineCsvTest, IsAWholeText) {
  EXPECT_EQ(TimelineCsv(MakeTimeline(Report())),
            "kind,plan,index,action,outcome,begin,end,deadline,dispatch,wall_seconds,"
            "simulated_seconds,note\n"
            "task,,,\"carry \"\"it\"\", please\",succeeded,0.000,40.000,,,,,\n"
            "imagination,0,1,\"move_base_param(area1, slow|fast)\",ranked,0.000,8.000,19.500,"
            "20.000,4.000,800.000,slow is best\n"
            "step,0,0,pick_up(mug1),done,2.000,12.000,,,,,\n"
            "step,0,1,\"move_base_param(area1, slow)\",done,20.000,40.000,,,,,\n");
}

TEST(ImaginationTableTest, SetsSimulatedAgainstWallSecondsAndTellsWhetherItCameInTime) {
  const std::string table = ImaginationTable(Report());
  for (const char* text : {"64", "800.0 s", "4.0 s", "200.00", "0.10", "+12.0 s"}) {
    EXPECT_THAT(table, HasSubstr(text));
  }
  EXPECT_EQ(ImaginationTable({}), "");
}

TEST(TimelineJsonTest, HoldsStepsAndImaginations) {
  const auto json = ToJson(Report());
  EXPECT_EQ(json["outcome"], "succeeded");
  EXPECT_EQ(json["duration"], 40.0);
  EXPECT_EQ(json["steps"][0]["arguments"][1], "slow");
  EXPECT_TRUE(json["steps"][0]["latest_start"].is_null());
  EXPECT_EQ(json["imaginations"][0]["predictions"][1]["rollouts"], 32);
  ASSERT_EQ(json["timeline"].size(), 3u);
  EXPECT_EQ(json["timeline"][0]["kind"], "imagination");
  EXPECT_EQ(json["timeline"][0]["dispatch"], 20.0) << "from the task's begin";
  EXPECT_EQ(json["timeline"][1]["kind"], "step");
  EXPECT_TRUE(json["timeline"][1]["dispatch"].is_null());
}

}  // namespace
}  // namespace hires::reports::timeline_test
