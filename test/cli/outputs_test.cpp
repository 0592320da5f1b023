#include "cli/outputs.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::cli::outputs_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Ended;
using hires::test_support::RunHires;
using hires::test_support::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

using Words = std::vector<std::string>;

/// A verb with all that it reads, and the options by which it writes.
struct VerbCase {
  Words words;
  Words inputs;   // of the words; a map's picture, too
  Words outputs;  // options
  Words required{};
};

class OutputsTest : public testing::Test {
 protected:
  /// Nothing is done with them: each case ends before.
  OutputsTest() {
    for (const char* name :
         {"world", "robot", "objects", "uncertainty", "domain", "problem", "operators", "log",
          "cloud", "config", "knowledge", "store", "answer"}) {
      folder_.Write(std::string(name) + ".yaml", "a: 1\n");
    }
    folder_.Write("goals.yaml", "dock: [0, 0, 0]\n");
    folder_.Write("map.yaml", "image: map.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\n");
    folder_.Write("map.pgm", "P2 2 2 255 254 0 205 254\n");
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// "world.yaml" becomes a path.
  Words WithPaths(Words words) const {
    for (std::string& word : words) {
      if (word.find(".yaml") != std::string::npos || word.find(".pgm") != std::string::npos)
        word = Path(word);
    }
    return words;
  }
  Ended Run(const VerbCase& verb, const Words& options) const {
    Words words = WithPaths(verb.words);
    words.insert(words.end(), options.begin(), options.end());
    for (const std::string& option : verb.required) {
      if (std::find(options.begin(), options.end(), option) == options.end())
        words.insert(words.end(), {option, Path("free.yaml")});
    }
    return RunHires(words);
  }

  const TemporaryFolder folder_;
};

std::vector<VerbCase> VerbsOfScenes() {
  const Words files{"--robot",      "robot.yaml",    "--objects",
                    "objects.yaml", "--uncertainty", "uncertainty.yaml"};
  const auto with = [&](Words words) {
    words.insert(words.end(), files.begin(), files.end());
    return words;
  };
  const Words read{"robot.yaml", "objects.yaml", "uncertainty.yaml"};
  const auto and_read = [&](Words more) {
    more.insert(more.end(), read.begin(), read.end());
    return more;
  };
  const Words imagine{"imagine",  "--local",     "--quiet",  "--from",          "dock",
                      "--object", "peppermill1", "--action", "move_base_param", "--arg",
                      "dock",     "--arg",       "fast",     "--save-rollout",  "worst",
                      "--area",   "goals.yaml"};
  const auto imagined = [&](const Words& more) {
    Words words = with(imagine);
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const Words saved{"--json", "--html", "--csv", "--bag", "--gif", "--strip"};
  return {
      {imagined({"--world", "world.yaml"}), and_read({"world.yaml", "goals.yaml"}), saved},
      {imagined({"--map", "map.yaml"}), {"map.yaml", "map.pgm"}, saved},
      {with({"list", "areas", "--map", "map.yaml", "--area", "goals.yaml"}),
       and_read({"map.yaml", "map.pgm", "goals.yaml"}),
       {"--json"}},
      {with({"list", "objects", "--world", "world.yaml"}), and_read({"world.yaml"}), {"--json"}},
      {{"list", "tasks", "--domain", "domain.yaml"}, {"domain.yaml"}, {"--json"}},
      {with({"limits", "--object", "peppermill1"}), read, {"--yaml", "--json"}},
      {{"doctor", "--world", "world.yaml", "--robot", "robot.yaml", "--area", "goals.yaml"},
       {"world.yaml", "robot.yaml", "goals.yaml"},
       {"--json", "--html", "--png"}},
      {{"doctor", "--map", "map.yaml"}, {"map.yaml", "map.pgm"}, {"--json", "--html", "--png"}},
      {{"achieve", "--local", "--world", "world.yaml", "--robot", "robot.yaml", "--objects",
        "objects.yaml", "--area", "goals.yaml", "--domain", "domain.yaml", "--operators",
        "operators.yaml"},
       {"world.yaml", "robot.yaml", "objects.yaml", "goals.yaml", "domain.yaml", "operators.yaml"},
       {"--json", "--html", "--png", "--timeline", "--store"}},
      {{"achieve", "--local", "--map", "map.yaml"}, {"map.yaml", "map.pgm"}, {"--json", "--store"}},
  };
}

std::vector<VerbCase> VerbsOfFiles() {
  std::vector<VerbCase> cases{
      {{"plan", "--domain", "domain.yaml", "--problem", "problem.yaml"},
       {"domain.yaml", "problem.yaml"},
       {"--json", "--html"}},
      {{"new", "robot", "robot.yaml", "--force"}, {"robot.yaml"}, {"--output"}},
      {{"recognise", "cloud.yaml", "--objects", "objects.yaml", "--config", "config.yaml"},
       {"cloud.yaml", "objects.yaml", "config.yaml"},
       {"--json", "--labels"}},
      {{"localise", "log.yaml", "--map", "map.yaml", "--config", "config.yaml"},
       {"log.yaml", "map.yaml", "map.pgm", "config.yaml"},
       {"--trajectory", "--json"},
       {"--trajectory"}},
      {{"map", "log.yaml"}, {"log.yaml"}, {"--output", "--trajectory", "--json"}, {"--output"}},
      {{"map", "--drive", "--world", "world.yaml", "--robot", "robot.yaml", "--area", "goals.yaml"},
       {"world.yaml", "robot.yaml", "goals.yaml"},
       {"--output", "--trajectory", "--json", "--log", "--truth"},
       {"--output"}},
      {{"map", "--drive", "--map", "map.yaml"},
       {"map.yaml", "map.pgm"},
       {"--trajectory", "--json", "--log", "--truth"},
       {"--output"}},
      {{"report", "answer.yaml"}, {"answer.yaml"}, {"--html", "--png"}},
      {{"blackboard", "load", "knowledge.yaml"}, {"knowledge.yaml"}, {"--json", "--store"}},
      {{"blackboard", "load", "knowledge.yaml", "--store", "store.yaml"},
       {"knowledge.yaml"},
       {"--json"}},
      {{"blackboard", "export", "--store", "store.yaml"}, {"store.yaml"}, {"--output"}},
      {{"blackboard", "diff", "1", "2", "--store", "store.yaml"}, {"store.yaml"}, {"--json"}},
  };
  for (const char* what : {"query", "episodes", "stats"}) {
    cases.push_back({{"blackboard", what, "--store", "store.yaml", "--config", "config.yaml"},
                     {"store.yaml", "config.yaml"},
                     {"--json"}});
  }
  return cases;
}

std::vector<VerbCase> AllVerbs() {
  std::vector<VerbCase> all = VerbsOfScenes();
  for (const VerbCase& verb : VerbsOfFiles()) all.push_back(verb);
  return all;
}

TEST_F(OutputsTest, NoVerbWritesOverWhatItReads) {
  for (const VerbCase& verb : AllVerbs()) {
    for (const std::string& option : verb.outputs) {
      for (const std::string& input : verb.inputs) {
        const std::string before = base::ReadTextFile(Path(input));
        const Ended ended = Run(verb, {option, Path("./" + input)});
        EXPECT_EQ(ended.code, kExitBadInput) << base::Join(verb.words, " ") << " " << option;
        EXPECT_THAT(ended.err, AllOf(HasSubstr(option + " " + Path("./" + input)),
                                     HasSubstr("would write over the")))
            << base::Join(verb.words, " ");
        EXPECT_EQ(base::ReadTextFile(Path(input)), before);
      }
    }
  }
}

TEST_F(OutputsTest, NoVerbWritesTwoOutputsToOneFile) {
  for (const VerbCase& verb : AllVerbs()) {
    for (std::size_t i = 0; i < verb.outputs.size(); ++i) {
      for (std::size_t j = i + 1; j < verb.outputs.size(); ++j) {
        const Ended ended =
            Run(verb, {verb.outputs[i], Path("both.yaml"), verb.outputs[j], Path("./both.yaml")});
        EXPECT_EQ(ended.code, kExitBadInput) << base::Join(verb.words, " ");
        EXPECT_THAT(ended.err, AllOf(HasSubstr(verb.outputs[i]), HasSubstr(verb.outputs[j]),
                                     HasSubstr("name two files")))
            << base::Join(verb.words, " ");
        EXPECT_FALSE(std::filesystem::exists(Path("both.yaml")));
      }
    }
  }
}

TEST_F(OutputsTest, APictureBesideAnOutputIsAnOutput) {
  folder_.Write("drive.pgm", "FLASER\n");
  const Ended mapped = RunHires({"map", Path("drive.pgm"), "--output", Path("drive.yaml")});
  EXPECT_EQ(mapped.code, kExitBadInput);
  EXPECT_THAT(mapped.err,
              HasSubstr("picture of --output " + Path("drive.pgm") + ": would write over the log"));
  EXPECT_EQ(base::ReadTextFile(Path("drive.pgm")), "FLASER\n");
  const VerbCase imagine = VerbsOfScenes().front();
  EXPECT_THAT(Run(imagine, {"--html", Path("page.html"), "--gif", Path("page_worst.png")}).err,
              HasSubstr("name two files"));
}

TEST_F(OutputsTest, TwoOutputsMayNotBeOneFileThatIsNotThereYet) {
  const std::string absolute = std::filesystem::absolute("no_such_out").string();
  for (const std::string& other : {std::string("./no_such_out"), absolute}) {
    EXPECT_THAT(ConfigErrorOf([&] {
                  CheckOutputs({{"--json", "no_such_out"}, {"--csv", other}}, {});
                }),
                HasSubstr("name two files"))
        << other;
  }
}

TEST_F(OutputsTest, OneFileIsOneUnderAnyName) {
  std::filesystem::create_symlink(Path("log.yaml"), Path("link"));
  std::filesystem::create_hard_link(Path("log.yaml"), Path("other"));
  for (const char* name : {"link", "other", "log.yaml"}) {
    EXPECT_THAT(ConfigErrorOf([&] {
                  CheckOutputs({{"--json", Path(name)}}, {{"log", Path("log.yaml")}});
                }),
                HasSubstr("would write over the log; name another file"))
        << name;
    EXPECT_THAT(ConfigErrorOf([&] {
                  CheckOutputs({{"--json", Path(name)}, {"--csv", Path("log.yaml")}}, {});
                }),
                HasSubstr("name two files"))
        << name;
  }
  CheckOutputs({{"--json", "/dev/null"}, {"--csv", "/dev/null"}}, {{"log", "/dev/null"}});
  CheckOutputs({{"--json", "-", true}, {"--csv", ""}}, {{"log", Path("log.yaml")}});
}

}  // namespace
}  // namespace hires::cli::outputs_test
