#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "support/log_catcher.h"
#include "support/messages.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::written_profile_test {
namespace {

using hires::test_support::LogCatcher;
using hires::test_support::Rounds;
using hires::test_support::TemporaryFolder;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRoot = HIRES_SOURCE_DIR;

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines = base::Split(text, '\n');
  lines.pop_back();
  return lines;
}

TEST(WriteProfileTest, OurRobotsGiveTheSameRobotBitByBit) {
  const TemporaryFolder folder;
  for (const char* name : {"cart", "car", "pr2_tray"}) {
    const std::string urdf = kRoot + "/urdf/" + name + ".urdf";
    const std::string text = WriteProfile(urdf, folder.path().string());
    const Robot robot = LoadRobot(folder.Write(std::string(name) + ".yaml", text));
    const Robot bare = LoadRobotFromUrdf(urdf);
    EXPECT_EQ(robot.hash(), bare.hash()) << text;
    EXPECT_THAT(LinesOf(text), Each(HasSubstr("# "))) << "a comment for each line";
    EXPECT_EQ(robot.assumed, bare.assumed) << "nobody has corrected anything";
    EXPECT_THAT(robot.assumed, Contains(HasSubstr("motion_sets")));
  }
}

/// A box with wheels, an arm, a tray with something on it, as chance has it.
std::string DrawUrdf(base::Rng* rng) {
  std::string text = fmt::format(
      "<robot name='drawn \"{0}\"'>\n<link name='base: #{0}'><collision><origin xyz='{1} {2} {3}'/>"
      "<geometry><box size='{4} {5} 0.3'/></geometry></collision></link>\n",
      rng->Index(100), rng->Uniform(-0.2, 0.2), rng->Uniform(-0.2, 0.2), rng->Uniform(-0.1, 0.3),
      rng->Uniform(0.2, 1.0), rng->Uniform(0.2, 1.0));
  const std::string root = text.substr(text.find("base: #"));
  const std::string name = root.substr(0, root.find('\''));
  const auto add = [&](const std::string& link, const std::string& type, double z,
                       const std::string& shape) {
    text += fmt::format(
        "<link name='{0}'><collision><geometry>{1}</geometry></collision></link>\n<joint "
        "name='to_{0}' type='{2}'><origin xyz='{3} {4} {5}' rpy='{6} 0 {7}'/><parent link='{8}'/>"
        "<child link='{0}'/><axis xyz='0 1 0'/><limit lower='0.2' upper='1' velocity='1' "
        "effort='1'/></joint>\n",
        link, shape, type, rng->Uniform(-0.3, 0.3), rng->Uniform(-0.3, 0.3), z,
        type == "continuous" ? 0.0 : 0.1 * rng->Index(2), 0.3 * rng->Index(3), name);
  };
  const int num_wheels = rng->Index(4);
  for (int i = 0; i < num_wheels; ++i)
    add(fmt::format("wheel{}", i), "continuous", 0.0, "<sphere radius='0.1'/>");
  if (rng->Bernoulli(0.5)) add("arm", "revolute", 0.3, "<box size='0.8 0.05 0.05'/>");
  if (rng->Bernoulli(0.7)) add("tray", "fixed", 0.6, "<box size='0.5 0.4 0.02'/>");
  if (rng->Bernoulli(0.5)) add("lidar", "fixed", 0.65, "<cylinder radius='0.05' length='0.1'/>");
  return text + "</robot>";
}

TEST(WriteProfileTest, DrawnRobotsGiveTheSameRobotBitByBit) {
  base::Rng rng(11);
  const TemporaryFolder folder;
  for (int round = 0; round < Rounds(100); ++round) {
    const std::string urdf = folder.Write("a/drawn robot.urdf", DrawUrdf(&rng));
    const std::string text = WriteProfile(urdf, (folder.path() / "b").string());
    const Robot bare = LoadRobotFromUrdf(urdf);
    const Robot robot = LoadRobot(folder.Write("b/drawn.yaml", text));
    ASSERT_EQ(robot.hash(), bare.hash()) << text;
    EXPECT_EQ(robot.base_height, bare.base_height);
    EXPECT_EQ(robot.assumed, bare.assumed);
    EXPECT_THAT(LinesOf(text), Each(HasSubstr("# ")));
  }
}

TEST(WriteProfileTest, WhatIsNoLongerACommentIsNoLongerAssumed) {
  const TemporaryFolder folder;
  const std::string text = WriteProfile(kRoot + "/urdf/cart.urdf", folder.path().string());
  std::string checked;
  for (const std::string& line : LinesOf(text)) {
    const bool is_key = line.rfind("# ", 0) == 0 && line.find(": ASSUMED") == std::string::npos &&
                        line.find(" # ") != std::string::npos &&
                        line.rfind("# laser_link", 0) != 0 &&  // it would drive by it then
                        line.rfind("# object_on_tray", 0) != 0;
    checked += (is_key ? line.substr(2) : line) + "\n";
  }
  const Robot robot = LoadRobot(folder.Write("checked.yaml", checked));
  EXPECT_EQ(robot.hash(), LoadRobotFromUrdf(kRoot + "/urdf/cart.urdf").hash()) << checked;
  EXPECT_THAT(robot.assumed, Not(Contains(HasSubstr("motion_sets"))));
  EXPECT_THAT(robot.assumed, Not(Contains(HasSubstr("base_controller"))));
}

/// A fixed link, turned by yaw; with a ray sensor, or none.
std::string LaserAt(const std::string& name, double yaw, bool has_sensor) {
  return fmt::format(
      "<link name='{0}'/><joint name='{0}_joint' type='fixed'><origin rpy='0 0 {1}'/>"
      "<parent link='base'/><child link='{0}'/></joint>{2}",
      name, yaw,
      has_sensor
          ? fmt::format("<gazebo reference='{}'><sensor type='ray' name='s'/></gazebo>", name)
          : "");
}

TEST(WriteProfileTest, OfSeveralLasersTheOneThatLooksAheadIsSuggested) {
  struct Case {
    std::string lasers, first;
  };
  const TemporaryFolder folder;
  for (const Case& one : std::vector<Case>{
           {LaserAt("laser_a", M_PI, false) + LaserAt("laser_b", 0.0, false), "laser_b"},
           {LaserAt("laser_a", M_PI, true) + LaserAt("laser_b", 0.1, true), "laser_b"},
           {LaserAt("laser_a", 0.0, true) + LaserAt("laser_b", 0.0, true), "laser_a"},
           {LaserAt("back_laser", -2.36, true) + LaserAt("front_laser", 0.79, true), "front_laser"},
           {LaserAt("back_laser", 0.0, true) + LaserAt("front_laser", 0.0, true), "front_laser"},
           {LaserAt("laser_left", M_PI_2, true) + LaserAt("laser_ahead", 0.0, false),
            "laser_left"}}) {
    const std::string urdf = folder.Write(
        "bot.urdf",
        "<robot name='bot'><link name='base'><collision><geometry><box size='0.4 0.3 0.1'/>"
        "</geometry></collision></link>" +
            one.lasers + "</robot>");
    const std::string key = "laser_link: " + one.first;
    EXPECT_THAT(WriteProfile(urdf, folder.path().string()),
                testing::ContainsRegex("laser_link: [\"']?" + one.first))
        << one.lasers;
    EXPECT_THAT(LoadRobotFromUrdf(urdf).assumed, Contains(HasSubstr("`" + key + "`")))
        << one.lasers;
  }
}

TEST(WriteProfileTest, ARobotWithoutShapesHasAFootprintToFillIn) {
  const TemporaryFolder folder;
  const std::string urdf = folder.Write(
      "ghost.urdf",
      "<robot name='ghost'><link name='base'><visual><geometry><box size='0.4 0.3 0.1'/></geometry>"
      "</visual></link></robot>");
  const LogCatcher log(base::LogLevel::kWarn);
  const std::string text = WriteProfile(urdf, folder.path().string());
  EXPECT_THAT(log.lines, Contains(HasSubstr("fill in its profile's line `footprint`")));
  EXPECT_THAT(LinesOf(text), Each(HasSubstr("# ")));
  EXPECT_THAT(
      hires::test_support::ConfigErrorOf([&] { LoadRobot(folder.Write("ghost.yaml", text)); }),
      HasSubstr("give 'footprint' in a profile"));
  std::string filled = text;
  filled.replace(filled.find("\nfootprint: []"), 14,
                 "\nfootprint: [[0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1], [0.2, -0.1]]");
  EXPECT_EQ(LoadRobot(folder.Write("ghost.yaml", filled)).profile.footprint.size(), 4u);
}

TEST(WriteProfileTest, LengthsAreRoundedToATenthOfAMillimetre) {
  base::Rng rng(6);
  const TemporaryFolder folder;
  for (int round = 0; round < Rounds(30); ++round) {
    const double yaw = 0.25 * M_PI * rng.Index(8), x = rng.Uniform(-1.0, 1.0);
    const std::string urdf = folder.Write(
        "r.urdf",
        fmt::format("<robot name='r'><link name='b'><collision><origin xyz='0 0 0.2' rpy='0 0 "
                    "{0}'/><geometry><box size='0.6 0.4 0.2'/></geometry></collision></link><joint "
                    "name='j' type='fixed'><origin xyz='{1} 0 0.5' rpy='0 0 {0}'/><parent "
                    "link='b'/><child link='tray'/></joint><link name='tray'><collision><origin "
                    "xyz='0.1 0 0' rpy='0 0 {0}'/><geometry><box size='0.3 0.3 0.02'/></geometry>"
                    "</collision></link></robot>",
                    yaw, x));
    const std::string text = WriteProfile(urdf, folder.path().string());
    for (const char* none : {"-0,", "-0]", "-0}"}) EXPECT_THAT(text, Not(HasSubstr(none)));
    EXPECT_THAT(text, Not(ContainsRegex("[0-9]e-[0-9]")));
  }
}

}  // namespace
}  // namespace hires::robot::written_profile_test
