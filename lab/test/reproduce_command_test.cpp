#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hires/base/files/writer_lock.h"
#include "hires/base/text.h"
#include "lab/src/reproduce/play_runner.h"
#include "lab/src/reproduce/play_store.h"
#include "lab/test/lab_run.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::reproduce_command_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Key;

/// Plays are played by a shell: `sh -c WORDS`.
class ReproduceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(Path("package/config"));
    folder_.Write("package/input.yaml", "a: 1\n");
    folder_.Write("package/lab/config/reproduce.yaml", "plays: []\n");
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  PlayStore Store(const std::string& build = "b1") const {
    return PlayStore({Path("results"), Path("package"), build});
  }
  static Play Shell(const std::string& name, const std::string& script) {
    Play play;
    play.name = name;
    play.command = {"-c", script};
    play.inputs = {"."};
    play.seconds = 1.0;
    play.done_codes = {0, 2};
    return play;
  }
  PlaysDone PlayThem(
      std::vector<Play> plays, bool again = false,
      const std::function<bool()>& cancelled = [] { return false; }) const {
    PlaysOrder order;
    order.plays = std::move(plays);
    order.program = order.lab_program = "/bin/sh";
    order.package = Path("package");
    order.again = again;
    order.cancelled = cancelled;
    PlayStore store = Store();
    return PlayAll(order, &store);
  }
  std::string Counted() const { return base::ReadTextFile(Path("count")); }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(ReproduceTest, WhatHasAnAnswerIsNotPlayedAgain) {
  const std::vector<Play> plays{
      Shell("one", "printf x >> " + Path("count") + "; echo '{\"x\": 1}' > {answer}; exit 2")};
  const PlaysDone first = PlayThem(plays), second = PlayThem(plays);
  EXPECT_EQ(Counted(), "x");
  EXPECT_TRUE(first.answers.at("one").is_new);
  EXPECT_FALSE(second.answers.at("one").is_new);
  EXPECT_EQ(second.answers.at("one").content.at("x"), 1);
  PlayThem(plays, true);
  EXPECT_EQ(Counted(), "xx");
  folder_.Write("package/lab/config/reproduce.yaml", "plays: [1]\n");
  folder_.Write("package/lab/config/publish.yaml", "plays: [2]\n");
  PlayThem(plays);
  EXPECT_EQ(Counted(), "xx") << "other bounds ask for no other answer";
  folder_.Write("package/input.yaml", "# of today\na:  1\n");
  PlayThem(plays);
  EXPECT_EQ(Counted(), "xx") << "a comment changes no answer";
  folder_.Write("package/input.yaml", "a: 2\n");
  PlayThem(plays);
  EXPECT_EQ(Counted(), "xxx") << "it rests on another file now";
}

TEST_F(ReproduceTest, AnAnswerOfAnotherBuildSaysSo) {
  const Play play = Shell("one", "echo 1 > {answer}");
  PlayThem({play});
  PlayStore other = Store("b2");
  other.KeyOf(play);
  ASSERT_TRUE(other.Find(play));
  EXPECT_EQ(other.Find(play)->build, "b1");
}

TEST_F(ReproduceTest, AnAnswerKnowsItsDayOrIsPlayedAgain) {
  const Play play = Shell("one", "echo 1 > {answer}");
  EXPECT_THAT(PlayThem({play}).answers.at("one").date,
              ::testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}"));
  PlayStore store = Store();
  folder_.Write("results/one-" + store.KeyOf(play) + "/played.json",
                R"({"build": "b1", "wall_seconds": 1})");
  EXPECT_FALSE(store.Find(play));
  EXPECT_TRUE(PlayThem({play}).answers.at("one").is_new);
}

TEST_F(ReproduceTest, APlayThatFailsIsToldAndTheOthersGoOn) {
  const PlaysDone done = PlayThem(
      {Shell("killed", "kill -9 $$"),
       Shell("wrong", "echo 1 > {answer}; echo no such world; exit 1"), Shell("silent", "exit 0"),
       Shell("needs", "cat {wrong} > {answer}"), Shell("good", "echo '{}' > {answer}")});
  EXPECT_THAT(done.answers, ElementsAre(Key("good")));
  EXPECT_THAT(done.missing.at("killed"), HasSubstr("signal 9"));
  EXPECT_THAT(done.missing.at("wrong"),
              AllOf(HasSubstr("exit code 1"), HasSubstr("no such world")));
  EXPECT_THAT(done.missing.at("silent"), HasSubstr("exit code 0"));
  EXPECT_THAT(done.missing.at("needs"), HasSubstr("needs the answer of 'wrong'"));
}

TEST_F(ReproduceTest, APlayTakesTheAnswerOfAnother) {
  const PlaysDone done =
      PlayThem({Shell("first", "echo '{\"x\": 7}' > {answer}; echo 8 > {folder}/beside"),
                Shell("second", "cp {first} {answer}; test 8 = $(cat {first/folder}/beside)")});
  EXPECT_EQ(done.answers.at("second").content.at("x"), 7);
}

TEST_F(ReproduceTest, InterruptedItKeepsWhatIsDone) {
  const std::string begun = Path("begun");
  const std::vector<Play> plays{Shell("quick", "echo 1 > {answer}"),
                                Shell("endless", "touch " + begun + "; while :; do :; done"),
                                Shell("never", "echo 1 > {answer}")};
  const PlaysDone done = PlayThem(plays, false, [&] { return std::filesystem::exists(begun); });
  EXPECT_TRUE(done.is_cancelled);
  EXPECT_THAT(done.answers, ElementsAre(Key("quick")));
  EXPECT_THAT(done.missing, Contains(Key("endless")));
  EXPECT_THAT(done.missing.at("never"), HasSubstr("not reached"));
}

TEST_F(ReproduceTest, InterruptedWhilePlayingAnewItKeepsTheAnswersOfTheOthers) {
  const std::string begun = Path("begun");
  const Play first = Shell("first", "echo 1 > {answer}");
  const Play slow = Shell("slow", "if test -e " + begun + "; then while :; do :; done; fi; touch " +
                                      begun + "; echo 1 > {answer}");
  const Play last = Shell("last", "printf x >> " + Path("count") + "; echo 1 > {answer}");
  PlayThem({first, slow, last});
  int looks = 0;
  const PlaysDone done = PlayThem({first, slow, last}, true, [&] { return ++looks > 3; });
  EXPECT_TRUE(done.is_cancelled);
  std::string why;
  for (const auto& [play, reason] : done.missing) why += reason;
  EXPECT_THAT(why, HasSubstr("the same command without --again goes on"));
  PlayStore store = Store();
  for (const Play& play : {first, slow, last}) store.KeyOf(play);
  EXPECT_TRUE(store.Find(last)) << "its turn had not come";
  EXPECT_EQ(Counted(), "x");
}

TEST_F(ReproduceTest, ABrokenNoteIsNamed) {
  const Play play = Shell("one", "echo 1 > {answer}");
  PlayThem({play});
  PlayStore store = Store();
  folder_.Write("results/one-" + store.KeyOf(play) + "/played.json", "{");
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { store.Find(play); }),
              AllOf(HasSubstr("played.json"), HasSubstr("delete its folder")));
}

TEST_F(ReproduceTest, OneAtATimeWritesAFolder) {
  const std::string results = folder_.path().string();
  const base::WriterLock lock(results + "/results", "wait");
  const auto run = [&](const std::vector<std::string>& words) {
    return hires::test_support::RunLab({"reproduce"}, words);
  };
  const auto refused = run({"5.1", "--results", results, "--quiet"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("is being written by process"),
                                 HasSubstr("name another folder with --results")));
  EXPECT_EQ(run({"5.1", "--list", "--results", results}).code, 0);
}

TEST_F(ReproduceTest, TheVerbListsPlaysAndJudges) {
  const auto run = [&](const std::vector<std::string>& words) {
    return hires::test_support::RunLab({"reproduce"}, words);
  };
  const std::string results = Path("r");
  EXPECT_THAT(run({"5.1", "--list", "--results", results}).out,
              AllOf(HasSubstr("Fig. 5.1"),
                    ::testing::ContainsRegex("\n[0-9]+ plays, [0-9]+ s in all; [0-9]+ s "
                                             "are still to be played\n$")));
  EXPECT_THAT(
      run({"9.9", "--results", results}).err,
      HasSubstr("'9.9' is unknown; did you mean '5.9' or 'A.9'?; `hires_lab reproduce --list`"));
  const hires::test_support::Ended shown =
      run({"5.1", "--results", results, "--json", Path("r.json"), "--quiet"});
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.out, HasSubstr("5 described"));
  const auto answer = nlohmann::json::parse(base::ReadTextFile(Path("r.json")));
  EXPECT_EQ(answer.at("/report/verb"_json_pointer), "reproduce");
  EXPECT_EQ(answer.at("/verdicts/described"_json_pointer), 5);
  EXPECT_THAT(run({"Fig. 5.1", "--results", results, "--quiet"}).out,
              HasSubstr("\n1 table, figure or section: 1 described\n"));
}

TEST_F(ReproduceTest, UndecidedChecksAreCountedApartFromUndecidedResults) {
  const std::string item =
      ", section: '6.1', title: t, plays: [ratio], holds: yes, fails: no, bounds: ours, values: "
      "[{name: v, at: /x, over: /y, published: 1, at_least: 1}]}\n";
  const std::string path = folder_.Write(
      "catalogue.yaml",
      "plays: [{name: ratio, seconds: 1, inputs: [], command: \"list --json {answer}\"}]\nitems:\n"
      "  - {item: Table 1" +
          item + "  - {own: true, item: Table 2" + item);
  const Play play = ReadCatalogue(path).plays.front();
  PlayStore store({Path("results"), HIRES_SOURCE_DIR, "another build"});
  store.MakeRoom(play);
  base::ReplaceTextFile(store.AnswerOf(play), R"({"x": 1, "y": 0})");
  store.Keep(play, 1.0);
  const std::string results = Path("results");
  const hires::test_support::Ended ended = hires::test_support::RunLab(
      {"reproduce"},
      {"--catalogue", path, "--results", results, "--json", Path("r.json"), "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("2 tables, figures and sections: 1 check undecided, "
                                   "1 undecided\n"));
  EXPECT_THAT(ended.out, HasSubstr("another build of this version, from the same files: 1 of 1 "
                                   "answer;"));
  const auto answer = nlohmann::json::parse(base::ReadTextFile(Path("r.json")));
  EXPECT_EQ(answer.at("verdicts"), (nlohmann::json{{"undecided", 1}, {"check undecided", 1}}));
}

TEST_F(ReproduceTest, AMinusIsNoFile) {
  for (const char* option : {"--html", "--json"}) {
    const hires::test_support::Ended ended = hires::test_support::RunLab(
        {"reproduce"}, {"5.1", "--results", Path("r"), "--quiet", option, "-"});
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.err, HasSubstr(std::string(option) + " -: is no file"));
    EXPECT_EQ(ended.out, "");
  }
  EXPECT_FALSE(std::filesystem::exists("-"));
}

}  // namespace
}  // namespace hires::lab::reproduce_command_test
