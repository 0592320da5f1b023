#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "hires/base/text.h"
#include "lab/test/lab_run.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_decision_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunLab;
using testing::HasSubstr;
using testing::SizeIs;

class DecisionCommandTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return (folder_.path() / name).string(); }
  static Ended Decide(const std::vector<std::string>& words) {
    return RunLab({"experiment", "decision"}, words);
  }
  /// Arms that need no rollout, so that it is short.
  nlohmann::json Constants(const std::string& runs, const std::string& threads,
                           const std::string& journal) const {
    const Ended ended =
        Decide({"--runs", runs, "--threads", threads, "--arms", "always_fast,always_slow",
                "--resume", File(journal), "--json", File("report.json"), "--quiet"});
    EXPECT_EQ(ended.code, cli::kExitRecommended) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("truth same"));
    return nlohmann::json::parse(base::ReadTextFile(File("report.json")));
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(DecisionCommandTest, ASeriesGrowsAndIsTheSameForAnyNumberOfThreads) {
  Constants("1", "1", "grown");
  const auto grown = Constants("3", "1", "grown")["arms"];
  EXPECT_THAT(base::Split(base::ReadTextFile(File("grown")), '\n'), SizeIs(5)) << "and a head";
  EXPECT_THAT(grown["always_slow"]["tasks"], SizeIs(3));
  EXPECT_EQ(Constants("3", "2", "at_once")["arms"], grown);
}

TEST_F(DecisionCommandTest, RefusesBadArgumentsBeforeAnythingIsPlayed) {
  const auto error = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--resume", File("j")});
    const Ended ended = Decide(words);
    EXPECT_EQ(ended.code, cli::kExitBadInput);
    return ended.err;
  };
  EXPECT_THAT(error({"--arms", "imagination,always_slo"}), HasSubstr("did you mean 'always_slow'"));
  EXPECT_THAT(error({"--truth", "sane"}), HasSubstr("same"));
  EXPECT_THAT(error({"--runs", "0"}), HasSubstr("--runs"));
  EXPECT_THAT(error({"--json", "/no/such/folder/x.json"}), HasSubstr("/no/such/folder"));
}

TEST_F(DecisionCommandTest, AJournalOfAnotherSeriesIsRefused) {
  Constants("1", "1", "j");
  const Ended ended = Decide({"--runs", "1", "--seed", "2", "--arms", "always_fast,always_slow",
                              "--resume", File("j"), "--quiet"});
  EXPECT_EQ(ended.code, cli::kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("seed 1, now it is 2"));
}

}  // namespace
}  // namespace hires::lab::experiment_decision_command_test
