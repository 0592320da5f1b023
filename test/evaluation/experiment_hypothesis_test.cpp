#include "hires/evaluation/experiment_hypothesis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/evaluation/command_line.h"
#include "hires/evaluation/experiment_hypothesis_command.h"
#include "hires/evaluation/experiment_hypothesis_journal.h"
#include "hires/evaluation/experiment_hypothesis_report.h"
#include "hires/evaluation/scenario.h"
#include "hires/imagination/imagination_setup.h"
#include "support/temporary_folder.h"

namespace hires::evaluation {
namespace {

using base::ConfigError;
using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;
const std::string kFile = kRoot + "/config/experiments/hypothesis.yaml";

/// What `act` complains about.
template <typename Act>
std::string ErrorOf(const Act& act) {
  try {
    act();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

HypothesisRun RecordOf(int run, bool imagines, bool success, std::uint64_t seed = 1) {
  HypothesisRun record;
  record.run = run;
  record.imagines = imagines;
  record.seed = SeedOfRun(seed, run);
  record.is_complete = true;
  record.outcome = success ? "succeeded" : "failed";
  record.success = success;
  record.verdict = success ? "mug1 stands on table1" : "no mug1 stands on table1";
  record.falls = success ? 0 : 1;
  record.duration = 100.0 + 10.0 * run;
  record.steps = imagines ? 12 : 10;
  record.recommended = {"move_base_param(area1, slow)", "none"};
  return record;
}

HypothesisSetting Setting(int runs) { return {"topple", runs, 1, 4.0, 2, "0123456789abcdef"}; }

// --- what success is -----------------------------------------------------------------------------

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
  in_time.requested = 11.0;
  in_time.answered = 20.0;
  in_time.dispatch = 30.0;
  in_time.wall_seconds = 4.0;
  in_time.recommended = 0;
  in_time.predictions.resize(1);
  in_time.predictions[0].action = {"move_base_param", {"area1", "slow"}};
  ImaginedStep late = in_time, given_up = in_time;
  late.answered = 31.0;
  late.recommended = -1;
  given_up.dispatch.reset();
  report.status.imaginations = {in_time, late, given_up};
  HypothesisRun run;
  CountReport(report, &run);
  EXPECT_EQ(run.outcome, "succeeded");
  EXPECT_EQ(run.duration, 40.0);
  EXPECT_EQ(run.steps, 2);
  EXPECT_EQ(run.replans, 2);
  EXPECT_EQ(run.imaginations, 3);
  EXPECT_EQ(run.dispatched, 2);
  EXPECT_EQ(run.in_time, 1);
  EXPECT_EQ(run.imagination_wall, 12.0);
  ASSERT_THAT(run.recommended, SizeIs(3));
  EXPECT_THAT(run.recommended[0], HasSubstr("slow"));
  EXPECT_EQ(run.recommended[1], "none");
}

// --- the goal's file -----------------------------------------------------------------------------

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

// --- the journal ---------------------------------------------------------------------------------

class HypothesisJournalTest : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "runs.journal").string(); }
  std::string Text() const { return base::ReadTextFile(path()); }
  void Overwrite(const std::string& text) const {
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << text;
  }
  void WriteTwoRuns() const {
    HypothesisJournal journal(path(), Setting(4));
    journal.Append(RecordOf(1, true, true));
    journal.Append(RecordOf(1, false, false));
  }
  std::string ErrorWith(const HypothesisSetting& setting) const {
    return ErrorOf([&] { HypothesisJournal(path(), setting); });
  }

  TemporaryFolder folder_;
};

TEST_F(HypothesisJournalTest, GoesOnWithWhatIsThere) {
  WriteTwoRuns();
  const HypothesisJournal journal(path(), Setting(4));
  ASSERT_THAT(journal.runs(), SizeIs(2));
  EXPECT_EQ(ToJson(journal.runs()[0]), ToJson(RecordOf(1, true, true)));
  EXPECT_EQ(ToJson(journal.runs()[1]), ToJson(RecordOf(1, false, false)));
  EXPECT_TRUE(journal.Has(1, false));
  EXPECT_FALSE(journal.Has(2, true));
}

TEST_F(HypothesisJournalTest, DropsALineThatWasCutOffAnywhere) {
  WriteTwoRuns();
  const std::string whole = Text();
  const std::size_t head = whole.find('\n') + 1;
  const std::size_t second = whole.find('\n', head) + 1;
  for (std::size_t size = 1; size < whole.size(); size += 7) {
    Overwrite(whole.substr(0, size));
    {
      HypothesisJournal journal(path(), Setting(4));
      ASSERT_THAT(journal.runs(), SizeIs(size >= second ? 1 : 0)) << size;
      if (!journal.Has(1, true)) journal.Append(RecordOf(1, true, true));
      journal.Append(RecordOf(1, false, false));
    }
    EXPECT_EQ(Text(), whole) << size;
  }
}

TEST_F(HypothesisJournalTest, RefusesOtherArguments) {
  WriteTwoRuns();
  const std::string before = Text();
  HypothesisSetting other = Setting(4);
  other.seed = 2;
  EXPECT_THAT(ErrorWith(other), AllOf(HasSubstr(path()), HasSubstr("seed 1, now it is 2")));
  other = Setting(4);
  other.pace = 1.0;
  EXPECT_THAT(ErrorWith(other), HasSubstr("pace 4.0, now it is 1.0"));
  other = Setting(4);
  other.files = "f";
  EXPECT_THAT(ErrorWith(other), HasSubstr("files"));
  EXPECT_THAT(ErrorWith(Setting(5)), HasSubstr("runs 4, now it is 5"));
  EXPECT_EQ(Text(), before) << "what is there stays";
}

TEST_F(HypothesisJournalTest, RefusesWhatIsBrokenElsewhereThanAtItsEnd) {
  WriteTwoRuns();
  std::string text = Text();
  text.insert(text.find('\n') + 1, "{\"run\": 1}\n");
  Overwrite(text);
  EXPECT_THAT(ErrorWith(Setting(4)), AllOf(HasSubstr("line 2"), HasSubstr("'imagination'")));
  Overwrite("a letter to a friend\n");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
  Overwrite("a letter to a friend");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
  EXPECT_EQ(Text(), "a letter to a friend") << "another's file stays whole";
  Overwrite("{\"journal\": 7}\n");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
}

TEST_F(HypothesisJournalTest, RefusesARunThatIsThereTwice) {
  WriteTwoRuns();
  const std::string text = Text();
  Overwrite(text + text.substr(text.find('\n') + 1));
  EXPECT_THAT(ErrorWith(Setting(4)), AllOf(HasSubstr("line 4"), HasSubstr("twice")));
}

TEST_F(HypothesisJournalTest, HasOneWriterAtATime) {
  const HypothesisJournal journal(path(), Setting(4));
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("another run of this experiment writes to it"));
}

// --- statistics and report -----------------------------------------------------------------------

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

// --- the command ---------------------------------------------------------------------------------

struct Ended {
  int code{0};
  std::string out, err;
};

Ended RunWith(const std::vector<std::string>& words, const PlayHypothesis& play = {}) {
  std::vector<std::string> arguments{"hires", "experiment", "hypothesis"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  Backends backends;
  backends.package_folder = kRoot;
  backends.play_hypothesis = play;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Ended ended;
  ended.code = RunCommandLine(arguments, backends);
  ended.out = ::testing::internal::GetCapturedStdout();
  ended.err = ::testing::internal::GetCapturedStderr();
  return ended;
}

/// Succeeds with imagination, and without in odd runs; remembers what it was asked.
class FakePlayer {
 public:
  std::optional<HypothesisRun> operator()(const HypothesisOrder& order) {
    if (static_cast<int>(orders.size()) == stop_after) return std::nullopt;
    orders.push_back(order);
    HypothesisRun run = RecordOf(0, false, order.imagines || order.run % 2 == 1);
    if (order.run == dies_in) {
      run = {};
      run.outcome = "system_died";
      run.success = true;  // whatever a broken run says
    }
    return run;
  }
  PlayHypothesis AsPlay() {
    return [this](const HypothesisOrder& order, const std::function<bool()>&) {
      return (*this)(order);
    };
  }

  std::vector<HypothesisOrder> orders;
  int stop_after{-1};
  int dies_in{-1};
};

class HypothesisCommandTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return (folder_.path() / name).string(); }
  std::vector<std::string> Words(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"--scenario", "topple",  "--runs", "4",
                                   "--resume",   File("j"), "--json", File("report.json")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  nlohmann::json Report() const {
    return nlohmann::json::parse(base::ReadTextFile(File("report.json")));
  }

  TemporaryFolder folder_;
};

TEST_F(HypothesisCommandTest, PlaysEveryRunInBothArmsOnTheSameSeed) {
  FakePlayer player;
  const Ended ended = RunWith(Words({"--csv", File("runs.csv")}), player.AsPlay());
  EXPECT_EQ(ended.code, kExitRecommended) << ended.err;
  ASSERT_THAT(player.orders, SizeIs(8));
  for (std::size_t i = 0; i < 8; i += 2) {
    EXPECT_EQ(player.orders[i].seed, player.orders[i + 1].seed);
    EXPECT_NE(player.orders[i].imagines, player.orders[i + 1].imagines);
    EXPECT_EQ(player.orders[i].goal.furniture, "table1");
  }
  EXPECT_NE(player.orders[0].seed, player.orders[2].seed);
  EXPECT_EQ(Report()["with_imagination"]["successes"], 4);
  EXPECT_EQ(Report()["without_imagination"]["successes"], 2);
  EXPECT_EQ(Report()["paired_difference"]["mean"], 0.5);
  EXPECT_THAT(Report()["command"], HasSubstr("hires experiment hypothesis --scenario topple"));
  EXPECT_THAT(base::Split(base::ReadTextFile(File("runs.csv")), '\n'), SizeIs(10));
  EXPECT_THAT(ended.out, HasSubstr("4 of 4"));
}

TEST_F(HypothesisCommandTest, WhatWasPlayedBeforeAnInterruptionIsNotPlayedAgain) {
  FakePlayer first, second, whole;
  first.stop_after = 3;
  const Ended stopped = RunWith(Words(), first.AsPlay());
  EXPECT_EQ(stopped.code, kExitCancelled);
  EXPECT_THAT(stopped.err, HasSubstr("3 of 8 runs are kept"));
  EXPECT_EQ(RunWith(Words(), second.AsPlay()).code, kExitRecommended);
  ASSERT_THAT(second.orders, SizeIs(5));
  EXPECT_EQ(second.orders[0].run, 2);
  EXPECT_FALSE(second.orders[0].imagines);
  auto resumed = Report();
  std::filesystem::remove(File("j"));
  EXPECT_EQ(RunWith(Words(), whole.AsPlay()).code, kExitRecommended);
  auto at_once = Report();
  for (auto* report : {&resumed, &at_once}) {
    for (auto& run : (*report)["list"]) run.erase("wall_seconds");
  }
  EXPECT_EQ(resumed, at_once);
}

TEST_F(HypothesisCommandTest, ARunWhoseSystemDiesCountsAsFailed) {
  FakePlayer player;
  player.dies_in = 1;
  EXPECT_EQ(RunWith(Words(), player.AsPlay()).code, kExitRecommended);
  EXPECT_EQ(Report()["with_imagination"]["successes"], 3);
  EXPECT_EQ(Report()["with_imagination"]["complete"], 3);
  EXPECT_EQ(Report()["list"][0]["outcome"], "system_died");
  EXPECT_EQ(Report()["list"][0]["success"], false);
}

TEST_F(HypothesisCommandTest, RefusesBadArgumentsBeforeAnythingIsPlayed) {
  FakePlayer player;
  const auto error = [&](const std::vector<std::string>& words) {
    const Ended ended = RunWith(words, player.AsPlay());
    EXPECT_EQ(ended.code, kExitBadInput);
    return ended.err;
  };
  EXPECT_THAT(error({"--scenario", "tople"}), HasSubstr("did you mean 'topple'"));
  EXPECT_THAT(error({}), HasSubstr("--scenario"));
  EXPECT_THAT(error({"--scenario", "topple", "--runs", "0"}), HasSubstr("--runs"));
  EXPECT_THAT(error({"--scenario", "topple", "--pace", "-1"}), HasSubstr("--pace"));
  EXPECT_THAT(error({"--scenario", "topple", "--workers", "0"}), HasSubstr("--workers"));
  EXPECT_THAT(error({"--scenario", "topple", "--pace", "0.1"}), HasSubstr("wall_limit"));
  EXPECT_THAT(error({"--scenario", "topple", "--json", "/no/such/folder/x.json"}),
              HasSubstr("/no/such/folder"));
  EXPECT_THAT(player.orders, SizeIs(0));
}

TEST_F(HypothesisCommandTest, SaysThatABuildWithoutRosCannotPlayIt) {
  const Ended ended = RunWith(Words(), {});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("build with ROS"));
}

}  // namespace
}  // namespace hires::evaluation
