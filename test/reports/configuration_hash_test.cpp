// What makes a printed result stale, and what does not.

#include "reports/text/configuration_hash.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"

namespace hires::reports::configuration_hash_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ConfigurationHashTest : public ::testing::Test {
 protected:
  ConfigurationHashTest() {
    Write("config/scene.yaml", "world: a.world\nspeed: 1\n");
    Write("worlds/a.world", "<sdf/>");
    Write("urdf/pr2.urdf", "<robot/>");
    before_ = ConfigurationHash(folder_.path());
  }

  void Write(const std::string& name, const std::string& text) {
    const fs::path path = fs::path(folder_.path()) / name;
    fs::create_directories(path.parent_path());
    base::ReplaceTextFile(path.string(), text);
  }
  std::string Now() const { return ConfigurationHash(folder_.path()); }

  const base::RunFolder folder_{""};
  std::string before_;
};

TEST_F(ConfigurationHashTest, SeesValuesNamesAndFiles) {
  EXPECT_EQ(before_.size(), 16u);
  Write("config/scene.yaml", "world: a.world\nspeed: 2\n");
  EXPECT_NE(Now(), before_);
  Write("config/scene.yaml", "world: a.world\nspeed: 1\n");
  EXPECT_EQ(Now(), before_);
  Write("worlds/a.world", "<sdf />");
  EXPECT_NE(Now(), before_);
  Write("worlds/a.world", "<sdf/>");
  Write("config/more/new.yaml", "");
  EXPECT_NE(Now(), before_);
}

TEST_F(ConfigurationHashTest, AFileUnderAnotherNameIsAnotherConfiguration) {
  fs::rename(folder_.path() + "/urdf/pr2.urdf", folder_.path() + "/urdf/pr3.urdf");
  EXPECT_NE(Now(), before_);
}

TEST_F(ConfigurationHashTest, CommentsOfYamlCountForNothing) {
  Write("config/scene.yaml", "# Where it is.\nworld:   a.world  # the restaurant\n\nspeed: 1\n");
  EXPECT_EQ(Now(), before_);
}

TEST_F(ConfigurationHashTest, WhatSaysOnlyHowThingsAreShownOrStartedCountsForNothing) {
  Write("config/topple.rviz", "x: 1\n");
  Write("config/machines.launch", "<launch/>\n");
  EXPECT_EQ(Now(), before_);
}

TEST_F(ConfigurationHashTest, AnInputMayLeaveNamesOut) {
  const auto hash = [&] { return InputHash(folder_.path(), "config", {"config/plays"}); };
  const std::string before = hash();
  Write("config/plays_of_today.yaml", "plays: []\n");
  EXPECT_EQ(hash(), before);
  Write("config/more.yaml", "plays: []\n");
  EXPECT_NE(hash(), before);
}

TEST_F(ConfigurationHashTest, DocumentsOfOneFileAreToldApart) {
  Write("config/scene.yaml", "--- !A\nx: 1\n--- !B\nx: 2\n");
  const std::string two = Now();
  Write("config/scene.yaml", "--- !A\nx: 1\n--- !C\nx: 2\n");
  EXPECT_NE(Now(), two);
}

TEST_F(ConfigurationHashTest, BrokenYamlIsNamed) {
  Write("config/scene.yaml", "a: [1,\nb: }\n");
  try {
    Now();
    FAIL() << "broken YAML was read";
  } catch (const base::ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("config/scene.yaml: line 2"));
  }
}

}  // namespace
}  // namespace hires::reports::configuration_hash_test
