#include "robot/urdf/urdf_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "hires/robot/robot_model.h"
#include "support/log_catcher.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::robot::urdf_file_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::LogCatcher;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr char kXacro[] = R"(<robot name="bot" xmlns:xacro="http://ros.org/wiki/xacro">
<xacro:property name="l" value="0.5"/>
<link name="base"><collision><geometry><box size="${l} 0.4 0.6"/></geometry></collision></link>
</robot>)";

/// A program in the place of xacro, which does what its lines of shell say.
class XacroTest : public ::testing::Test {
 protected:
  XacroTest() : path_(std::getenv("PATH")) {}
  ~XacroTest() override { ::setenv("PATH", path_.c_str(), 1); }

  void PutXacro(const std::string& lines) {
    const std::string file = folder_.Write("bin/xacro", "#!/bin/sh\n" + lines);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    ::setenv("PATH", ((folder_.path() / "bin").string() + ":" + path_).c_str(), 1);
  }
  /// As xacro does with the one property of kXacro; its second argument is the length.
  void PutXacroThatExpands() {
    PutXacro(
        "length=0.5\n[ -n \"$2\" ] && length=${2#l:=}\n"
        "sed -e '/xacro:property/d' -e 's/xmlns:xacro=\"[^\"]*\"//' -e \"s/[$]{l}/$length/\" "
        "\"$1\"\n");
  }
  void HideXacro() { ::setenv("PATH", (folder_.path() / "empty").c_str(), 1); }

  TemporaryFolder folder_;
  std::string path_;
};

TEST_F(XacroTest, IsRunByEndingOrByWhatStandsInTheFile) {
  PutXacroThatExpands();
  for (const char* name : {"bot.urdf.xacro", "bot.xacro", "with blank.xacro", "bot.urdf"}) {
    const std::string path = folder_.Write(name, kXacro);
    const Robot robot = LoadAnyRobot(path);
    EXPECT_EQ(robot.model.name, "bot") << name;
    EXPECT_THAT(ReadUrdfOf(path, robot.profile), HasSubstr("0.5 0.4 0.6")) << name;
  }
}

TEST_F(XacroTest, GetsItsArguments) {
  PutXacroThatExpands();
  const std::string path = folder_.Write("my bot.xacro", kXacro) + "  l:=0.8";
  const Robot robot = LoadAnyRobot(path);
  EXPECT_THAT(ReadUrdfOf(path, robot.profile), HasSubstr("0.8 0.4 0.6"));
  const std::string profile = folder_.Write("bot.yaml", "urdf: my bot.xacro l:=0.7\n");
  EXPECT_THAT(ReadUrdfOf(profile, LoadRobot(profile).profile), HasSubstr("0.7 0.4 0.6"));
}

TEST_F(XacroTest, NothingOfANameIsReadByAShell) {
  PutXacroThatExpands();
  const std::string path = folder_.Write("$(touch pwned); rm 'x.xacro", kXacro);
  EXPECT_EQ(LoadAnyRobot(path).model.name, "bot");
}

TEST_F(XacroTest, WhatItSaysOfErrorsIsTold) {
  PutXacro("echo 'unknown macro: arm' >&2\nexit 2\n");
  const std::string path = folder_.Write("bot.xacro", kXacro);
  EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(path); }),
              AllOf(HasSubstr("bot.xacro: xacro failed with exit code 2: unknown macro: arm"),
                    HasSubstr("rosrun xacro xacro")));
  PutXacro("echo nothing\n");
  EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(path); }), HasSubstr("wrote no URDF"));
}

TEST_F(XacroTest, WhatItWarnsOfIsLogged) {
  PutXacro(
      "echo 'deprecated: in-order' >&2\necho \"<robot name='b'><link name='a'><collision>"
      "<geometry><sphere radius='1'/></geometry></collision></link></robot>\"\n");
  const LogCatcher log(base::LogLevel::kWarn);
  EXPECT_EQ(LoadAnyRobot(folder_.Write("b.xacro", kXacro)).model.name, "b");
  EXPECT_THAT(log.lines, Contains(HasSubstr("deprecated: in-order")));
}

TEST_F(XacroTest, WhereItIsNotTheCommandIsNamed) {
  HideXacro();
  const auto error_of = [&](const std::string& name, const std::string& arguments = "") {
    const std::string path = folder_.Write(name, kXacro);
    return ConfigErrorOf([&] { LoadAnyRobot(path + arguments); });
  };
  const std::string folder = folder_.path().string() + "/";
  EXPECT_THAT(error_of("bot.urdf.xacro"), HasSubstr("rosrun xacro xacro " + folder +
                                                    "bot.urdf.xacro > " + folder + "bot.urdf"));
  EXPECT_THAT(error_of("b.xacro", " a:=1 b:=x"),
              HasSubstr("xacro " + folder + "b.xacro a:=1 b:=x > " + folder + "b.urdf"));
  EXPECT_THAT(error_of("c.urdf"), HasSubstr("> " + folder + "c.expanded.urdf"));
  EXPECT_THAT(error_of("a b.xacro"), HasSubstr("xacro '" + folder + "a b.xacro' > '"));
}

TEST_F(XacroTest, WhatIsExpandedAlreadyNeedsNone) {
  HideXacro();
  const std::string path = folder_.Write(
      "done.urdf",
      "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><!-- ${l} $(find x) --><link "
      "name='a'><collision><geometry><sphere radius='1'/></geometry></collision></link></robot>");
  EXPECT_EQ(LoadAnyRobot(path).model.name, "r");
  EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(path + " l:=1"); }),
              AllOf(HasSubstr("is no xacro file"), HasSubstr("l:=1")));
}

/// A robot whose parts have `inside` where it is asked for.
std::string Bot(const std::string& in_robot, const std::string& in_link = "",
                const std::string& in_joint = "") {
  return "<robot name='r'><link name='a'><collision><geometry><sphere radius='1'/></geometry>"
         "</collision>" +
         in_link + "</link><link name='b'/><joint name='j' type='fixed'><parent link='a'/>" +
         "<child link='b'/>" + in_joint + "</joint>" + in_robot + "</robot>";
}

TEST_F(XacroTest, MacrosThatNoRobotIsReadFromNeedNone) {
  HideXacro();
  for (const std::string macro : {"$(find p)/c.yaml", "$(env HOME)", "$(arg a)", "${l}"}) {
    const std::string text = "<parameters a='" + macro + "'>" + macro + "</parameters>";
    for (const std::string& urdf :
         {Bot("<gazebo><plugin name='p' filename='x.so'>" + text + "</plugin></gazebo>"),
          Bot("<gazebo reference='a'><material>" + macro +
              "</material><sensor type='ray' name='s'>" + text + "</sensor></gazebo>"),
          Bot("<transmission name='t'>" + text + "</transmission><ros2_control>" + text +
              "</ros2_control><material name='" + macro + "'/>"),
          Bot("", "<visual><geometry><mesh filename='" + macro + "'/></geometry></visual>"),
          Bot("", "",
              "<safety_controller k_velocity='" + macro + "'/><dynamics>" + text +
                  "</dynamics>")}) {
      EXPECT_EQ(LoadRobotModel(folder_.Write("done.urdf", urdf)).links.size(), 2u) << urdf;
    }
    for (const std::string& urdf :
         {Bot("<gazebo reference='a'><mu1>" + macro + "</mu1></gazebo>"),
          Bot("<gazebo reference='" + macro + "'/>"),
          Bot("<gazebo reference='a'><sensor type='" + macro + "'/></gazebo>"),
          Bot("", "<collision><geometry><mesh filename='" + macro + "'/></geometry></collision>"),
          Bot("", "<inertial><mass value='" + macro + "'/></inertial>"), Bot("", "<xacro:mass/>"),
          Bot("", "", "<origin xyz='" + macro + " 0 0'/>"), Bot("<xacro:arm/>")}) {
      EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(folder_.Write("raw.urdf", urdf)); }),
                  HasSubstr("is a xacro file"))
          << urdf;
    }
  }
}

TEST_F(XacroTest, WhateverStandsBeforeTheDeclarationIsLeftOut) {
  HideXacro();
  const std::string declaration = "<?xml version='1.0' encoding='UTF-8'?>\n";
  for (const std::string bom : {"", "\xEF\xBB\xBF"}) {
    for (const std::string before : {"", "\n\n", " \t\r\n", "<!-- ${l} -->",
                                     "<!-- a -->\n<!-- b\n -->\n", "<!DOCTYPE robot>\n"}) {
      const std::string path = folder_.Write("c.urdf", bom + before + declaration + Bot(""));
      EXPECT_EQ(LoadAnyRobot(path).model.name, "r") << before;
      EXPECT_EQ(LoadRobotModel(path).name, "r") << before;
      const std::string wrong = bom + before + declaration + Bot("<link name='a'/>");
      const auto line = 1 + std::count(wrong.begin(), wrong.end(), '\n');
      EXPECT_THAT(
          ConfigErrorOf([&] { LoadAnyRobot(folder_.Write("d.urdf", wrong)); }),
          AllOf(HasSubstr("'a' is there twice"), HasSubstr("line " + std::to_string(line))));
    }
  }
}

TEST_F(XacroTest, TextThatIsNoUtf8OrDoesNotEndIsNamed) {
  for (const std::string& start : {std::string("\xFF\xFE<\0", 4), std::string("\xFE\xFF\0<", 4)}) {
    EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(folder_.Write("w.urdf", start)); }),
                AllOf(HasSubstr("w.urdf"), HasSubstr("UTF-16"), HasSubstr("save it")));
  }
  EXPECT_THAT(ConfigErrorOf([&] { LoadAnyRobot(folder_.Write("e.urdf", "\n<!-- " + Bot(""))); }),
              HasSubstr("e.urdf:2: not well-formed XML: a comment begins here"));
}

TEST(SplitArgumentsTest, TakesArgumentsFromTheEndAlone) {
  EXPECT_EQ(SplitArguments("bot.xacro").path, "bot.xacro");
  EXPECT_THAT(SplitArguments("bot.xacro").arguments, IsEmpty());
  const UrdfFile file = SplitArguments("my bot.xacro a:=1  b:=x/y");
  EXPECT_EQ(file.path, "my bot.xacro");
  EXPECT_THAT(file.arguments, ElementsAre("a:=1", "b:=x/y"));
  EXPECT_EQ(TextOf(file), "my bot.xacro a:=1 b:=x/y");
}

}  // namespace
}  // namespace hires::robot::urdf_file_test
