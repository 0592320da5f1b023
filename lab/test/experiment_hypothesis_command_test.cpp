#include "lab/src/verbs/experiment_hypothesis_command.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "hires/base/text.h"
#include "lab/test/hypothesis_examples.h"
#include "lab/test/lab_run.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_hypothesis_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunLab;
using test_support::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;

Ended RunWith(const std::vector<std::string>& words, const PlayHypothesis& play = {},
              const std::string& package_folder = kRoot) {
  LabBackends backends;
  backends.package_folder = package_folder;
  backends.play_hypothesis = play;
  return RunLab({"experiment", "hypothesis"}, words, backends);
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
  EXPECT_EQ(ended.code, cli::kExitRecommended) << ended.err;
  ASSERT_THAT(player.orders, SizeIs(8));
  for (std::size_t i = 0; i < 8; i += 2) {
    EXPECT_EQ(player.orders[i].seed, player.orders[i + 1].seed);
    EXPECT_NE(player.orders[i].imagines, player.orders[i + 1].imagines);
    EXPECT_EQ(player.orders[i].goal.areas.size(), 4U);
  }
  EXPECT_NE(player.orders[0].seed, player.orders[2].seed);
  EXPECT_EQ(Report()["with_imagination"]["successes"], 4);
  EXPECT_EQ(Report()["without_imagination"]["successes"], 2);
  EXPECT_EQ(Report()["paired_difference"]["mean"], 0.5);
  EXPECT_THAT(Report()["command"], HasSubstr("hires_lab experiment hypothesis --scenario topple"));
  EXPECT_THAT(base::Split(base::ReadTextFile(File("runs.csv")), '\n'), SizeIs(10));
  EXPECT_THAT(ended.out, HasSubstr("4 of 4"));
}

TEST_F(HypothesisCommandTest, WhatWasPlayedBeforeAnInterruptionIsNotPlayedAgain) {
  FakePlayer first, second, whole;
  first.stop_after = 3;
  const Ended stopped = RunWith(Words(), first.AsPlay());
  EXPECT_EQ(stopped.code, cli::kExitCancelled);
  EXPECT_THAT(stopped.err, HasSubstr("3 of 8 runs are kept"));
  EXPECT_EQ(RunWith(Words(), second.AsPlay()).code, cli::kExitRecommended);
  ASSERT_THAT(second.orders, SizeIs(5));
  EXPECT_EQ(second.orders[0].run, 2);
  EXPECT_FALSE(second.orders[0].imagines);
  auto resumed = Report();
  std::filesystem::remove(File("j"));
  EXPECT_EQ(RunWith(Words(), whole.AsPlay()).code, cli::kExitRecommended);
  auto at_once = Report();
  for (auto* report : {&resumed, &at_once}) {
    for (auto& run : (*report)["list"]) run.erase("wall_seconds");
  }
  EXPECT_EQ(resumed, at_once);
}

TEST_F(HypothesisCommandTest, ARunWhoseSystemDiesCountsAsFailed) {
  FakePlayer player;
  player.dies_in = 1;
  EXPECT_EQ(RunWith(Words(), player.AsPlay()).code, cli::kExitRecommended);
  EXPECT_EQ(Report()["with_imagination"]["successes"], 3);
  EXPECT_EQ(Report()["with_imagination"]["complete"], 3);
  EXPECT_EQ(Report()["list"][0]["outcome"], "system_died");
  EXPECT_EQ(Report()["list"][0]["success"], false);
}

TEST_F(HypothesisCommandTest, RefusesBadArgumentsBeforeAnythingIsPlayed) {
  FakePlayer player;
  const auto error = [&](const std::vector<std::string>& words) {
    const Ended ended = RunWith(words, player.AsPlay());
    EXPECT_EQ(ended.code, cli::kExitBadInput);
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

/// The package with two rollouts of each alternative in place of up to 400, which take minutes.
std::string QuickPackage(const TemporaryFolder& folder) {
  namespace fs = std::filesystem;
  fs::copy(kRoot + "/config", folder.path() / "config", fs::copy_options::recursive);
  fs::create_directory(folder.path() / "lab");
  fs::create_directory_symlink(fs::path(kRoot) / "lab" / "config",
                               folder.path() / "lab" / "config");
  for (const char* name : {"worlds", "urdf"}) {
    fs::create_directory_symlink(fs::path(kRoot) / name, folder.path() / name);
  }
  std::string text = base::ReadTextFile(kRoot + "/config/execution_monitor.yaml");
  text.replace(text.find("rollouts: 400"), 13, "rollouts: 2  ");
  folder.Write("config/execution_monitor.yaml", text);
  return folder.path().string();
}

TEST_F(HypothesisCommandTest, PlaysInThisProcessWithoutAnyNode) {
  const TemporaryFolder folder;
  const std::string package = QuickPackage(folder);
  nlohmann::json first;
  for (const std::string threads : {"1", "2"}) {
    const Ended ended =
        RunWith({"--scenario", "topple", "--runs", "1", "--local", "--resume", File("j" + threads),
                 "--json", File("report.json"), "--threads", threads},
                {}, package);
    ASSERT_EQ(ended.code, cli::kExitRecommended) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("truth same, in virtual time"));
    auto runs = Report()["list"];
    ASSERT_THAT(runs, SizeIs(2));
    EXPECT_EQ(runs[0]["complete"], true);
    EXPECT_GT(runs[0]["imaginations"], 0);
    EXPECT_EQ(runs[1]["imaginations"], 0);
    EXPECT_THAT(Report()["command"], HasSubstr("--local --truth same"));
    for (auto& run : runs) run.erase("wall_seconds");
    if (first.empty()) first = runs;
    EXPECT_EQ(runs, first) << "threads change nothing";
  }
}

TEST_F(HypothesisCommandTest, SaysThatABuildWithoutRosCannotPlayIt) {
  const Ended ended = RunWith(Words(), {});
  EXPECT_EQ(ended.code, cli::kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("build with ROS"));
}

}  // namespace
}  // namespace hires::lab::experiment_hypothesis_command_test
