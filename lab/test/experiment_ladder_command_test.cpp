#include "lab/src/verbs/experiment_ladder_command.h"

#include <gmock/gmock.h>

#include "lab/test/lab_run.h"

namespace hires::lab::experiment_ladder_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunLab;
using testing::HasSubstr;

Ended Ladder(const std::vector<std::string>& words) {
  return RunLab({"experiment", "ladder"}, words);
}

TEST(ExperimentLadderCommandTest, RefusesBadOptionsBeforeItMeasures) {
  EXPECT_THAT(Ladder({"--seconds", "0"}).err, HasSubstr("--seconds"));
  EXPECT_THAT(Ladder({"--repeats", "1"}).err, HasSubstr("--repeats"));
  EXPECT_THAT(Ladder({"--repeats", "2.5"}).err, HasSubstr("--repeats"));
  EXPECT_THAT(Ladder({"--seed", "-3"}).err, HasSubstr("--seed"));
  EXPECT_THAT(Ladder({"--threads", "0"}).err, HasSubstr("--threads"));
  EXPECT_THAT(Ladder({"--repeat", "3"}).err, HasSubstr("--repeats")) << "what comes near";
  const Ended no_folder = Ladder({"--json", "/no/such/folder/ladder.json"});
  EXPECT_EQ(no_folder.code, cli::kExitBadInput);
  EXPECT_THAT(no_folder.err, HasSubstr("/no/such/folder"));
}

TEST(ExperimentLadderCommandTest, StopsWhenCancelled) {
  LadderOptions options;
  options.quiet = true;
  const Ended ended = test_support::Capture(
      [&] { return RunLadderVerb(options, HIRES_SOURCE_DIR, [] { return true; }); });
  EXPECT_EQ(ended.code, cli::kExitCancelled);
  EXPECT_EQ(ended.out, "");
}

}  // namespace
}  // namespace hires::lab::experiment_ladder_command_test
