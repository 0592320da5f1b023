// The runner with real processes: scripts take the place of `hires achieve --local`, and die as
// told.
#include "lab/src/verbs/scenarios_command.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/store.h"
#include "lab/test/lab_run.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::scenarios_command_test {
namespace {

namespace fs = std::filesystem;
using hires::test_support::Capture;
using hires::test_support::ConfigErrorOf;
using hires::test_support::Ended;
using hires::test_support::RunLab;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRoot = HIRES_SOURCE_DIR;

/// Finds its run's folder by the option --json, counts its calls in it, and does $what.
constexpr char kScript[] = R"(#!/bin/sh
while [ $# -gt 0 ]; do [ "$1" = --json ] && result=$2; shift; done
folder=$(dirname "$result"); run=$(basename "$folder" | sed 's/.*_0*//')
Report() {
  printf '{"outcome":"%s","reason":"%s","failure":null,"duration":%s,"steps":[{"action":"a","started":%s}]}' \
    "$1" "$2" "$run" "$3" > "$result"
}
echo "run $run" >> "$(dirname "$folder")/calls"
Played() { grep -c "^run $run\$" "$(dirname "$folder")/calls"; }
)";

class ScenariosTest : public ::testing::Test {
 protected:
  /// @param what  lines of the script: plays run number $run.
  ScenariosOptions Options(const std::string& what) {
    ScenariosOptions options;
    options.file =
        folder_.Write("some.yaml",
                      "!Scenario\nScenario: serve_coffee\n---\n"
                      "!FluentPoseModification\nInstance: poseTable1\nGroup: g\nChoices: 2\n"
                      "Modifications: [[hasX, [0, 0.5]]]\n");
    options.player.program = folder_.Write("player", kScript + what);
    fs::permissions(options.player.program, fs::perms::owner_all);
    options.store = (folder_.path() / "store").string();
    options.report.json = (folder_.path() / "all.json").string();
    options.report.package_folder = kRoot;
    options.report.command = "hires_lab scenarios some.yaml";
    options.runs = 1;
    options.quiet = true;
    return options;
  }

  static Ended Play(const ScenariosOptions& options) {
    return Capture([&] { return RunScenariosVerb(options, kRoot, false, [] { return false; }); });
  }

  ordered_json Json() const {
    return ordered_json::parse(base::ReadTextFile((folder_.path() / "all.json").string()));
  }
  ordered_json FirstRun() const { return Json().at("runs").at(0); }
  std::string Calls() const {
    return base::ReadTextFile((folder_.path() / "store/calls").string());
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(ScenariosTest, ATaskThatIsDoneSucceeds) {
  EXPECT_EQ(Play(Options("Report succeeded '' 2\n")).code, kExitAllSucceeded);
  EXPECT_EQ(FirstRun()["outcome"], "succeeded");
}

TEST_F(ScenariosTest, TellsFluentsOfTheEpisodeAndHowManyOfThemWereKnownBefore) {
  const std::string prepared = (folder_.path() / "prepared.db").string();
  {
    const auto ontology =
        std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(
            knowledge::ReadBlackboardConfig(kRoot + "/config/blackboard.yaml").ontology));
    knowledge::Store store(prepared, ontology);
    const auto mug = [](const char* name) {
      knowledge::Fluent fluent;
      fluent.concept_name = "Mug";
      fluent.instance = name;
      return fluent;
    };
    store.Add({mug("mug1"), mug("mug2")}, {knowledge::Source::kKnowledge, 0, 0.0});
    store.Add({mug("mug3")}, {knowledge::Source::kObservation, 0, 1.0});
  }
  Play(Options("cp " + prepared + " \"$folder/blackboard.db\"; Report succeeded '' 2\n"));
  EXPECT_EQ(FirstRun()["fluents"], 3);
  EXPECT_EQ(FirstRun()["known_fluents"], 2);
  EXPECT_EQ(Json()["averages"]["succeeded"]["mean_new_fluents"], 1.0);
}

TEST_F(ScenariosTest, ATaskThatIsNotDoneFailsWithItsCause) {
  EXPECT_EQ(Play(Options("Report failed 'the mug fell' 2; exit 1\n")).code, kExitNotAllSucceeded);
  EXPECT_EQ(FirstRun()["outcome"], "failed");
  EXPECT_EQ(FirstRun()["cause"], "the mug fell");
}

TEST_F(ScenariosTest, ATaskWithoutAPlanIsImpossible) {
  EXPECT_EQ(Play(Options("Report no_plan 'no way' null; exit 2\n")).code, kExitNotAllSucceeded);
  EXPECT_EQ(FirstRun()["outcome"], "impossible");
}

TEST_F(ScenariosTest, AKilledProcessIsBrokenAfterItsRestartsThoughItHadAResult) {
  const Ended ended = Play(Options("Report succeeded '' 2; kill -9 $$\n"));
  EXPECT_EQ(ended.code, kExitSomeBroken);
  EXPECT_EQ(FirstRun()["outcome"], "broken");
  EXPECT_THAT(FirstRun()["cause"].get<std::string>(), HasSubstr("signal 9"));
  EXPECT_EQ(FirstRun()["broken_tries"].size(), 2u) << "one restart";
  EXPECT_EQ(Calls(), "run 1\nrun 1\n");
  EXPECT_THAT(ended.out, HasSubstr("A try broke down: signal 9"));
}

TEST_F(ScenariosTest, AProcessThatEndsWithoutAResultIsBrokenAndItsLastWordIsTold) {
  EXPECT_EQ(Play(Options("echo first; echo last words >&2; exit 7\n")).code, kExitSomeBroken);
  EXPECT_EQ(FirstRun()["cause"], "exit code 7: last words");
}

TEST_F(ScenariosTest, AStoppedProcessHangs) {
  ScenariosOptions options = Options("echo begun; kill -STOP $$\n");
  options.player.hang_after = 0.3;
  options.restarts = 0;
  EXPECT_EQ(Play(options).code, kExitSomeBroken);
  EXPECT_EQ(FirstRun()["cause"], "hung: no progress for 0.3 s: begun");
}

TEST_F(ScenariosTest, AProcessThatSaysSomethingNowAndThenDoesNotHang) {
  ScenariosOptions options =
      Options("for i in 1 2 3 4 5 6; do echo $i; sleep 0.2; done; Report succeeded '' 2\n");
  options.player.hang_after = 0.8;
  EXPECT_EQ(Play(options).code, kExitAllSucceeded);
}

TEST_F(ScenariosTest, ABrokenRunIsStartedAgainAndTheSeriesGoesOn) {
  ScenariosOptions options =
      Options("[ $run = 2 ] && [ $(Played) = 1 ] && kill -SEGV $$\nReport succeeded '' 2\n");
  options.runs = 3;
  options.quiet = false;
  const Ended ended = Play(options);
  EXPECT_EQ(ended.code, kExitAllSucceeded);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("run 2 broke down: signal 11"), HasSubstr("started again"),
                               HasSubstr("100 %")));
  EXPECT_EQ(Json()["runs"][1]["broken_tries"].size(), 1u);
  EXPECT_EQ(Calls(), "run 1\nrun 2\nrun 2\nrun 3\n");
}

/// Runs it in a process of its own, and kills that when run `kill_at` has been begun.
void KillDuring(const ScenariosOptions& options, const std::string& kill_at) {
  const pid_t runner = fork();
  if (runner == 0) {
    if (freopen("/dev/null", "w", stdout) == nullptr) _exit(1);
    RunScenariosVerb(options, kRoot, false, [] { return false; });
    _exit(0);
  }
  const double give_up = base::SteadyNow() + 20.0;
  while (!fs::exists(kill_at) && base::SteadyNow() < give_up) usleep(2000);
  kill(runner, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(runner, &status, 0), runner);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it ended before it was killed";
}

TEST_F(ScenariosTest, AKilledRunnerGoesOnWhereItWasAndEndsAsIfNeverKilled) {
  const std::string outcomes =
      "case $run in 2) Report failed 'as always' 2;; *) Report succeeded '' 2;; esac\n";
  const std::string waiting = (folder_.path() / "waiting").string();
  ScenariosOptions options = Options("[ $run = 3 ] && [ $(Played) = 1 ] && touch " + waiting +
                                     " && sleep 60\n" + outcomes);
  options.runs = 4;
  KillDuring(options, waiting);
  EXPECT_EQ(Play(options).code, kExitNotAllSucceeded);
  EXPECT_EQ(Calls(), "run 1\nrun 2\nrun 3\nrun 3\nrun 4\n");
  const ordered_json resumed = Json();

  options.store = (folder_.path() / "another").string();
  folder_.Write("another/calls", "run 3\n");  // it waits no more
  EXPECT_EQ(Play(options).code, kExitNotAllSucceeded);
  EXPECT_EQ(resumed["runs"], Json()["runs"]);
  EXPECT_EQ(resumed["shares"], Json()["shares"]);
}

TEST_F(ScenariosTest, OtherOptionsOrAnotherFileHaveAJournalOfTheirOwn) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  Play(options);
  Play(options);
  EXPECT_EQ(Calls(), "run 1\n");
  options.seed = 2;
  Play(options);
  EXPECT_EQ(Calls(), "run 1\nrun 1\n");
  folder_.Write("some.yaml", "!Scenario\nScenario: topple\n");
  Play(options);
  EXPECT_EQ(Calls(), "run 1\nrun 1\nrun 1\n");
  options.runs = 2;  // more of the same
  Play(options);
  EXPECT_EQ(Calls(), "run 1\nrun 1\nrun 1\nrun 2\n");
}

TEST_F(ScenariosTest, TheSameRunsInAnyJournalHaveTheSameSeeds) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  options.runs = 2;
  Play(options);
  const ordered_json runs = Json()["runs"];
  EXPECT_NE(runs[0]["seed"], runs[1]["seed"]);
  EXPECT_EQ(runs[1]["choices"], ordered_json({1}));
}

TEST_F(ScenariosTest, BadInputIsRefusedBeforeAnythingIsPlayed) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  const auto error = [&] {
    return ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); });
  };
  options.truth = "nonsense";
  EXPECT_THAT(error(), HasSubstr("nonsense"));
  options = Options("");
  options.player.is_graph = true;
  EXPECT_THAT(error(), HasSubstr("--graph"));
  options = Options("");
  folder_.Write("some.yaml", "!Scenario\nTruth: same\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("some.yaml"), HasSubstr("--scenario NAME")));
  EXPECT_FALSE(fs::exists(folder_.path() / "store/calls"));
}

TEST_F(ScenariosTest, AWorldThatIsNotThereIsToldWithWhereItStands) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  const auto error = [&] {
    return ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); });
  };
  options.world = "nope";
  EXPECT_THAT(error(), AllOf(HasSubstr("--world: "), HasSubstr("nope: no such file")));
  options.world.clear();
  folder_.Write("some.yaml", "!Scenario\nScenario: serve_coffee\nWorld: nope.world\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("some.yaml: document 1, line 1: World: "),
                             HasSubstr("nope.world: no such file")));
}

TEST_F(ScenariosTest, AStoreThatIsAFileIsCalledOne) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  const auto error = [&] {
    return ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); });
  };
  options.store = folder_.Write("taken", "x");
  EXPECT_EQ(error(), "--store " + options.store + ": is a file; name a folder");
  options.store += "/below";
  EXPECT_THAT(error(), HasSubstr("the folder cannot be made (Not a directory)"));
}

TEST_F(ScenariosTest, OneRunIsSingular) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  Play(options);
  options.quiet = false;
  EXPECT_THAT(Play(options).err, HasSubstr("1 run was played before and is kept\n"));
  options.runs = 2;
  Play(options);
  EXPECT_THAT(Play(options).err, HasSubstr("2 runs were played before and are kept\n"));
}

TEST_F(ScenariosTest, AWrongInstructionIsRefusedBeforeAnythingIsPlayed) {
  const auto refusal = [&](const std::string& documents, const std::string& instruction = "") {
    ScenariosOptions options = Options("Report succeeded '' 2\n");
    folder_.Write("some.yaml", "!Scenario\nScenario: serve_coffee\n---\n" + documents);
    options.instruction = instruction;
    options.runs = 2;
    const std::string error =
        ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); });
    EXPECT_FALSE(fs::exists(folder_.path() / "store/calls")) << error;
    return error;
  };
  const auto second = [](const std::string& instruction) {
    return "!Scenario\nGroup: g\nChoices: 2\nInstruction: [achieve serve_coffee_to_guest guest1, " +
           instruction + "]\n";
  };
  EXPECT_THAT(refusal(second("achieve serve_cofee_to_guest guest1")),
              AllOf(HasSubstr("some.yaml: document 2, line 4: Instruction"),
                    HasSubstr("'achieve serve_cofee_to_guest guest1'"),
                    HasSubstr("did you mean 'serve_coffee_to_guest'")));
  EXPECT_THAT(
      refusal(second("achieve serve_coffee_to_guest")),
      AllOf(HasSubstr("document 2"), HasSubstr("has 0 arguments"), HasSubstr("takes 1 argument")));
  EXPECT_THAT(refusal(second("achieve serve_coffee_to_guest gest1")),
              AllOf(HasSubstr("document 2"), HasSubstr("task argument 'gest1' is unknown"),
                    HasSubstr("'guest1'")));
  EXPECT_THAT(refusal(second("achieve")), AllOf(HasSubstr("document 2"), HasSubstr("no task")));
  EXPECT_THAT(refusal("!Scenario\nTruth: same\n", "serve_coffee_to_guest xyzzy"),
              AllOf(HasSubstr("--instruction 'serve_coffee_to_guest xyzzy'"),
                    HasSubstr("task argument 'xyzzy' is unknown; did you mean")));
}

TEST_F(ScenariosTest, AScenarioThatIsNotThereIsToldWithWhereItStandsAndWhatWasMeant) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  const auto error = [&] {
    return ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); });
  };
  folder_.Write("some.yaml", "!Scenario\nScenario: serve_cofee\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("some.yaml: document 1, line 1: Scenario: "),
                             HasSubstr("did you mean 'serve_coffee'")));
  options.scenario = "tople";
  EXPECT_THAT(error(), AllOf(HasSubstr("--scenario: "), HasSubstr("did you mean 'topple'")));
}

TEST_F(ScenariosTest, ARunThatBeginsWithATableInTheWallIsTold) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  folder_.Write("some.yaml",
                "!Scenario\nScenario: serve_coffee\n---\n"
                "!FluentPoseModification\nInstance: poseTable1\nGroup: g\nChoices: 2\n"
                "Modifications: [[hasX, [0, 6.1]]]\n");
  options.runs = 2;
  const Ended ended = Play(options);
  EXPECT_EQ(ended.code, kExitAllSucceeded);
  EXPECT_THAT(ended.err, HasSubstr("run 2: table1 begins in walls, or touches it"));
  EXPECT_THAT(ended.err, Not(HasSubstr("run 1:")));
}

TEST_F(ScenariosTest, NoInputIsWrittenOver) {
  const ScenariosOptions options = Options("Report succeeded '' 2\n");
  const auto error = [](const ScenariosOptions& wrong) {
    return ConfigErrorOf([&] { RunScenariosVerb(wrong, kRoot, false, [] { return false; }); });
  };
  const std::string same = (folder_.path() / "." / "some.yaml").string();
  ScenariosOptions wrong = options;
  wrong.csv = same;
  EXPECT_THAT(error(wrong),
              HasSubstr("--csv " + same + ": would write over the series; name another"));
  wrong = options;
  wrong.report.json = same;
  EXPECT_THAT(error(wrong), HasSubstr("--json " + same + ": would write over the series"));
  wrong = options;
  wrong.csv = kRoot + "/config/scenarios/serve_coffee.yaml";
  EXPECT_THAT(error(wrong), HasSubstr("would write over the scenario"));
  EXPECT_FALSE(fs::exists(folder_.path() / "store"));
}

TEST_F(ScenariosTest, ASeriesOfThePackageIsPlayedByItsName) {
  ScenariosOptions options = Options("Report succeeded '' 2\n");
  options.file = "replace";
  EXPECT_EQ(Play(options).code, kExitAllSucceeded);
  EXPECT_EQ(Json()["report"]["inputs"][0]["path"], "lab/config/series/replace.yaml");
  options.file = "replase";
  EXPECT_THAT(ConfigErrorOf([&] { RunScenariosVerb(options, kRoot, false, [] { return false; }); }),
              AllOf(HasSubstr("lab/config/series"), HasSubstr("did you mean 'replace'")));
}

TEST(GraphOrderTest, ComesBackFromItsTextAndErrorsNameTheField) {
  GraphOrder order;
  order.run.files = {"a.yaml", "b.world", {"c.yaml", "d.yaml"}};
  order.run.task = "serve coffee";
  order.run.truth = "ideal";
  order.run.folder = "/f";
  order.run.seed = 12;
  order.workers = 3;
  order.pace = 2.5;
  order.time_limit = 40.0;
  const std::string text = GraphOrderText(order);
  EXPECT_EQ(GraphOrderText(ParseGraphOrder(text, "t")), text);
  EXPECT_THAT(text, AllOf(HasSubstr("d.yaml"), HasSubstr("2.5"), HasSubstr("\"seed\": 12")));
  EXPECT_THAT(ConfigErrorOf([] { ParseGraphOrder("{}", "order.json"); }),
              HasSubstr("order.json: field 'scenario'"));
}

TEST(ScenariosVerbTest, WordsThatMakeNoSenseAreRefused) {
  EXPECT_THAT(RunLab({"scenarios"}).err, HasSubstr("file is required"));
  EXPECT_THAT(RunLab({"scenarios", "a.yaml", "--ideal", "--truth", "same"}).err,
              AllOf(HasSubstr("--ideal"), HasSubstr("--truth")));
  EXPECT_THAT(RunLab({"scenarios", "a.yaml", "--pace", "2"}).err, HasSubstr("--graph"));
  EXPECT_THAT(RunLab({"scenarios", "missing.yaml"}).err, HasSubstr("missing.yaml"));
  EXPECT_EQ(RunLab({"scenarios", "missing.yaml"}).code, kExitSeriesBadInput);
}

TEST(ScenariosVerbTest, AScenarioInPlaceOfASeriesIsToldHowItIsPlayed) {
  EXPECT_THAT(RunLab({"scenarios", "topple"}).err,
              HasSubstr("series 'topple' is unknown; did you mean 'replace --scenario topple'?"));
  EXPECT_THAT(RunLab({"scenarios", "coffee"}).err, HasSubstr("'replace --scenario hot_coffee'"));
  EXPECT_THAT(RunLab({"scenarios", "replce"}).err, HasSubstr("did you mean 'replace'?"));
}

}  // namespace
}  // namespace hires::lab::scenarios_command_test
