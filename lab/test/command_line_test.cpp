#include "lab/src/verbs/command_line.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "lab/test/lab_run.h"
#include "support/messages.h"

namespace hires::lab::command_line_test {
namespace {

using test_support::RunLab;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(LabCommandLineTest, HelpNamesTheVerbs) {
  const auto ended = RunLab({"--help"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("experiment"), HasSubstr("scenarios"), HasSubstr("experiences"),
                    HasSubstr("reproduce"), HasSubstr("publish")));
}

TEST(LabCommandLineTest, VerbsThatProgramsCallAreNotShown) {
  LabBackends backends;
  bool is_run = false;
  backends.scenario_run = [&](const std::vector<std::string>&) {
    is_run = true;
    return 0;
  };
  EXPECT_THAT(RunLab({"--help"}, {}, backends).out, Not(HasSubstr("scenario_run")));
  EXPECT_THAT(RunLab({"scenario_rn"}, {}, backends).err, Not(HasSubstr("scenario_run")));
  RunLab({"scenario_run", "x"}, {}, backends);
  EXPECT_TRUE(is_run);
}

TEST(LabCommandLineTest, RefusesUnknownVerbsAndOptions) {
  EXPECT_EQ(RunLab({}).code, 1);
  EXPECT_EQ(RunLab({"experiment", "decision", "--truht", "same"}).code, 1);
  EXPECT_THAT(RunLab({"experiment", "decision", "--truht", "same"}).err, HasSubstr("'--truth'"));
  EXPECT_THAT(RunLab({"experiences", "analyze", "x.db"}).err,
              HasSubstr("verb 'analyze' is unknown; did you mean 'analyse'?"));
  EXPECT_THAT(RunLab({"experiment", "hypothsis", "--scenario", "topple"}).err,
              HasSubstr("verb 'hypothsis' is unknown; did you mean 'hypothesis'?"));
  EXPECT_THAT(RunLab({"experiment", "--quiet", "--seed", "3", "lader"}).err,
              HasSubstr("verb 'lader' is unknown; did you mean 'ladder'?"));
}

TEST(LabListTest, FilesOfTheLabAreFound) {
  const auto series = nlohmann::json::parse(RunLab({"list", "series", "--json", "-"}).out);
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0]["series"], "replace");
  EXPECT_EQ(series[0]["file"], HIRES_SOURCE_DIR "/lab/config/series/replace.yaml");
  EXPECT_EQ(series[0]["combinations"], 9) << "three arrangements, three starts";
  const auto experiments =
      nlohmann::json::parse(RunLab({"list", "experiments", "--json", "-"}).out);
  EXPECT_GT(experiments.size(), 10u);
  EXPECT_EQ(RunLab({"list", "worlds"}).code, 1);
}

}  // namespace
}  // namespace hires::lab::command_line_test
