#include "cli/local_verbs.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_run.h"
#include "cli/package_folder.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "support/temporary_folder.h"

namespace hires::cli::local_verbs_test {
namespace {

using test_support::Capture;
using test_support::Ended;
using test_support::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

Ended RunLocal(std::vector<std::string> words) {
  words.insert(words.begin(), "hires_local");
  return Capture([&] { return RunLocalCommandLine(words, HIRES_SOURCE_DIR); });
}

TEST(LocalVerbsTest, HelpNamesWhatNeedsNoNodes) {
  const Ended ended = RunLocal({"--help"});
  EXPECT_EQ(ended.code, 0);
  for (const char* verb : {"imagine", "limits", "list", "new", "doctor"}) {
    EXPECT_THAT(ended.out, HasSubstr(verb));
  }
  EXPECT_THAT(ended.out, Not(HasSubstr("achieve")));
  EXPECT_THAT(RunLocal({"--version"}).out, HasSubstr("hires_local "));
}

TEST(LocalVerbsTest, ImaginesTheSameAsTheWholeProgram) {
  const TemporaryFolder folder;
  const std::string one = (folder.path() / "one.json").string(),
                    other = (folder.path() / "other.json").string();
  const std::vector<std::string> question{"imagine",
                                          "--local",
                                          "--quiet",
                                          "--world",
                                          HIRES_SOURCE_DIR "/worlds/workshop.world",
                                          "--from",
                                          "dock",
                                          "--object",
                                          "peppermill1",
                                          "--action",
                                          "move_base_param",
                                          "--arg",
                                          "atBench",
                                          "--arg",
                                          "slow,fast",
                                          "--rollouts",
                                          "2",
                                          "--seed",
                                          "7",
                                          "--json"};
  const auto ask = [&](const std::string& file) {
    std::vector<std::string> words = question;
    words.push_back(file);
    return words;
  };
  const Ended small = RunLocal(ask(one)), whole = test_support::RunHires(ask(other));
  EXPECT_EQ(small.code, whole.code);
  auto a = nlohmann::json::parse(base::ReadTextFile(one)),
       b = nlohmann::json::parse(base::ReadTextFile(other));
  for (auto* answer : {&a, &b}) {
    answer->erase("report");  // program, command, when
    answer->erase("wall_seconds");
    answer->erase("real_time_factor");
  }
  EXPECT_EQ(a, b);
}

TEST(LocalVerbsTest, ListsNoTasks) {
  const Ended ended = RunLocal({"list", "tasks"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("'hires list tasks' does"));
  EXPECT_THAT(RunLocal({"list"}).err, Not(HasSubstr("'tasks'")));
  EXPECT_EQ(RunLocal({"list", "areas"}).code, 0);
}

TEST(LocalVerbsTest, StandInsForGazebosModelsAreFoundWithoutRos) {
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  const std::string kept = before != nullptr ? before : "";
  const TemporaryFolder folder;
  const std::string world = (folder.path() / "plane.world").string();
  std::ofstream(world) << "<sdf version='1.6'><world name='w'><include><uri>model://ground_plane"
                          "</uri></include></world></sdf>";
  setenv("ROS_PACKAGE_PATH", "/somewhere", 1);
  EXPECT_EQ(RunLocal({"list", "areas", "--world", world}).code, 1);
  NamePackageFolder(HIRES_SOURCE_DIR);
  EXPECT_STREQ(std::getenv("ROS_PACKAGE_PATH"), "/somewhere:" HIRES_SOURCE_DIR);
  const Ended ended = RunLocal({"list", "areas", "--world", world});
  EXPECT_EQ(ended.code, 0) << ended.err;
  setenv("ROS_PACKAGE_PATH", kept.c_str(), 1);
}

TEST(LocalVerbsTest, AsksNobody) {
  const Ended ended = RunLocal({"imagine", "--action", "move_base", "--from", "home"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("--local"));
}

TEST(LocalVerbsTest, NewWritesARobotsProfileThatIsTheSameRobot) {
  const TemporaryFolder folder;
  const std::string urdf = HIRES_SOURCE_DIR "/urdf/cart.urdf",
                    profile = (folder.path() / "cart.yaml").string();
  const Ended ended = RunLocal({"new", "robot", urdf, "--output", profile});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("--robot " + profile));
  EXPECT_EQ(robot::LoadAnyRobot(profile).hash(), robot::LoadAnyRobot(urdf).hash());
  const Ended again = RunLocal({"new", "robot", urdf, "--output", profile});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("is there already"));
  EXPECT_EQ(RunLocal({"new", "robot", urdf, "--output", profile, "--force"}).code, 0);
  EXPECT_EQ(RunLocal({"new"}).code, 1);
  EXPECT_THAT(RunLocal({"new", "robot", "none.urdf", "--output", profile, "--force"}).err,
              HasSubstr("none.urdf"));
}

}  // namespace
}  // namespace hires::cli::local_verbs_test
