#include "lab/src/publish/publish.h"

#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "lab/src/publish/published_results.h"
#include "lab/src/publish/results_page.h"
#include "lab/src/publish/template_text.h"
#include "lab/test/lab_run.h"
#include "lab/test/publish_examples.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::publish_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kAnswer[] =
    R"({"hits": 9, "all": 12, "lower": 0.5, "upper": 0.9, "a": 0.25, "b": 0.75, "time": -0.01})";
constexpr char kAfter[] =
    "  - {name: after, seconds: 1, inputs: [], command: \"list --json {answer}\", truth: foreign, "
    "numbers: [{name: late, what: late, digits: 0, at: /x}]}\n";

class PublishTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"docs", "lab/docs"})
      std::filesystem::create_directories(Path(folder));
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Text(const std::string& name) const { return base::ReadTextFile(Path(name)); }

  /// The example, whose plays a shell answers.
  PublishCatalogue Read(const std::string& plays = "", const std::string& script = "") const {
    PublishCatalogue catalogue = ReadPublishCatalogue(
        folder_.Write("lab/config/publish.yaml", publish_examples::Catalogue(plays)));
    catalogue.played[0].play.command = {
        "-c", "printf x >> " + Path("count") + "; echo '" + kAnswer + "' > {answer}"};
    if (!script.empty()) catalogue.played[1].play.command = {"-c", script};
    return catalogue;
  }
  PlaysDone PublishIt(const PublishCatalogue& catalogue,
                      Unfinished unfinished = Unfinished::kIsPlayed) const {
    PlaysOrder order;
    order.plays = PlaysOf(catalogue);
    order.program = order.lab_program = "/bin/sh";
    order.package = folder_.path().string();
    order.cancelled = [] { return false; };
    PlayStore store({Path("answers"), order.package, "build"});
    return Publish(catalogue, order, "0.3.0", &store, unfinished);
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(PublishTest, NumbersKnowHowTheyCameAbout) {
  PublishIt(Read());
  const auto content = nlohmann::json::parse(Text("lab/results/0.3.0.json"));
  EXPECT_EQ(content.at("version"), "0.3.0");
  ASSERT_EQ(content.at("numbers").size(), 4u);
  const auto& share = content.at("numbers")[0];
  EXPECT_EQ(share.at("value"), 75.0);
  EXPECT_EQ(share.at("low"), 50.0);
  EXPECT_EQ(share.at("high"), 90.0);
  EXPECT_EQ(share.at("n"), 12);
  EXPECT_EQ(share.at("seed"), 3);
  EXPECT_EQ(share.at("truth"), "same");
  EXPECT_EQ(share.at("version"), "0.3.0");
  EXPECT_EQ(share.at("date"), content.at("date"));
  EXPECT_GE(share.at("seconds"), 0.0);
  EXPECT_EQ(share.at("kept"), false);
  EXPECT_EQ(content.at("numbers")[1].at("value"), 0.75) << "the largest of two";
  EXPECT_EQ(content.at("numbers")[1].at("low"), nullptr);
  const auto& kept = content.at("numbers")[3];
  EXPECT_EQ(kept.at("kept"), true);
  EXPECT_EQ(kept.at("date"), "2026-11-20");
  EXPECT_EQ(kept.at("n"), nullptr);
}

TEST_F(PublishTest, ACommandIsSaidAsOneTypesIt) {
  Play play;
  play.command = {"experiment", "{package}/lab/config/a.yaml", "--json", "{answer}",
                  "--resume",   "{folder}/runs.journal",       "--quiet"};
  EXPECT_EQ(TypedCommand(play), "hires_lab experiment lab/config/a.yaml --resume runs.journal");
}

TEST_F(PublishTest, PagesHoldTheNumbers) {
  PublishIt(Read());
  EXPECT_THAT(
      Text("docs/results.md"),
      AllOf(HasSubstr("| tasks | 75.0 % (50.0 .. 90.0) of 12, 0.75 at worst (goal 0.5 .. "
                      "0.7: **missed**) | nothing | "
                      "same |\n"),
            HasSubstr("| speed | 480,000/s (2026-11-20 with 0.1.0) | 0.0 s | same, none |\n"),
            HasSubstr("Of 0.3.0, 20"), HasSubstr("\nNo more.\n")));
  EXPECT_THAT(
      Text("lab/docs/results_details.md"),
      AllOf(
          HasSubstr("## tasks\n0.0 s.\n\nAt length: [docs/a.md](../../docs/a.md).\n"),
          HasSubstr("| done | 75.0 % | 50.0 .. 90.0 | - | 12 | same | 3 | 20"),
          HasSubstr(
              "| steps | 480,000 steps/s | - | - | - | none | - | 2026-11-20, kept | 0.1.0 | 2 |"),
          HasSubstr("2. long series\n")));
}

TEST(GoalTextTest, AValueAtItsGoalMeetsIt) {
  PublishedNumber number;
  EXPECT_EQ(GoalText(number), "-");
  number.at_least = 95.0;
  EXPECT_EQ(GoalText(number), "goal 95") << "it was not played";
  number.value = 95.0;
  EXPECT_EQ(GoalText(number), "goal 95: met");
  number.value = 94.99;
  EXPECT_EQ(GoalText(number), "goal 95: **missed**");
  number.at_least = std::nullopt;
  number.at_most = 0.04;
  number.value = 0.022;
  EXPECT_EQ(GoalText(number), "goal 0.04: met");
}

TEST(ValueTextTest, ThousandsAreGroupedAndZeroHasNoSign) {
  const auto text = [](double value, int digits) {
    PublishedNumber number;
    number.value = value;
    number.digits = digits;
    return ValueText(number);
  };
  EXPECT_EQ(text(1234567.0, 0), "1,234,567");
  EXPECT_EQ(text(-480000.25, 1), "-480,000.2");
  EXPECT_EQ(text(9999.0, 0), "9999");
  EXPECT_EQ(text(-0.04, 1), "0.0");
}

TEST_F(PublishTest, ANumberWithoutARowStandsAmongTheDetails) {
  PublishIt(Read(kAfter, "echo '{\"x\": 7}' > {answer}"));
  EXPECT_THAT(Text("lab/docs/results_details.md"), HasSubstr("## Other numbers\n| number | value"));
  EXPECT_THAT(Text("lab/docs/results_details.md"), HasSubstr("| late | 7 | - | - | - | foreign |"));
}

TEST_F(PublishTest, KilledItGoesOn) {
  const std::string begun = Path("begun");
  const PublishCatalogue catalogue =
      Read(kAfter, "if test -e " + begun + "; then echo '{\"x\": 1}' > {answer}; else touch " +
                       begun + "; kill -9 $PPID; fi");
  EXPECT_EXIT(PublishIt(catalogue), ::testing::KilledBySignal(SIGKILL), "");
  EXPECT_FALSE(std::filesystem::exists(Path("lab/results/0.3.0.json")));
  EXPECT_FALSE(PublishIt(catalogue).answers.at("quick").is_new);
  EXPECT_EQ(Text("count"), "x") << "what was done is not played again";
  EXPECT_EQ(ReadResults(Path("lab/results/0.3.0.json")).numbers.size(), 5u);
}

TEST_F(PublishTest, WhatIsNotWholeIsNotWritten) {
  const PlaysDone done = PublishIt(Read(kAfter, "echo no such world; exit 1"));
  EXPECT_THAT(done.missing.at("after"), HasSubstr("no such world"));
  EXPECT_FALSE(std::filesystem::exists(Path("docs/results.md")));
}

TEST_F(PublishTest, WhatWasNotPlayedSaysSoWhereThatIsWanted) {
  const PublishCatalogue catalogue = Read();
  PublishIt(catalogue, Unfinished::kIsWritten);
  EXPECT_FALSE(std::filesystem::exists(Path("count"))) << "nothing is played";
  EXPECT_THAT(Text("docs/results.md"),
              AllOf(HasSubstr("| (not played) % (-) of -, (not played) at worst (-) |"),
                    HasSubstr("| 480,000/s (2026-11-20 with 0.1.0) |")));
  EXPECT_THAT(Text("lab/docs/results_details.md"), HasSubstr("| done | (not played) | - |"));
  EXPECT_FALSE(ReadResults(Path("lab/results/0.3.0.json")).numbers[0].value);
  PublishIt(catalogue);
  EXPECT_THAT(Text("docs/results.md"), HasSubstr("75.0 %"));
}

TEST_F(PublishTest, AllFieldsThatAnswersLackAreNamed) {
  PublishCatalogue catalogue = Read();
  catalogue.played[0].numbers[0].at = {"/hats"};
  catalogue.played[0].numbers[2].at = {"/tame"};
  EXPECT_THAT(
      hires::test_support::ConfigErrorOf([&] { PublishIt(catalogue); }),
      AllOf(HasSubstr("quick:/hats: the answer has nothing there"), HasSubstr("\nquick:/tame: ")));
}

TEST_F(PublishTest, AFileThatCannotBeWrittenIsSaidBeforeAnythingIsPlayed) {
  std::filesystem::create_directories(Path("docs/results.md"));
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { PublishIt(Read()); }),
              HasSubstr("docs/results.md"));
  EXPECT_FALSE(std::filesystem::exists(Path("count")));
}

TEST_F(PublishTest, PagesAreWrittenAgainFromTheNewestResults) {
  PublishIt(Read());
  folder_.Write("docs/results.md", "lost");
  std::string old = Text("lab/results/0.3.0.json");
  old.replace(old.find("0.3.0"), 5, "0.10.0");
  folder_.Write("lab/results/0.10.0.json", old);
  LabBackends backends;
  backends.package_folder = folder_.path().string();
  const auto ended = hires::test_support::RunLab({"publish", "--page-only"}, {}, backends);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("lab/results/0.10.0.json"));
  EXPECT_THAT(Text("docs/results.md"), HasSubstr("Of 0.10.0, 20"));
  EXPECT_EQ(Text("count"), "x") << "nothing is played";
}

TEST_F(PublishTest, BrokenResultsAreNamed) {
  const std::string path =
      folder_.Write("lab/results/0.3.0.json", R"({"version": "0.3.0", "numbers": [{"name": 7}]})");
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { ReadResults(path); }),
              AllOf(HasSubstr("0.3.0.json: number 1 cannot be read"), HasSubstr("publish")));
  std::filesystem::remove(path);
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { NewestResults(folder_.path()); }),
              HasSubstr("lab/results: has no results"));
}

TEST_F(PublishTest, TheVerbListsWhatIsPlayed) {
  const auto ended =
      hires::test_support::RunLab({"publish", "--list"}, {"--results", Path("answers")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("hires doctor --json"),
                               ::testing::ContainsRegex("[0-9]+ plays, [0-9]+ s in all; [0-9]+ s "
                                                        "are still to be played\n$")));
}

/// Numbers are written by a program, and not by hand.
TEST(PublishedPagesTest, AreWhatTheNewestResultsGive) {
  const std::string package = HIRES_SOURCE_DIR;
  const PublishCatalogue catalogue = ReadPublishCatalogue(package + "/lab/config/publish.yaml");
  const PublishedResults results = ReadResults(NewestResults(package));
  constexpr char kRemedy[] = "hires_lab publish --page-only writes it again";
  EXPECT_EQ(base::ReadTextFile(package + "/docs/results.md"), ResultsPage(catalogue, results))
      << kRemedy;
  EXPECT_EQ(base::ReadTextFile(package + "/lab/docs/results_details.md"),
            DetailsPage(catalogue, results))
      << kRemedy;
}

}  // namespace
}  // namespace hires::lab::publish_test
