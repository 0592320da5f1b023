#include "hires/knowledge/blackboard_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::blackboard_config_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string Original() { return base::ReadTextFile(HIRES_SOURCE_DIR "/config/blackboard.yaml"); }

class BlackboardConfigTest : public ::testing::Test {
 protected:
  /// The repository's file with `to` in place of `from`.
  BlackboardConfig ReadWith(const std::string& from, const std::string& to) {
    std::string text = Original();
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return ReadBlackboardConfig(folder_.Write("b.yaml", text.replace(place, from.size(), to)));
  }
  std::string ErrorWith(const std::string& from, const std::string& to) {
    try {
      ReadWith(from, to);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(BlackboardConfigTest, PathsCountFromTheFileAndTheStoresFromHome) {
  const BlackboardConfig config = ReadWith("durability: process", "durability: power");
  const std::string folder = folder_.path().string();
  EXPECT_THAT(config.ontology,
              ElementsAre(folder + "/ontology/upper.ttl", folder + "/ontology/race.ttl"));
  EXPECT_THAT(config.knowledge, ElementsAre(folder + "/knowledge/restaurant.yaml"));
  EXPECT_EQ(config.store, ExpandHome("~/.ros/hires/blackboard.db"));
  EXPECT_EQ(config.options.durability, Durability::kPower);
  EXPECT_EQ(config.options.cache_bytes, 64u << 20);
  EXPECT_EQ(config.options.max_bytes, 0u);
  EXPECT_FALSE(config.imagined);
}

TEST_F(BlackboardConfigTest, WhatIsWrongIsNamed) {
  EXPECT_THAT(ErrorWith("durability: process", "durability: paper"),
              AllOf(HasSubstr("b.yaml"), HasSubstr("durability"), HasSubstr("process")));
  EXPECT_THAT(ErrorWith("threads: 8", "threads: 0"), HasSubstr("threads"));
  EXPECT_THAT(ErrorWith("threads: 8", "thraeds: 8"), HasSubstr("threads"));
  EXPECT_THAT(ErrorWith("imagined: false", "imagined: perhaps"), HasSubstr("imagined"));
  EXPECT_THAT(ErrorWith("threads: 8", "threads: 8\nmore: 1"), HasSubstr("more"));
  EXPECT_THAT(ErrorWith("~/.ros/hires/blackboard.db", "''"),
              HasSubstr("store is '', wanted a path"));
  EXPECT_THAT(ErrorWith("ontology:                  # Turtle or RDF/XML; concepts and relations\n"
                        "  - ontology/upper.ttl\n  - ontology/race.ttl",
                        "ontology: []"),
              HasSubstr("wanted paths of Turtle"));
}

TEST_F(BlackboardConfigTest, TheFolderOfAStoreIsMade) {
  const std::filesystem::path store = folder_.path() / "a" / "b" / "x.db";
  MakeFolderOf(store.string());
  EXPECT_TRUE(std::filesystem::is_directory(store.parent_path()));
  MakeFolderOf(":memory:");
  const std::string blocked = folder_.Write("file", "") + "/x.db";
  EXPECT_THROW(MakeFolderOf(blocked), base::ConfigError);
}

TEST(ExpandHomeTest, RosHomeTakesThePlaceOfItsDefault) {
  const char* before = std::getenv("ROS_HOME");
  const std::string restored = before == nullptr ? "" : before;
  setenv("ROS_HOME", "/elsewhere", 1);
  EXPECT_EQ(ExpandHome("~/.ros/hires/x.db"), "/elsewhere/hires/x.db");
  EXPECT_EQ(ExpandHome("~/x.db"), std::getenv("HOME") + std::string("/x.db"));
  setenv("ROS_HOME", "", 1);
  EXPECT_EQ(ExpandHome("~/.ros/x.db"), std::getenv("HOME") + std::string("/.ros/x.db"));
  before == nullptr ? unsetenv("ROS_HOME") : setenv("ROS_HOME", restored.c_str(), 1);
}

TEST(ExpandHomeTest, OnlyATildeInFrontStandsForHome) {
  EXPECT_EQ(ExpandHome("~/x"), std::getenv("HOME") + std::string("/x"));
  EXPECT_EQ(ExpandHome("/a/~/x"), "/a/~/x");
  EXPECT_EQ(ExpandHome("~x"), "~x");
  EXPECT_EQ(ExpandHome(":memory:"), ":memory:");
}

}  // namespace
}  // namespace hires::knowledge::blackboard_config_test
