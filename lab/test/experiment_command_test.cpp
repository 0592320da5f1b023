#include "lab/src/verbs/experiment_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/exit_code.h"
#include "hires/base/text.h"
#include "hires/knowledge/experience.h"
#include "lab/test/lab_run.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_command_test {
namespace {

using hires::test_support::RunLab;
using knowledge::ExperienceStore;

const std::string kRoot = HIRES_SOURCE_DIR;

/// The exit code of `hires_lab experiment` with a file that expects `expectation` of three legs.
int ExitCode(const std::string& expectation, const std::vector<std::string>& more = {}) {
  std::string yaml = base::ReadTextFile(kRoot + "/lab/config/experiments/legs_world.yaml");
  yaml = yaml.substr(0, yaml.find("expect:")) + "expect: [" + expectation + "]\n";
  yaml.replace(yaml.find("../../../config/"), 16, kRoot + "/config/");
  const std::string path = testing::TempDir() + "exit_code.yaml";
  std::ofstream(path) << yaml;
  return RunLab({"experiment", path, "--runs", "1"}, more).code;
}

TEST(ExperimentCommandTest, ExitsByWhatTheFileExpects) {
  EXPECT_EQ(ExitCode("{measure: reached, at_least: 1}"), 0);
  EXPECT_EQ(ExitCode("{measure: reached, at_least: 2}"), 2);
  EXPECT_EQ(ExitCode("{measure: raeched, at_least: 1}"), 1);
  EXPECT_EQ(ExitCode("", {"--threads", "0"}), 1);
  EXPECT_EQ(ExitCode("", {"--json", "/no/such/folder/x.json"}), 1);
}

TEST(ExperimentCommandTest, SeedsOfAllVerbsAreWholeNumbers) {
  for (const char* verb : {"localisation", "torso_poses", "detector", "recognition"}) {
    const auto ended = RunLab({"experiment", verb, "--seed", "-1"});
    EXPECT_EQ(ended.code, 1) << verb;
    EXPECT_THAT(ended.err,
                testing::AllOf(testing::HasSubstr("--seed"), testing::HasSubstr("no whole number")))
        << verb;
  }
}

TEST(ExperimentCommandTest, CloudsAreWrittenToAFolderAlone) {
  const hires::test_support::TemporaryFolder folder;
  const std::string file = folder.Write("clouds.txt", "");
  const auto ended = RunLab({"experiment", "recognition", "--tables", "1", "--clouds", file});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, testing::HasSubstr("--clouds: '" + file + "' is a file; wanted a folder"));
}

TEST(ExperimentCommandTest, ASingleTableDecidesNoGoalAndThatIsSaid) {
  const hires::test_support::TemporaryFolder folder;
  const std::string json = (folder.path() / "numbers.json").string();
  const auto ended = RunLab({"experiment", "recognition", "--tables", "1", "--quiet", "--clouds",
                             folder.path().string(), "--json", json});
  EXPECT_EQ(ended.code, 2) << ended.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "table_2000.pcd"));
  EXPECT_THAT(ended.out, testing::HasSubstr("saved to " + json +
                                            "\nexit code 2, as not all goals are met:\n"));
  EXPECT_THAT(ended.out, testing::HasSubstr("undecided, as the 95 % interval holds the goal: "));
  const auto help = RunLab({"experiment", "recognition", "--help"});
  EXPECT_THAT(help.out, testing::HasSubstr("2 one is missed, undecided or without a value"));
}

TEST(ExperimentCommandTest, WritesCsvAndJson) {
  const std::string csv = testing::TempDir() + "legs.csv", json = testing::TempDir() + "legs.json";
  EXPECT_EQ(ExitCode("", {"--csv", csv, "--json", json, "--seed", "5"}), 0);
  EXPECT_THAT(base::ReadTextFile(csv), testing::StartsWith("chain,leg,from,to,start_x"));
  const auto report = nlohmann::json::parse(base::ReadTextFile(json));
  EXPECT_EQ(report["seed"], 5);
  EXPECT_EQ(report["rows"].size(), 1u);
  EXPECT_EQ(report["tables"][0]["heads"][0], "to");
  EXPECT_EQ(report["report"]["verb"], "experiment");
  EXPECT_EQ(report["report"]["inputs"].size(), 2u) << "the experiment and its scene";
}

TEST(ExperimentCommandTest, WritesWhatIsExpectedForBuildServers) {
  const std::string path = testing::TempDir() + "legs.xml";
  EXPECT_EQ(ExitCode("{measure: reached, at_least: 2}", {"--junit", path}), 2);
  EXPECT_THAT(base::ReadTextFile(path),
              testing::AllOf(testing::HasSubstr("<testsuite name=\"exit_code\" tests=\"1\""),
                             testing::HasSubstr("found 1\"")));
  EXPECT_EQ(ExitCode("", {"--junit", "/no/such/folder/x.xml"}), 1);
}

/// A loop of some drives, and experiences of a play before it.
class ExperiencesOfALoopTest : public ::testing::Test {
 protected:
  ExperiencesOfALoopTest() {
    std::string yaml = base::ReadTextFile(kRoot + "/lab/config/experiments/topple_loop.yaml");
    yaml = yaml.substr(0, yaml.find("expect:")) + "expect: []\n";
    const auto replace = [&](const std::string& what, const std::string& by) {
      yaml.replace(yaml.find(what), what.size(), by);
    };
    replace("../../../config/", kRoot + "/config/");
    replace("duration: 18000.0", "duration: 10.0");
    words_ = {
        "experiment", folder_.Write("loop.yaml", yaml), "--runs", "2", "--quiet", "--experiences",
        store_};
    ExperienceStore(store_, ExperienceStore::Mode::kWrite).Write({"old", "a", {{}}});
  }

  std::set<std::string> Runs() const {
    std::set<std::string> runs;
    ExperienceStore(store_, ExperienceStore::Mode::kRead).ForEach({}, [&](const auto& stored) {
      runs.insert(*stored.run);
    });
    return runs;
  }

  const hires::test_support::TemporaryFolder folder_;
  const std::string store_{(folder_.path() / "e.db").string()};
  std::vector<std::string> words_;
};

TEST_F(ExperiencesOfALoopTest, ReplaceTheFileWhenAllIsPlayed) {
  const auto ended = RunLab(words_);
  EXPECT_EQ(ended.code, cli::kExitRecommended) << ended.err;
  EXPECT_THAT(Runs(), testing::ElementsAre("fast/0", "fast/1", "slow/0", "slow/1"));
  EXPECT_FALSE(std::filesystem::exists(store_ + ".unfinished"));
}

TEST_F(ExperiencesOfALoopTest, LeaveTheFileWhenThePlayIsInterrupted) {
  CLI::App app;
  ExperimentOptions options;
  AddExperimentVerb(&app, &options);
  std::vector<std::string> last_first(words_.rbegin(), words_.rend());  // as CLI11 wants them
  app.parse(last_first);
  const auto ended =
      hires::test_support::Capture([&] { return RunExperimentVerb(options, [] { return true; }); });
  EXPECT_EQ(ended.code, cli::kExitCancelled) << ended.err;
  EXPECT_THAT(Runs(), testing::ElementsAre("old"));
  EXPECT_FALSE(std::filesystem::exists(store_ + ".unfinished"));
}

TEST(ExperimentCommandTest, AFileOfThePackageIsFoundByItsName) {
  const auto ended = RunLab({"experiment", "legs_world", "--hashes"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(
      ended.out,
      RunLab({"experiment", kRoot + "/lab/config/experiments/legs_world.yaml", "--hashes"}).out);
  EXPECT_THAT(
      RunLab({"experiment", "paird"}).err,
      testing::HasSubstr("lab/config/experiments: experiment 'paird' is unknown; did you mean "
                         "'paired'?; or give a path"));
  EXPECT_THAT(RunLab({"experiment", "none.yaml"}).err,
              testing::HasSubstr("none.yaml: no such file"));
  EXPECT_THAT(RunLab({"experiment"}).err,
              testing::HasSubstr("lab/config/experiments, such as paired"));
}

}  // namespace
}  // namespace hires::lab::experiment_command_test
