#include "hires/evaluation/experiment_hypothesis.h"

#include <gmock/gmock.h>

#include <cmath>

#include "evaluation/hypothesis_examples.h"
#include "hires/base/text.h"
#include "hires/evaluation/scenario.h"
#include "hires/imagination/imagination_setup.h"
#include "support/temporary_folder.h"

namespace hires::evaluation {
namespace {

using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;
const std::string kFile = kRoot + "/config/hypothesis.yaml";

world::StaticBody Table() {
  world::StaticBody table;
  table.name = "Table1";
  table.X_MB = geometry::Lift({4.0, 2.0, 0.0});
  const auto part = [&](const geometry::Box& box, double z) {
    geometry::Collision collision;
    collision.shape = box;
    collision.X_BS = geometry::Lift({0.0, 0.0, 0.0}, z);
    table.collisions.push_back(collision);
  };
  part({{0.1, 0.1, 0.7}}, 0.35);
  part({{1.0, 0.6, 0.04}}, 0.72);
  return table;
}

world::ObjectState Mug(double x, double y, double z) {
  world::ObjectState mug;
  mug.name = "Mug1";
  mug.model = "mug";
  mug.X_MO = geometry::Lift({x, y, 0.3}, z);
  return mug;
}

TEST(StandsOnTest, NeedsToBeUprightOverTheTopAndLetGo) {
  const world::StaticBody table = Table();
  EXPECT_TRUE(StandsOn(table, Mug(4.4, 2.2, 0.741)));
  EXPECT_FALSE(StandsOn(table, Mug(4.6, 2.2, 0.741))) << "beside the table";
  EXPECT_FALSE(StandsOn(table, Mug(4.4, 2.2, 0.80))) << "above it";
  EXPECT_FALSE(StandsOn(table, Mug(4.4, 2.2, 0.0))) << "below it";
  world::ObjectState mug = Mug(4.4, 2.2, 0.741);
  mug.attached_to = "l_gripper_palm_link";
  EXPECT_FALSE(StandsOn(table, mug)) << "held";
  mug = Mug(4.4, 2.2, 0.741);
  mug.X_MO.rotation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  EXPECT_FALSE(StandsOn(table, mug)) << "tilted";
}

HypothesisGoal MugGoal() {
  HypothesisGoal goal;
  goal.objects = {"mug1", "mug2"};
  goal.furniture = "table1";
  return goal;
}

world::World Room() {
  world::World room;
  room.name = "room";
  room.statics = {Table()};
  return room;
}

TEST(JudgeTest, OneOfTheObjectsOnTheFurnitureIsSuccess) {
  RunTruth truth;
  truth.state.objects = {Mug(4.0, 2.0, 0.74)};
  truth.falls = {{"mug1", 0}, {"book1", 1}};
  HypothesisRun run;
  Judge(MugGoal(), Room(), truth, &run);
  EXPECT_TRUE(run.success);
  EXPECT_EQ(run.verdict, "mug1 stands on table1");
  EXPECT_EQ(run.falls, 1) << "of whatever was there";
}

TEST(JudgeTest, AFallOnTheWaySpoilsIt) {
  RunTruth truth;
  truth.state.objects = {Mug(4.0, 2.0, 0.74)};
  truth.falls = {{"Mug1", 1}};
  HypothesisRun run;
  Judge(MugGoal(), Room(), truth, &run);
  EXPECT_FALSE(run.success);
  EXPECT_EQ(run.verdict, "mug1 stands on table1, Mug1 fell");
}

TEST(JudgeTest, AnObjectElsewhereOrGoneIsNoSuccess) {
  RunTruth truth;
  HypothesisRun run;
  Judge(MugGoal(), Room(), truth, &run);
  EXPECT_FALSE(run.success);
  EXPECT_EQ(run.verdict, "no mug1 or mug2 stands on table1");
}

TEST(JudgeTest, UnknownFurnitureIsNamed) {
  HypothesisGoal goal = MugGoal();
  goal.furniture = "tabel1";
  HypothesisRun run;
  EXPECT_THAT(ErrorOf([&] { Judge(goal, Room(), {}, &run); }),
              AllOf(HasSubstr("tabel1"), HasSubstr("did you mean 'Table1'")));
}

// Both scenarios begin unfinished, and the objects and furniture that decide are there.
TEST(JudgeTest, NoScenarioBeginsWithSuccess) {
  const auto world =
      world::LoadWorld(imagination::ReadSetupConfig(kRoot + "/config/scene.yaml").world);
  for (const std::string scenario : {"topple", "serve_coffee"}) {
    const HypothesisGoal goal = ReadHypothesisGoal(kFile, scenario);
    RunTruth truth;
    for (const auto& object :
         ReadScenario(kRoot + "/config/scenarios/" + scenario + ".yaml").objects) {
      truth.state.objects.push_back({object.name, object.model, object.X_MO, {}, ""});
    }
    for (const std::string& object : goal.objects) {
      EXPECT_NE(truth.state.Find(object), nullptr) << scenario << ": " << object;
    }
    HypothesisRun run;
    Judge(goal, world, truth, &run);
    EXPECT_FALSE(run.success) << scenario;
  }
}

TEST(CountReportTest, CountsStepsAndAnswersInTime) {
  AchieveReport report;
  report.outcome = AchieveOutcome::kSucceeded;
  report.status.replans = 2;
  report.status.now = 60.0;
  report.status.steps.resize(3);
  report.status.steps[0].started = 10.0;
  report.status.steps[0].finished = 30.0;
  report.status.steps[1].started = 30.0;
  report.status.steps[1].finished = 50.0;
  ImaginedStep in_time;
  in_time.outcome = ImaginedOutcome::kRanked;
  in_time.requested = 11.0;
  in_time.answered = 20.0;
  in_time.dispatch = 30.0;
  in_time.wall_seconds = 4.0;
  in_time.recommended = 0;
  in_time.predictions.resize(1);
  in_time.predictions[0].action = {"move_base_param", {"area1", "slow"}};
  ImaginedStep late = in_time, given_up = in_time, refused = in_time, asked_first = in_time;
  late.step = 1;
  late.dispatch = 35.0;
  late.answered = 36.0;
  late.recommended = -1;
  given_up.step = 2;
  given_up.dispatch.reset();
  refused.step = 3;
  refused.dispatch = 40.0;
  refused.predictions.clear();
  refused.outcome = ImaginedOutcome::kInvalid;
  asked_first.plan = -1;  // the same step, before a repair took it over
  asked_first.outcome = ImaginedOutcome::kCancelled;
  ImaginedStep thrown_away = in_time, asked_in_vain = in_time;
  thrown_away.dispatch = asked_in_vain.dispatch = 45.0;
  asked_in_vain.outcome = ImaginedOutcome::kCancelled;
  report.status.imaginations = {asked_first, in_time,     late,         given_up,
                                refused,     thrown_away, asked_in_vain};
  HypothesisRun run;
  CountReport(report, &run);
  EXPECT_EQ(run.outcome, "succeeded");
  EXPECT_EQ(run.duration, 40.0);
  EXPECT_EQ(run.steps, 2);
  EXPECT_EQ(run.replans, 2);
  EXPECT_EQ(run.imaginations, 7);
  EXPECT_EQ(run.dispatched, 4) << "steps, not requests";
  EXPECT_EQ(run.in_time, 1);
  EXPECT_EQ(run.imagination_wall, 28.0);
  ASSERT_THAT(run.recommended, SizeIs(7));
  EXPECT_THAT(run.recommended[1], HasSubstr("slow"));
  EXPECT_EQ(run.recommended[2], "none");
}

TEST(HypothesisGoalTest, UnknownScenariosAndBadFilesAreNamed) {
  EXPECT_THAT(ErrorOf([] { ReadHypothesisGoal(kFile, "topple_it"); }),
              AllOf(HasSubstr("hypothesis.yaml"), HasSubstr("did you mean 'topple'")));
  const TemporaryFolder folder;
  const std::string text = base::ReadTextFile(kFile);
  const auto broken = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    const std::string path = folder.Write("hypothesis.yaml", changed);
    return ErrorOf([&] { ReadHypothesisGoal(path, "topple"); });
  };
  EXPECT_THAT(broken("[peppermill1]", "[]"), HasSubstr("objects"));
  EXPECT_THAT(broken("start_limit: 180.0", "start_limit: -1"), HasSubstr("start_limit"));
  EXPECT_THAT(broken("start_limit", "strat_limit"), HasSubstr("start_limit"));
  EXPECT_THAT(broken("time_limit: 1500.0", "time_limit: soon"), HasSubstr("time_limit"));
}

TEST(SeedOfRunTest, FitsIntoAParameterAndDiffersByRun) {
  EXPECT_EQ(SeedOfRun(7, 3), SeedOfRun(7, 3));
  EXPECT_NE(SeedOfRun(7, 3), SeedOfRun(7, 4));
  EXPECT_NE(SeedOfRun(7, 3), SeedOfRun(8, 3));
  for (int run = 1; run <= 100; ++run) EXPECT_LT(SeedOfRun(1, run), 1ULL << 31);
}

// Hand-worked: 4 pairs, with: 4 of 4, without: 1 of 4.
TEST(SumUpHypothesisTest, CountsPairsMeansAndFalls) {
  std::vector<HypothesisRun> runs;
  for (int run = 4; run >= 1; --run) {
    runs.push_back(RecordOf(run, false, run == 2));
    runs.push_back(RecordOf(run, true, true));
  }
  const HypothesisReport report = SumUpHypothesis(Setting(4), runs);
  EXPECT_EQ(report.with.successes, 4);
  EXPECT_EQ(report.without.successes, 1);
  EXPECT_EQ(report.with.falls, 0);
  EXPECT_EQ(report.without.falls, 3);
  EXPECT_DOUBLE_EQ(report.with.duration_mean, 125.0);
  EXPECT_DOUBLE_EQ(report.with.duration_sd, std::sqrt(125.0));  // (15^2 + 5^2 + 5^2 + 15^2) / 4
  EXPECT_DOUBLE_EQ(report.with.steps, 12.0);
  EXPECT_EQ(report.pairs.only_first, 3);
  EXPECT_EQ(report.pairs.only_second, 0);
  EXPECT_DOUBLE_EQ(report.difference.estimate, 0.75);
  EXPECT_EQ(report.runs.front().run, 1);
  EXPECT_TRUE(report.runs.front().imagines);
}

TEST(SumUpHypothesisTest, ARunThatBrokeDownCountsAsFailedButNotForMeans) {
  std::vector<HypothesisRun> runs{RecordOf(1, true, true), RecordOf(1, false, true),
                                  RecordOf(2, true, true)};
  HypothesisRun broken;
  broken.run = 2;
  broken.imagines = false;
  broken.outcome = "system_died";
  runs.push_back(broken);
  const HypothesisReport report = SumUpHypothesis(Setting(2), runs);
  EXPECT_EQ(report.without.runs, 2);
  EXPECT_EQ(report.without.complete, 1);
  EXPECT_EQ(report.without.successes, 1);
  EXPECT_DOUBLE_EQ(report.without.duration_mean, 110.0);
  EXPECT_DOUBLE_EQ(report.difference.estimate, 0.5);
  EXPECT_THAT(HypothesisText(report), HasSubstr("1 x without imagination: system_died"));
}

TEST(SumUpHypothesisTest, AMissingRunIsNoReport) {
  EXPECT_THROW(SumUpHypothesis(Setting(2), {RecordOf(1, true, true), RecordOf(1, false, true)}),
               std::logic_error);
}

TEST(HypothesisReportTest, SaysTheSameToMachines) {
  const HypothesisReport report =
      SumUpHypothesis(Setting(1), {RecordOf(1, true, true), RecordOf(1, false, false)});
  const auto json = ToJson(report, "hires experiment hypothesis");
  EXPECT_EQ(json["runs"], 1);
  EXPECT_EQ(json["pace"], 4.0);
  EXPECT_EQ(json["with_imagination"]["successes"], 1);
  EXPECT_EQ(json["without_imagination"]["falls"], 1);
  EXPECT_EQ(json["without_imagination"]["duration"]["mean"], 110.0);
  EXPECT_EQ(json["with_imagination"]["steps"], 12.0);
  EXPECT_EQ(json["paired_difference"]["mean"], 1.0);
  EXPECT_LT(json["paired_difference"]["lower"], json["paired_difference"]["upper"]);
  EXPECT_THAT(json["list"], SizeIs(2));
  const auto lines = base::Split(HypothesisCsv(report), '\n');
  ASSERT_THAT(lines, SizeIs(4));  // head, two runs, end
  EXPECT_THAT(lines[0], HasSubstr("run,imagination,seed"));
  EXPECT_THAT(lines[1], HasSubstr("move_base_param(area1, slow); none"));
}

}  // namespace
}  // namespace hires::evaluation
