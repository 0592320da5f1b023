#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::cli::file_doctor_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kFloorAndWall[] = R"(<sdf version="1.9"><world name="hall">
  <model name="floor"><static>true</static><link name="l"><collision name="c">
    <geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
  <model name="wall"><static>true</static><pose>2 WALL 0.5 0 0 0</pose><link name="l">
    <collision name="c"><geometry><box><size>0.1 2 1</size></box></geometry></collision></link></model>
  <frame name="near"/><frame name="far"><pose>4 0 0 0 0 0</pose></frame>
  <frame name="between"><pose>1 0 0 0 0 0</pose></frame>
</world></sdf>)";

constexpr char kBox[] = R"(<robot name="box"><link name="base"><collision>
  <origin xyz="0 0 0.15"/><geometry><box size="0.4 0.3 0.2"/></geometry></collision></link></robot>)";

class FileDoctorTest : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name)) << text;
    return Path(name);
  }
  std::string World(const std::string& wall_y) const {
    std::string text = kFloorAndWall;
    text.replace(text.find("WALL"), 4, wall_y);
    return Write("hall.world", text);
  }
  Ended Doctor(const std::vector<std::string>& words) const { return RunHires({"doctor"}, words); }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(FileDoctorTest, FilesAreReadAndADriveIsPlayedBetweenTheFarthestAreas) {
  const Ended ended = Doctor({"--world", World("2"), "--robot", Write("box.urdf", kBox), "--png",
                              Path("top.png"), "--json", Path("doctor.json")});
  EXPECT_EQ(ended.code, kExitRecommended) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("'hall' with 1 bodies that stand, 0 loose things, 3 areas"));
  EXPECT_THAT(ended.out, HasSubstr("robot " + Path("box.urdf") + ": 'box' with 1 links"));
  EXPECT_THAT(ended.out, HasSubstr("drive from far to near"));
  EXPECT_THAT(ended.out, HasSubstr("arrives after"));
  const json told = json::parse(base::ReadTextFile(Path("doctor.json")));
  EXPECT_TRUE(told.at("ok"));
  std::string levels;
  for (const json& finding : told.at("findings"))
    levels += finding.at("level").get<std::string>() + " ";
  EXPECT_THAT(levels, AllOf(HasSubstr("ok"), HasSubstr("note"), Not(HasSubstr("failed"))))
      << "what is assumed of a bare URDF";
  EXPECT_EQ(base::ReadTextFile(Path("top.png")).substr(1, 3), "PNG");
}

TEST_F(FileDoctorTest, TheDriveIsBetweenAreasThatWereAskedFor) {
  const std::vector<std::string> files{"--world", World("2"), "--robot", Write("box.urdf", kBox)};
  const auto drive = [&](std::vector<std::string> areas) {
    areas.insert(areas.begin(), files.begin(), files.end());
    return Doctor(areas).out;
  };
  EXPECT_THAT(drive({"--area", "left:0,-1,0", "--area", "right:0.5,-1,0"}),
              AllOf(HasSubstr("5 areas"), HasSubstr("drive from left to right")));
  EXPECT_THAT(drive({"--area", "left:0.5,-1,0"}), HasSubstr("drive from far to near"))
      << "one alone is no drive";
}

TEST_F(FileDoctorTest, WhatIsWrongWithOneFileHidesNothingOfTheOthers) {
  const Ended ended =
      Doctor({"--world", Write("hall.world", "<sdf version='1.9'><world"), "--robot",
              Write("box.urdf", "<robot name='box'/>"), "--map", Path("no.yaml")});
  EXPECT_EQ(ended.code, kExitBadInput);
  for (const char* file : {"hall.world", "box.urdf", "no.yaml"})
    EXPECT_THAT(ended.out, HasSubstr(Path(file)));
  EXPECT_THAT(ended.out, Not(HasSubstr("together they make a scene")));
}

/// A drive that comes near a loose thing is played again, with it.
TEST_F(FileDoctorTest, AWayThatIsPlayedAgainIsToldOnce) {
  std::string text = kFloorAndWall;
  text.replace(text.find("WALL"), 4, "9");
  text.insert(text.find("  <frame"), R"(<model name="crate"><pose>2 0.8 0.25 0 0 0</pose>
    <link name="l"><inertial><mass>1</mass><inertia><ixx>.04</ixx><iyy>.04</iyy><izz>.04</izz>
    </inertia></inertial><collision name="c"><geometry><box><size>0.5 0.5 0.5</size></box>
    </geometry></collision></link></model>)");
  const std::string out =
      Doctor({"--world", Write("crate.world", text), "--robot", Write("box.urdf", kBox), "--area",
              "a:0,0,0", "--area", "b:4,0,0"})
          .out;
  const std::size_t length = out.find(" m (one rollout");
  ASSERT_NE(length, std::string::npos) << out;
  EXPECT_NEAR(std::stod(out.substr(out.rfind(' ', length - 1))), 4.0, 0.3) << out;
}

TEST_F(FileDoctorTest, ADriveThatFailsIsAFinding) {
  std::string walls = kFloorAndWall;
  walls.replace(walls.find("WALL"), 4, "0");
  walls.replace(walls.find("0.1 2 1"), 7, "0.1 99 1");
  const Ended ended =
      Doctor({"--world", Write("cut.world", walls), "--robot", Write("box.urdf", kBox)});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.out, HasSubstr("FAILED  drive from far to near"));
}

TEST_F(FileDoctorTest, WithoutTwoAreasNoDriveIsPlayed) {
  std::string bare = kFloorAndWall;
  bare.replace(bare.find("WALL"), 4, "2");
  bare.erase(bare.find("<frame"), bare.find("</world>") - bare.find("<frame"));
  const std::string world = Write("bare.world", bare), robot = Write("box.urdf", kBox);
  EXPECT_THAT(Doctor({"--world", world, "--robot", robot}).out, HasSubstr("name two: --area"));
  const Ended ended =
      Doctor({"--world", world, "--robot", robot, "--area", "a:0,0,0", "--area", "b:1.2,0,0"});
  EXPECT_EQ(ended.code, kExitRecommended) << ended.out;
  EXPECT_THAT(ended.out, HasSubstr("drive from a to b"));
}

TEST_F(FileDoctorTest, WhatIsOfNoUseWithoutAWorldIsRefused) {
  EXPECT_THAT(Doctor({"--robot", "box.urdf"}).err, HasSubstr("--robot box.urdf: is looked at in"));
  EXPECT_THAT(Doctor({"--png", "a.png"}).err, HasSubstr("add --world FILE or --map FILE"));
  EXPECT_THAT(Doctor({"--world", World("2"), "--png", Path("no/top.png")}).err,
              HasSubstr("no/top.png"));
}

}  // namespace
}  // namespace hires::cli::file_doctor_test
