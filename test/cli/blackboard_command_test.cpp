#include "cli/verbs/blackboard/blackboard_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/command_run.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/blackboard_config.h"
#include "support/temporary_folder.h"

namespace hires::cli::blackboard_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kTwoMugs[] = R"(!Fluent
Class_Instance: [Mug, mug1]
StartTime: [0, 0]
FinishTime: [0, 0]
Properties:
  - [hasPose, Pose, poseMug1]
---
!Fluent
Class_Instance: [Pose, poseMug1]
StartTime: [0, 0]
FinishTime: [0, 0]
Properties:
  - [hasX, "xsd:float", 1.5]
  - [hasY, "xsd:float", 2.0]
  - [hasZ, "xsd:float", 0.7]
  - [hasYaw, "xsd:float", 0.0]
---
!Fluent
Class_Instance: [Mug, mug2]
StartTime: [10, 11]
FinishTime: [0, 0]
Properties:
  - [hasPose, Pose, poseMug1]
)";

constexpr char kShift[] = R"(!FluentPoseModification
Instance: poseMug1
Group: mugs
Choices: 1
Modifications:
  - [hasX, [0.25]]
Attachments: []
)";

class BlackboardCommandTest : public ::testing::Test {
 protected:
  /// `hires blackboard WORDS`.
  Ended Run(const std::vector<std::string>& words) const { return RunHires({"blackboard"}, words); }
  /// The same on this test's store.
  Ended OnStore(std::vector<std::string> words) const {
    words.insert(words.end(), {"--store", store_});
    return Run(words);
  }
  Ended Load(const std::string& yaml) const {
    return OnStore({"load", folder_.Write("knowledge.yaml", yaml)});
  }
  std::vector<std::string> InstancesOf(std::vector<std::string> words) const {
    words.insert(words.begin(), "query");
    words.insert(words.end(), {"--json", "-"});
    const Ended ended = OnStore(words);
    EXPECT_EQ(ended.code, 0) << ended.err;
    std::vector<std::string> names;
    for (const json& fluent : json::parse(ended.out)) names.push_back(fluent["instance"]);
    return names;
  }

  test_support::TemporaryFolder folder_;
  std::string store_ = (folder_.path() / "blackboard.db").string();
};

TEST_F(BlackboardCommandTest, LoadSaysHowManyFluentsOfWhichClassesWentIn) {
  const Ended ended = Load(kTwoMugs);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out,
            "class  fluents\n"
            "--------------\n"
            "Mug          2\n"
            "Pose         1\n"
            "\n"
            "3 fluents of 2 classes added\n");
}

TEST_F(BlackboardCommandTest, WhatWasKnownAlreadyIsNotLoadedAgain) {
  Load(kTwoMugs);
  EXPECT_EQ(Load(kTwoMugs).out, "0 fluents of 0 classes added, 3 known already\n");
}

TEST_F(BlackboardCommandTest, ModificationsMovePosesThatTheStoreHolds) {
  Load(kTwoMugs);
  const Ended ended = Load(kShift);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("1 fluent of 1 class added, 1 modification applied"));
  EXPECT_THAT(InstancesOf({"--property", "hasX=1.75"}), ElementsAre("poseMug1"));
  EXPECT_THAT(InstancesOf({"--property", "hasX=1.5"}), ElementsAre());
}

TEST_F(BlackboardCommandTest, ABadFileEndsWithOneAndNamesTheLine) {
  const Ended ended = Load("!Fluent\nClass_Instance: [Mug, mug1]\nStartTme: [0, 0]\n");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("knowledge.yaml"), HasSubstr("3"), HasSubstr("StartTme")));
}

TEST_F(BlackboardCommandTest, AnUnknownClassIsRefusedWithTheNearestNamesAndNothingGoesIn) {
  std::string yaml = kTwoMugs;
  yaml.replace(yaml.find("[Mug, mug2]"), 11, "[Mugg, mug2]");
  const Ended ended = Load(yaml);
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("'Mugg'"), HasSubstr("'Mug'")));
  EXPECT_THAT(InstancesOf({"--ever"}), ElementsAre());
}

TEST_F(BlackboardCommandTest, QueryTakesEachOfItsFilters) {
  Load(kTwoMugs);
  EXPECT_THAT(InstancesOf({}), ElementsAre("mug1", "mug2", "poseMug1"));
  EXPECT_THAT(InstancesOf({"--class", "PhysicalEntity"}), ElementsAre("mug1", "mug2"));
  EXPECT_THAT(InstancesOf({"--class", "PhysicalEntity", "--exact"}), ElementsAre());
  EXPECT_THAT(InstancesOf({"--instance", "MUG2"}), ElementsAre("mug2"));
  EXPECT_THAT(InstancesOf({"--property", "hasPose"}), ElementsAre("mug1", "mug2"));
  EXPECT_THAT(InstancesOf({"--property", "hasX=1.5", "--property", "hasY=2"}),
              ElementsAre("poseMug1"));
  EXPECT_THAT(InstancesOf({"--class", "Mug", "--at", "5"}), ElementsAre("mug1"));
  EXPECT_THAT(InstancesOf({"--limit", "2"}), ElementsAre("mug1", "mug2"));
}

TEST_F(BlackboardCommandTest, QueryPrintsATable) {
  Load(kTwoMugs);
  const Ended ended = OnStore({"query", "--class", "Mug"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("mug2"), HasSubstr("10..11"), HasSubstr("ever"),
                               HasSubstr("hasPose=poseMug1"), HasSubstr("2 fluents\n")));
}

TEST_F(BlackboardCommandTest, ExportWritesWhatLoadReads) {
  Load(kTwoMugs);
  const Ended ended = OnStore({"export"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::string file = (folder_.path() / "out.yaml").string();
  EXPECT_EQ(OnStore({"export", "--output", file}).code, 0);
  EXPECT_EQ(base::ReadTextFile(file), ended.out);
  const std::string other = (folder_.path() / "other.db").string();
  EXPECT_EQ(Run({"load", file, "--store", other}).code, 0);
  EXPECT_EQ(Run({"export", "--store", other}).out, ended.out);
}

TEST_F(BlackboardCommandTest, EpisodesAreListedAndFoundByNameOrNumber) {
  const auto config = knowledge::ReadBlackboardConfig(HIRES_SOURCE_DIR "/config/blackboard.yaml");
  {
    knowledge::Store store(store_, std::make_shared<const knowledge::Ontology>(
                                       knowledge::Ontology::FromFiles(config.ontology)));
    const auto episode = store.StartEpisode("serve", knowledge::Episode::Label::kReal, 0, 100.0);
    store.Add({{"Mug", "mug7", {}, {}, {}}}, {knowledge::Source::kObservation, episode.id, 101.0});
    store.FinishEpisode(episode.id, "succeeded", 102.0);
  }
  const Ended ended = OnStore({"episodes"});
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("serve"), HasSubstr("succeeded"), HasSubstr("1 episode\n")));
  const json listed = json::parse(OnStore({"episodes", "--json", "-"}).out);
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_THAT(InstancesOf({"--episode", listed[0]["name"]}), ElementsAre("mug7"));
  EXPECT_THAT(InstancesOf({"--episode", std::to_string(listed[0]["id"].get<int>())}),
              ElementsAre("mug7"));
  const Ended unknown = OnStore({"query", "--episode", "99"});
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("episode '99' is unknown"));
}

TEST_F(BlackboardCommandTest, StatsCountsFluentsAndChanges) {
  Load(kTwoMugs);
  const json stats = json::parse(OnStore({"stats", "--json", "-"}).out);
  EXPECT_EQ(stats["fluents"], 3);
  EXPECT_EQ(stats["changes"], 3);
  EXPECT_EQ(stats["store"], store_);
}

TEST_F(BlackboardCommandTest, ReadingMakesNoFile) {
  const Ended ended = OnStore({"query"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr(store_));
  EXPECT_FALSE(std::filesystem::exists(store_));
}

TEST_F(BlackboardCommandTest, WithoutRosAFileMustBeNamed) {
  const Ended ended = Run({"stats"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("--store"));
}

TEST_F(BlackboardCommandTest, WrongWordsEndWithOne) {
  Load(kTwoMugs);
  EXPECT_EQ(OnStore({}).code, 1);
  EXPECT_EQ(OnStore({"lod", "x"}).code, 1);
  EXPECT_EQ(OnStore({"load"}).code, 1);
  EXPECT_EQ(OnStore({"query", "--exact"}).code, 1);
  EXPECT_EQ(OnStore({"query", "--at", "5", "--ever"}).code, 1);
  EXPECT_EQ(OnStore({"query", "--limit", "0"}).code, 1);
  EXPECT_EQ(OnStore({"load", "/nowhere.yaml"}).code, 1);
  const Ended property = OnStore({"query", "--property", "=3"});
  EXPECT_EQ(property.code, 1);
  EXPECT_THAT(property.err, HasSubstr("no role"));
  const Ended value = OnStore({"query", "--property", "hasX=abc"});
  EXPECT_EQ(value.code, 1);
  EXPECT_THAT(value.err, HasSubstr("the text 'abc'; wanted a number"));
  EXPECT_THAT(OnStore({"query", "--class", "Mugg"}).err, HasSubstr("'Mug'"));
}

TEST(ParsePropertyFilterTest, ValuesAreOfTheKindTheyLookLike) {
  EXPECT_FALSE(ParsePropertyFilter("hasPose").filler.has_value());
  EXPECT_EQ(ParsePropertyFilter("hasX=3").filler, knowledge::Filler(std::int64_t{3}));
  EXPECT_EQ(ParsePropertyFilter("hasX=-2.5e1").filler, knowledge::Filler(-25.0));
  EXPECT_EQ(ParsePropertyFilter("isOpen=true").filler, knowledge::Filler(true));
  EXPECT_EQ(ParsePropertyFilter("hasPose=poseMug1").filler,
            knowledge::Filler(std::string("poseMug1")));
  EXPECT_EQ(ParsePropertyFilter("hasText=\"3\"").filler, knowledge::Filler(std::string("3")));
  EXPECT_EQ(ParsePropertyFilter("hasText=").filler, knowledge::Filler(std::string()));
  EXPECT_EQ(ParsePropertyFilter("hasText=a=b").filler, knowledge::Filler(std::string("a=b")));
  EXPECT_EQ(ParsePropertyFilter("hasX=nan").filler, knowledge::Filler(std::string("nan")));
  EXPECT_THROW(ParsePropertyFilter("=3"), base::ConfigError);
  EXPECT_THROW(ParsePropertyFilter(""), base::ConfigError);
}

}  // namespace
}  // namespace hires::cli::blackboard_command_test
