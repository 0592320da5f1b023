#include "cli/report_output.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::cli::report_output_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Ended;
using hires::test_support::RunHires;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kRoot = HIRES_SOURCE_DIR;

class ReportOutputTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Read(const std::string& name) const { return base::ReadTextFile(Path(name)); }
  nlohmann::json ReadJson(const std::string& name) const {
    return nlohmann::json::parse(Read(name));
  }
  ReportOptions Options() const {
    ReportOptions options;
    options.command = "hires count --to 3";
    options.package_folder = kRoot;
    return options;
  }
  std::size_t NumFiles() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

  const TemporaryFolder folder_;
};

TEST(CommandTextTest, AShellReadsTheSameWords) {
  EXPECT_EQ(CommandText({"hires", "--arg", "a,b", "--name", "x:1,2"}),
            "hires --arg a,b --name x:1,2");
  EXPECT_EQ(CommandText({"a b", "", "it's", "$HOME"}), "'a b' '' 'it'\\''s' '$HOME'");
}

TEST_F(ReportOutputTest, NoAnswerIsWrittenOverWhatItRestsOn) {
  const std::string own = folder_.Write("own.yaml", "a: 1\n");
  ReportOptions options = Options();
  EXPECT_NO_THROW(CheckReport(options, {{"settings", own}, {"world", ""}}));
  options.html = Path("./own.yaml");
  EXPECT_EQ(ConfigErrorOf([&] {
              CheckReport(options, {{"settings", own}});
            }),
            "--html " + options.html + ": would write over the settings; name another file");
  const std::string answer = folder_.Write("answer.json", "{}");
  for (const char* option : {"--html", "--png"}) {
    const Ended ended = RunHires({"report", answer, option, Path("./answer.json")});
    EXPECT_EQ(ended.code, kExitBadInput);
    EXPECT_THAT(ended.err, HasSubstr("would write over the answer; name another file"));
  }
  EXPECT_EQ(Read("answer.json"), "{}");
}

TEST_F(ReportOutputTest, TheHeadSaysFromWhatTheAnswerCame) {
  ReportOptions options = Options();
  options.json = Path("answer.json");
  const std::string own = folder_.Write("own.yaml", "a: 1\n");
  WriteReport(options,
              {"count",
               false,
               {{"world", kRoot + "/config/../worlds/workshop.world"}, {"own", own}, {"map", ""}},
               {{"robot", "00ff"}}},
              {{"counted", 3}});
  const auto json = ReadJson("answer.json");
  EXPECT_EQ(json["counted"], 3);
  const auto& head = json["report"];
  EXPECT_EQ(head["format"], kReportFormat);
  EXPECT_EQ(head["verb"], "count");
  EXPECT_EQ(head["command"], "hires count --to 3");
  EXPECT_EQ(head["local"], false);
  EXPECT_EQ(head["hashes"]["robot"], "00ff");
  const std::string package = base::ReadTextFile(kRoot + "/package.xml");
  EXPECT_THAT(package, HasSubstr("<version>" + head["version"].get<std::string>() + "</version>"));
  ASSERT_EQ(head["inputs"].size(), 2u) << "there was no map";
  EXPECT_EQ(head["inputs"][0]["path"], "worlds/workshop.world") << "the same on any computer";
  EXPECT_EQ(head["inputs"][1]["path"], own);
  EXPECT_EQ(head["inputs"][1]["hash"].get<std::string>().size(), 16u);
}

TEST_F(ReportOutputTest, AnInputWithOtherTextHasAnotherHash) {
  ReportOptions options = Options();
  options.json = Path("answer.json");
  const auto hash = [&](const std::string& text) {
    const std::string path = folder_.Write("input.yaml", text);
    WriteReport(options, {"count", true, {{"input", path}}, {}}, {{"counted", 3}});
    return ReadJson("answer.json")["report"]["inputs"][0]["hash"];
  };
  const auto first = hash("a: 1\n");
  EXPECT_NE(hash("a: 2\n"), first);
  EXPECT_EQ(hash("a: 1\n"), first);
}

TEST_F(ReportOutputTest, AnInputIsHashedAsItIsBeforeTheWork) {
  ReportOptions options = Options();
  options.json = Path("answer.json");
  const std::string path = folder_.Write("input.yaml", "a: 1\n");
  const ReportOrigin before{"count", true, {{"input", path}}, {}};
  folder_.Write("input.yaml", "a: 2\n");
  WriteReport(options, before, {{"counted", 3}});
  EXPECT_EQ(ReadJson("answer.json")["report"]["inputs"][0]["hash"], before.inputs[0].hash);
  EXPECT_NE(ReportInput("input", path).hash, before.inputs[0].hash);
}

TEST_F(ReportOutputTest, WhatNobodyAskedForIsNotWritten) {
  WriteReport(Options(), {"count", true, {}, {}}, {{"counted", 3}});
  EXPECT_EQ(NumFiles(), 0u);
}

TEST_F(ReportOutputTest, FoldersArePutRightBeforeTheWork) {
  for (std::string ReportOptions::*file :
       {&ReportOptions::json, &ReportOptions::html, &ReportOptions::png}) {
    ReportOptions options = Options();
    options.*file = Path("missing/answer");
    EXPECT_THAT(ConfigErrorOf([&] { CheckReport(options); }), HasSubstr("does not exist"));
  }
}

TEST_F(ReportOutputTest, AMinusIsRefusedAndTheWayToPrintIsNamed) {
  ReportOptions options = Options();
  options.html = "-";
  EXPECT_EQ(ConfigErrorOf([&] { CheckReport(options); }),
            "--html -: is no file; name one, or /dev/stdout to print it");
  const std::string answer = folder_.Write("answer.json", "{}");
  for (const char* option : {"--html", "--png"}) {
    EXPECT_THAT(RunHires({"report", answer, option, "-"}).err,
                HasSubstr(std::string(option) + " -: is no file"));
  }
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST_F(ReportOutputTest, AFileThatCannotBeWrittenIsSaidBeforeTheWork) {
  for (std::string ReportOptions::*file :
       {&ReportOptions::json, &ReportOptions::html, &ReportOptions::png}) {
    ReportOptions options = Options();
    options.*file = folder_.path().string();
    EXPECT_THAT(
        ConfigErrorOf([&] { CheckReport(options); }),
        AllOf(HasSubstr(folder_.path().string()), HasSubstr("it is a folder; name a file")));
    options.*file = "/proc/answer";
    EXPECT_THAT(ConfigErrorOf([&] { CheckReport(options); }),
                HasSubstr("/proc/answer: cannot be written"));
  }
  ReportOptions options = Options();
  options.html = folder_.Write("page.html", "before");
  options.json = "/dev/null";
  CheckReport(options);
  EXPECT_EQ(Read("page.html"), "before");
  EXPECT_EQ(NumFiles(), 1u) << "the check leaves nothing behind";
}

TEST_F(ReportOutputTest, StandardOutputMayBeAPipe) {
  const int before = dup(STDOUT_FILENO);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_GE(dup2(ends[1], STDOUT_FILENO), 0);
  ReportOptions options = Options();
  options.html = "";
  options.json = "/dev/stdout";
  EXPECT_NO_THROW(CheckReport(options));
  dup2(before, STDOUT_FILENO);
  for (const int descriptor : {before, ends[0], ends[1]}) close(descriptor);
}

TEST_F(ReportOutputTest, AProgramThatIsMissingIsAnErrorBeforeTheWork) {
  ReportOptions options = Options();
  options.package_folder = Path("");
  options.html = Path("page.html");
  EXPECT_THAT(ConfigErrorOf([&] { CheckReport(options); }), HasSubstr("scripts/report"));
}

TEST_F(ReportOutputTest, AStoredAnswerGivesThePageThatItCameWith) {
  const Ended ended = RunHires({"plan", "--domain", kRoot + "/config/domains/restaurant.lisp",
                                "--problem", kRoot + "/config/domains/problems/serve_coffee.lisp"},
                               {"--json", Path("plan.json"), "--html", Path("plan.html")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("saved to " + Path("plan.json") + "\nsaved to " +
                                   Path("plan.html") + "\n"));
  EXPECT_THAT(Read("plan.html"), AllOf(StartsWith("<!DOCTYPE html>"), HasSubstr("(hires plan)")));
  const Ended again = RunHires({"report", Path("plan.json"), "--html", Path("again.html")});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out, "saved to " + Path("again.html") + "\n");
  EXPECT_EQ(Read("again.html"), Read("plan.html"));
  EXPECT_EQ(NumFiles(), 3u) << "nothing half written stays";
}

TEST_F(ReportOutputTest, APageShowsTheWorstAndTheMedianRolloutWhereverItLies) {
  std::filesystem::create_directory(Path("pages"));
  const Ended ended =
      RunHires({"imagine", "--local", "--quiet", "--world", kRoot + "/worlds/workshop.world",
                "--from", "dock", "--object", "peppermill1", "--action", "move_base_param", "--arg",
                "atBench", "--arg", "fast", "--rollouts", "2"},
               {"--json", Path("answer.json"), "--html", Path("pages/answer.html")});
  EXPECT_NE(ended.code, kExitBadInput) << ended.err;
  const auto pictures = ReadJson("answer.json")["pictures"];
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0]["file"], "pages/answer_worst.png");
  EXPECT_THAT(pictures[1]["caption"], HasSubstr("move_base_param(atbench, fast)"));
  EXPECT_THAT(Read("pages/answer_median.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(Read("pages/answer.html"), HasSubstr("data:image/png;base64,"));
}

TEST_F(ReportOutputTest, AnAnswerOfFailuresHasItsPageToo) {
  const Ended ended = RunHires({"imagine",
                                "--local",
                                "--quiet",
                                "--from",
                                "manipulationAreaSouthTable1",
                                "--object-in-hand",
                                "mug1:rightArm1",
                                "--posture",
                                "torso1:TorsoUpPosture",
                                "--action",
                                "place_object",
                                "--arg",
                                "mug1",
                                "--arg",
                                "rightArm1",
                                "--arg",
                                "placingAreaWestRightTable1",
                                "--put",
                                "bowl1:7.539,11.241,0.73",
                                "--put",
                                "book1:7.481,11.384,0.73",
                                "--put",
                                "book2:7.613,11.405,0.73",
                                "--rollouts",
                                "2"},
                               {"--json", Path("answer.json"), "--html", Path("answer.html")});
  EXPECT_NE(ended.code, kExitBadInput) << ended.err;
  EXPECT_EQ(ReadJson("answer.json")["pictures"].size(), 1u) << "none came to its end";
  EXPECT_THAT(Read("answer.html"), HasSubstr("area_occupied"));
}

TEST_F(ReportOutputTest, ATaskIsDrawnFromAStoredAnswer) {
  const Ended ended =
      RunHires({"report", kRoot + "/test/data/report/achieve.json", "--png", Path("run.png")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(Read("run.png"), StartsWith("\x89PNG"));
}

TEST_F(ReportOutputTest, WhatIsNoAnswerIsRefused) {
  const std::string path = folder_.Write("foreign.json", "{\"a\": 1}");
  const Ended ended = RunHires({"report", path, "--html", Path("page.html")});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("foreign.json: has no field /report"));
  EXPECT_FALSE(std::filesystem::exists(Path("page.html")));
  EXPECT_THAT(RunHires({"report", path}).err, HasSubstr("nothing to make"));
}

TEST_F(ReportOutputTest, NumbersThatHaveNoPageAreCalledWhatTheyAre) {
  const std::string path = folder_.Write("seen.json", R"({"schema": "hires/recognition"})");
  const Ended ended = RunHires({"report", path, "--html", Path("page.html")});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("seen.json: has no field /report: it is hires/recognition"),
                    HasSubstr("pages are made of what achieve, doctor, ")));
  EXPECT_FALSE(std::filesystem::exists(Path("page.html")));
}

TEST_F(ReportOutputTest, TheDoctorSaysForMachinesWhatItSaysForPeople) {
  Backends backends;
  backends.more_checks.push_back([] {
    return std::vector<Finding>{{FindingLevel::kWarning, "the floor is wet"}};
  });
  const Ended ended =
      RunHires({"doctor", "--no-physics", "--json", Path("doctor.json")}, {}, backends);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("ok      world"), HasSubstr("warn    the floor is wet")));
  const auto json = ReadJson("doctor.json");
  EXPECT_EQ(json["report"]["verb"], "doctor");
  EXPECT_EQ(json["ok"], true);
  ASSERT_EQ(json["findings"].size(), 3u);
  EXPECT_EQ(json["findings"][2]["level"], "warning");
  EXPECT_EQ(json["findings"][2]["text"], "the floor is wet");
}

TEST(DoctorTest, AFailedFindingIsNotWell) {
  Backends backends;
  backends.more_checks.push_back([] {
    return std::vector<Finding>{{FindingLevel::kFailed, "no floor"}};
  });
  const Ended ended = RunHires({"doctor", "--no-physics"}, {}, backends);
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("FAILED  no floor"), HasSubstr("needs attention")));
}

}  // namespace
}  // namespace hires::cli::report_output_test
