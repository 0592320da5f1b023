#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "lab/src/experiment/hypothesis.h"
#include "lab/test/hypothesis_examples.h"
#include "sim_robot/scenario.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_hypothesis_test {
namespace {

using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;
const std::string kFile = kRoot + "/lab/config/hypothesis.yaml";

constexpr double kTop = 0.73;  // [m]

/// A thing that stands x, y from the middle of the guest's place.
simulation::ObjectFate Standing(double x = 0.0, double y = 0.0, double z = kTop) {
  simulation::ObjectFate object;
  object.X_MO = geometry::Lift({4.0 + x, 2.0 + y, 0.3}, z);
  object.stands = true;
  return object;
}

const Eigen::AlignedBox2d kSquare(Eigen::Vector2d(-0.14, -0.14), Eigen::Vector2d(0.14, 0.14));
const WantedPlace kPlace{"placingareawest", geometry::Lift({4.0, 2.0, 0.0}, kTop), kSquare};

TEST(StandsAtTest, NeedsToStandOverTheSquareAndLetGo) {
  EXPECT_TRUE(StandsAt(kPlace, Standing()));
  EXPECT_TRUE(StandsAt(kPlace, Standing(0.139, -0.139)));
  EXPECT_FALSE(StandsAt(kPlace, Standing(0.141, 0.0))) << "beside it";
  EXPECT_FALSE(StandsAt(kPlace, Standing(0.0, -0.141))) << "beside it";
  EXPECT_FALSE(StandsAt(kPlace, Standing(0.0, 0.0, kTop + 0.021))) << "on something else";
  EXPECT_FALSE(StandsAt(kPlace, Standing(0.0, 0.0, 0.0))) << "on the floor below";
  simulation::ObjectFate held = Standing();
  held.attached_to = "l_gripper_palm_link";
  EXPECT_FALSE(StandsAt(kPlace, held));
  simulation::ObjectFate down = Standing();
  down.stands = false;
  EXPECT_FALSE(StandsAt(kPlace, down));
}

TEST(StandsAtTest, ThePlaceMayBeTurned) {
  const WantedPlace turned{"turned", geometry::Lift({4.0, 2.0, M_PI / 4}, kTop), kSquare};
  EXPECT_TRUE(StandsAt(turned, Standing(0.19, 0.0))) << "0.14 times the square root of 2 is 0.198";
  EXPECT_FALSE(StandsAt(turned, Standing(0.139, 0.139)));
}

// ----------------------------------------------------------------------------------- the judge

/// A run that broke no rule: its mug stands at the guest's place, a book and another mug elsewhere.
struct JudgeTest : ::testing::Test {
  JudgeTest() {
    goal.objects = {"mug1", "mug2"};
    goal.areas = {kPlace.name};
    truth.objects = {{"mug1", Standing()}, {"mug2", Standing(2.0)}, {"book1", Standing(2.0, 1.0)}};
  }
  HypothesisRun Judged() const {
    HypothesisRun run;
    run.broken_rules = {"of another run"};
    Judge(goal, {kPlace}, truth, &run);
    EXPECT_EQ(run.success, run.broken_rules.empty());
    return run;
  }
  HypothesisGoal goal;
  simulation::RunTruth truth;
};

TEST_F(JudgeTest, OneOfTheObjectsAtThePlaceIsSuccess) {
  const HypothesisRun run = Judged();
  EXPECT_TRUE(run.success);
  EXPECT_EQ(run.verdict, "mug1 stands on placingareawest");
  EXPECT_EQ(run.falls, 0);
  truth.objects["mug2"] = Standing(0.1);
  truth.objects["mug1"] = Standing(2.0);
  EXPECT_TRUE(Judged().success) << "either of them";
}

TEST_F(JudgeTest, AFallOfTheThingBreaksARule) {
  truth.objects["mug1"].falls = 1;
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("fell"));
  EXPECT_EQ(run.verdict, "mug1 stands on placingareawest, mug1 fell");
  EXPECT_EQ(run.falls, 1);
}

TEST_F(JudgeTest, AnythingElseThatFellWasKnockedOver) {
  truth.objects["book1"].falls = 2;
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("knocked_over"));
  EXPECT_THAT(run.verdict, HasSubstr("book1 knocked over"));
  EXPECT_EQ(run.falls, 2);
}

TEST_F(JudgeTest, ACollisionOfTheRobotBreaksARule) {
  truth.contact = "l_forearm touches Table1";
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("touched"));
  EXPECT_EQ(run.contact, truth.contact);
  EXPECT_THAT(run.verdict, HasSubstr("l_forearm touches Table1"));
}

TEST_F(JudgeTest, AThingInTheHandBreaksARule) {
  truth.objects["mug1"].attached_to = "l_gripper_palm_link";
  truth.objects["mug1"].stands = false;
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("held"));
  EXPECT_EQ(run.verdict, "mug1 is held by l_gripper_palm_link");
}

TEST_F(JudgeTest, AnotherGuestsPlaceIsNotThere) {
  truth.objects["mug1"] = Standing(0.41);  // the guest opposite, on the same table
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("not_there"));
  EXPECT_EQ(run.verdict, "no mug1 or mug2 stands on placingareawest");
}

TEST_F(JudgeTest, AThingThatIsGoneIsNotThere) {
  truth.objects.clear();
  EXPECT_THAT(Judged().broken_rules, ElementsAre("not_there"));
}

TEST_F(JudgeTest, EveryBrokenRuleIsTold) {
  truth.objects["mug1"] = Standing(0.0, 0.0, 0.0);
  truth.objects["mug1"].falls = 1;
  truth.objects["mug1"].stands = false;
  truth.objects["book1"].falls = 1;
  truth.contact = "base touches Chair3";
  const HypothesisRun run = Judged();
  EXPECT_THAT(run.broken_rules, ElementsAre("not_there", "fell", "knocked_over", "touched"));
  EXPECT_EQ(run.falls, 2);
}

TEST(PlacesOfTest, AnUnknownAreaIsNamed) {
  world::World room;
  room.name = "room";
  room.frames["placingareawest"] = kPlace.X_MA;
  room.frame_names["placingareawest"] = "placingAreaWest";
  HypothesisGoal goal;
  goal.areas = {"placingareawest"};
  ASSERT_THAT(PlacesOf(goal, room, 0.075), SizeIs(1));
  EXPECT_NEAR(PlacesOf(goal, room, 0.075)[0].extent_A.max().y(), 0.1, 1e-12);
  room.extents["placingareawest"] = kSquare;
  EXPECT_NEAR(PlacesOf(goal, room, 0.02)[0].extent_A.max().y(), 0.12, 1e-12) << "as the world says";
  goal.areas = {"placingareawset"};
  EXPECT_THAT(ErrorOf([&] { PlacesOf(goal, room, 0.035); }),
              AllOf(HasSubstr("room"), HasSubstr("did you mean 'placingAreaWest'")));
}

// Both scenarios begin unfinished, and the objects and areas that decide are there.
TEST(HypothesisScenariosTest, NoScenarioBeginsWithSuccess) {
  const auto world =
      world::LoadWorld(imagination::ReadSetupConfig(kRoot + "/config/scene.yaml").world);
  for (const std::string scenario : {"topple", "serve_coffee"}) {
    const HypothesisGoal goal = ReadHypothesisGoal(kFile, scenario);
    simulation::RunTruth truth;
    for (const auto& object :
         sim_robot::ReadScenario(kRoot + "/config/scenarios/" + scenario + ".yaml").objects) {
      simulation::ObjectFate& fate = truth.objects[base::ToLower(object.name)];
      fate.X_MO = object.X_MO;
      fate.stands = true;
    }
    for (const std::string& object : goal.objects) {
      EXPECT_EQ(truth.objects.count(object), 1U) << scenario << ": " << object;
    }
    HypothesisRun run;
    Judge(goal, PlacesOf(goal, world, 0.035), truth, &run);
    EXPECT_THAT(run.broken_rules, ElementsAre("not_there")) << scenario;
  }
}

TEST(HypothesisScenariosTest, TheCoffeesPlacesAreTheGuestsOwn) {
  const std::string domain = base::ReadTextFile(kRoot + "/config/domains/restaurant.lisp");
  for (const std::string& area : ReadHypothesisGoal(kFile, "serve_coffee").areas) {
    EXPECT_TRUE(domain.find("(hasPlacingAreaRight sittingareawesttable1 " + area + ")") !=
                    std::string::npos ||
                domain.find("(hasPlacingAreaLeft sittingareawesttable1 " + area + ")") !=
                    std::string::npos)
        << area;
  }
}

TEST(CountReportTest, CountsStepsAndAnswersInTime) {
  loop::AchieveReport report;
  report.outcome = loop::AchieveOutcome::kSucceeded;
  report.status.replans = 2;
  report.status.now = 60.0;
  report.status.steps.resize(3);
  report.status.steps[0].started = 10.0;
  report.status.steps[0].finished = 30.0;
  report.status.steps[1].started = 30.0;
  report.status.steps[1].finished = 50.0;
  loop::ImaginedStep in_time;
  in_time.outcome = loop::ImaginedOutcome::kRanked;
  in_time.requested = 11.0;
  in_time.answered = 20.0;
  in_time.dispatch = 30.0;
  in_time.wall_seconds = 4.0;
  in_time.recommended = 0;
  in_time.predictions.resize(1);
  in_time.predictions[0].action = {"move_base_param", {"area1", "slow"}};
  loop::ImaginedStep late = in_time, given_up = in_time, refused = in_time, asked_first = in_time;
  late.step = 1;
  late.dispatch = 35.0;
  late.answered = 36.0;
  late.recommended = -1;
  given_up.step = 2;
  given_up.dispatch.reset();
  refused.step = 3;
  refused.dispatch = 40.0;
  refused.predictions.clear();
  refused.outcome = loop::ImaginedOutcome::kInvalid;
  asked_first.plan = -1;  // the same step, before a repair took it over
  asked_first.outcome = loop::ImaginedOutcome::kCancelled;
  loop::ImaginedStep thrown_away = in_time, asked_in_vain = in_time;
  thrown_away.dispatch = asked_in_vain.dispatch = 45.0;
  asked_in_vain.outcome = loop::ImaginedOutcome::kCancelled;
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
  EXPECT_THAT(broken("[placingAreaWestRightTable1, placingAreaWestLeftTable1]", "[]"),
              HasSubstr("areas"));
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

// Pair 1 succeeds twice, 4 s apart; pair 2 in one arm alone, 6 s apart; pair 3 twice, 2 s apart.
TEST(HypothesisReportTest, DurationsOfRunsThatFailedStandApart) {
  std::vector<HypothesisRun> runs;
  for (int run = 1; run <= 3; ++run) {
    runs.push_back(RecordOf(run, true, true));
    runs.push_back(RecordOf(run, false, run != 2));
    runs.back().duration += run == 1 ? 4.0 : run == 2 ? -6.0 : 2.0;
  }
  const auto json = ToJson(SumUpHypothesis(Setting(3), runs), "hires_lab experiment hypothesis");
  EXPECT_EQ(json["paired_duration"]["pairs"], 3);
  EXPECT_DOUBLE_EQ(json["paired_duration"]["mean"], 0.0);
  EXPECT_EQ(json["paired_duration_of_successes"]["pairs"], 2);
  EXPECT_DOUBLE_EQ(json["paired_duration_of_successes"]["mean"], -3.0);
}

TEST(SumUpHypothesisTest, AMissingRunIsNoReport) {
  EXPECT_THROW(SumUpHypothesis(Setting(2), {RecordOf(1, true, true), RecordOf(1, false, true)}),
               std::logic_error);
}

TEST(HypothesisReportTest, SaysTheSameToMachines) {
  const HypothesisReport report =
      SumUpHypothesis(Setting(1), {RecordOf(1, true, true), RecordOf(1, false, false)});
  const auto json = ToJson(report, "hires_lab experiment hypothesis");
  EXPECT_EQ(json["runs"], 1);
  EXPECT_EQ(json["pace"], 4.0);
  EXPECT_EQ(json["with_imagination"]["successes"], 1);
  EXPECT_EQ(json["without_imagination"]["falls"], 1);
  EXPECT_EQ(json["without_imagination"]["broken_rules"]["not_there"], 1);
  EXPECT_EQ(json["with_imagination"]["broken_rules"]["not_there"], 0);
  EXPECT_EQ(json["list"][1]["broken_rules"][0], "not_there");
  EXPECT_EQ(json["without_imagination"]["duration"]["mean"], 110.0);
  EXPECT_EQ(json["with_imagination"]["steps"], 12.0);
  EXPECT_EQ(json["paired_difference"]["mean"], 1.0);
  EXPECT_LT(json["paired_difference"]["lower"], json["paired_difference"]["upper"]);
  EXPECT_THAT(json["list"], SizeIs(2));
  const auto lines = base::Split(HypothesisCsv(report), '\n');
  ASSERT_THAT(lines, SizeIs(4));  // head, two runs, end
  EXPECT_THAT(lines[0], HasSubstr("run,imagination,seed"));
  EXPECT_THAT(lines[1], HasSubstr("move_base_param(area1, slow); none"));
  EXPECT_THAT(lines[2], HasSubstr("not_there"));
  EXPECT_THAT(HypothesisText(report), HasSubstr("rule       with  without"));
  EXPECT_THAT(HypothesisText(report), HasSubstr("not_there     0        1"));
}

}  // namespace
}  // namespace hires::lab::experiment_hypothesis_test
