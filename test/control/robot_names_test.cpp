#include "hires/control/robot_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::control::robot_names_test {
namespace {

using base::ConfigError;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

const std::string& Pr2File() {
  static const std::string path = std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2_names.yaml";
  return path;
}

/// The PR2's file with one piece of text replaced.
std::string Changed(const std::string& from, const std::string& to) {
  std::string text = base::ReadTextFile(Pr2File());
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << "the file has no '" << from << "' to change";
  return text.replace(place, from.size(), to);
}

std::string ErrorOf(const std::string& yaml) {
  try {
    ParseRobotNames(yaml, "names.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RobotNamesTest, SensorsMayBeLeftOutOneByOneOrAll) {
  EXPECT_EQ(ReadRobotNames(Pr2File()).sensors.depth_cloud,
            "head_mount_kinect/depth_registered/points");
  EXPECT_EQ(ReadRobotNames(Pr2File()).sensors.tray_scan, "tray_laser_scan");
  EXPECT_EQ(ReadRobotNames(Pr2File()).sensors.inertia, "torso_lift_imu/data");
  const RobotNames names = ParseRobotNames(Changed("  tilt_scan: tilt_scan\n", ""), "n.yaml");
  EXPECT_EQ(names.sensors.tilt_scan, "");
  EXPECT_EQ(names.sensors.tilt_cloud, "tilt_scan_cloud");
  const std::string fetch = HIRES_SOURCE_DIR "/config/robots/fetch_names.yaml";
  EXPECT_EQ(ReadRobotNames(fetch).sensors.depth_cloud, "");
}

TEST(RobotNamesTest, ABadNameOfASensorIsTold) {
  EXPECT_THAT(ErrorOf(Changed("tilt_scan: tilt_scan", "tilt_scan: /tilt")),
              AllOf(HasSubstr("sensors.tilt_scan is '/tilt'"), HasSubstr("relative")));
  EXPECT_THAT(ErrorOf(Changed("tilt_scan: tilt_scan", "tilt_scan: tray_laser_scan")),
              AllOf(HasSubstr("sensors.tray_scan"), HasSubstr("another one's")));
  EXPECT_THAT(ErrorOf(Changed("  tilt_scan:", "  tlit_scan:")), HasSubstr("sensors.tlit_scan"));
}

TEST(RobotNamesTest, ThePr2IsCalledWhatItIsCalled) {
  const RobotNames names = ReadRobotNames(Pr2File());
  EXPECT_EQ(names.map_frame, "map");
  EXPECT_EQ(names.odometry_frame, "odom_combined");
  EXPECT_EQ(names.base_frame, "base_footprint");
  EXPECT_EQ(names.base_command, "navigation/cmd_vel");
  EXPECT_EQ(names.odometry, "base_odometry/odom");
  EXPECT_EQ(names.joint_states, "joint_states");
  EXPECT_EQ(names.localisation, "amcl_pose");
  EXPECT_EQ(names.base_scan, "base_scan");
  EXPECT_EQ(names.map, "map");
  EXPECT_EQ(names.static_map, "static_map");
  EXPECT_EQ(names.motors_halted, "pr2_ethercat/motors_halted");
  EXPECT_EQ(names.robot_description, "robot_description");
  EXPECT_THAT(names.trajectories, ElementsAre(Pair("head", "head_traj_controller/command"),
                                              Pair("leftarm1", "l_arm_controller/command"),
                                              Pair("rightarm1", "r_arm_controller/command"),
                                              Pair("torso", "torso_controller/command")));
  EXPECT_THAT(names.grippers, ElementsAre(Pair("leftarm1", "l_gripper_controller/command"),
                                          Pair("rightarm1", "r_gripper_controller/command")));
  EXPECT_EQ(names.move_base.action, "move_base");
  EXPECT_EQ(names.move_base.planner, "move_base_node/DWAPlannerROS");
  EXPECT_THAT(names.move_base.parameters.at("max_angular_acceleration"),
              ElementsAre("acc_lim_theta", "acc_lim_th"));
}

TEST(RobotNamesTest, ControllersThatAreActionsAreLedByTheirGoals) {
  const RobotNames fetch =
      ReadRobotNames(std::string(HIRES_SOURCE_DIR) + "/config/robots/fetch_names.yaml");
  EXPECT_EQ(fetch.trajectory_interface, TrajectoryInterface::kFollowJointTrajectory);
  EXPECT_EQ(fetch.trajectories.at("rightarm1"), "arm_controller/follow_joint_trajectory/goal");
  EXPECT_EQ(fetch.gripper_interface, GripperInterface::kGripperCommand);
  EXPECT_THAT(fetch.grippers,
              ElementsAre(Pair("rightarm1", "gripper_controller/gripper_action/goal")));
  const RobotNames pr2 = ReadRobotNames(Pr2File());
  EXPECT_EQ(pr2.trajectory_interface, TrajectoryInterface::kJointTrajectory);
  EXPECT_EQ(pr2.gripper_interface, GripperInterface::kPr2GripperCommand);
}

TEST(RobotNamesTest, AMissingFileIsNamed) {
  EXPECT_THROW(ReadRobotNames("nowhere/names.yaml"), ConfigError);
}

struct BadFile {
  const char* from;
  const char* to;
  std::vector<const char*> words;  // of the message
};

class BadRobotNamesTest : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadRobotNamesTest, IsRefusedNamingFileLineAndKey) {
  const std::string error = ErrorOf(Changed(GetParam().from, GetParam().to));
  EXPECT_THAT(error, HasSubstr("names.yaml"));
  for (const char* word : GetParam().words) EXPECT_THAT(error, HasSubstr(word));
}

INSTANTIATE_TEST_SUITE_P(
    Frames, BadRobotNamesTest,
    ::testing::Values(
        BadFile{"  map: map", "  map: /map", {"frames.map is '/map'", "base_footprint", "line 4"}},
        BadFile{"  map: map", "  map: ''", {"frames.map is ''", "line 4"}},
        BadFile{"  base: base_footprint", "", {"frames.base is missing"}},
        BadFile{"odometry: odom_combined", "odometry: map", {"frames.odometry", "the map's"}},
        BadFile{"base: base_footprint", "base: odom_combined", {"frames.base", "already"}},
        BadFile{"  map: map", "  map: map\n  floor: floor", {"key 'frames.floor' is unknown"}}));

INSTANTIATE_TEST_SUITE_P(
    Topics, BadRobotNamesTest,
    ::testing::Values(
        BadFile{"base_scan: base_scan", "base_scan: /scan", {"base_scan is '/scan'", "relative"}},
        BadFile{"base_scan: base_scan", "base_scan: ~scan", {"base_scan is '~scan'"}},
        BadFile{"base_scan: base_scan", "base_scan: base scan", {"base_scan is 'base scan'"}},
        BadFile{"base_scan: base_scan", "base_scan: base//scan", {"base_scan is 'base//scan'"}},
        BadFile{"base_scan: base_scan", "base_scan: base/", {"base_scan is 'base/'"}},
        BadFile{"base_scan: base_scan", "base_scan: 2d_scan", {"base_scan is '2d_scan'"}},
        BadFile{"base_scan: base_scan", "base_scan: ''", {"base_scan is ''"}},
        BadFile{"base_scan: base_scan", "base_scan: [a, b]", {"base_scan is a list", "text"}},
        BadFile{"base_scan: base_scan", "laser: base_scan", {"base_scan is missing"}},
        BadFile{"map: map\nstatic", "map: map\nmap: map2\nstatic", {"map stands twice"}},
        BadFile{"joint_states: joint_states",
                "joint_states: joint_states\njoints: joints",
                {"key 'joints' is unknown", "did you mean"}}));

INSTANTIATE_TEST_SUITE_P(
    Groups, BadRobotNamesTest,
    ::testing::Values(
        BadFile{"  torso: torso_controller",
                "  trunk: torso_controller",
                {"trajectories.trunk", "group of joints 'trunk' is unknown", "line"}},
        BadFile{"  leftarm1: l_arm", "  leftArm1: l_arm", {"'leftArm1' is unknown", "leftarm1"}},
        BadFile{"  leftarm1: l_gripper",
                "  torso: l_gripper",
                {"grippers.torso", "arm 'torso' is unknown"}},
        BadFile{"r_arm_controller/command",
                "l_arm_controller/command",
                {"trajectories.rightarm1", "another one's already"}},
        BadFile{"torso_controller/command",
                "/torso_controller/command",
                {"trajectories.torso", "relative"}},
        BadFile{"grippers:",
                "gripper_interface: action\ngrippers:",
                {"gripper_interface is 'action'", "gripper_command"}},
        BadFile{"grippers: ", "grippers: 7 # ", {"no valid YAML", "line"}}));

INSTANTIATE_TEST_SUITE_P(
    MoveBase, BadRobotNamesTest,
    ::testing::Values(BadFile{"action: move_base", "action: ''", {"move_base.action", "both"}},
                      BadFile{"planner: move_base_node/DWAPlannerROS",
                              "planner: ''",
                              {"move_base.planner", "both"}},
                      BadFile{"max_linear_velocity: [max_vel_x]",
                              "max_speed: [max_vel_x]",
                              {"move_base.parameters.max_speed", "limit 'max_speed' is unknown"}},
                      BadFile{"max_linear_velocity: [max_vel_x]",
                              "",
                              {"move_base.parameters.max_linear_velocity is missing", "add it"}},
                      BadFile{"[max_vel_x]", "[]", {"max_linear_velocity", "newest first"}},
                      BadFile{"[max_vel_x]", "max_vel_x", {"max_linear_velocity", "list"}},
                      BadFile{"[max_vel_x]", "[max vel]", {"'max vel' is no parameter's name"}},
                      BadFile{"[max_vel_x]", "[a, a]", {"'a' stands twice"}}));

TEST(RobotNamesTest, ARobotMayHaveNoSwitchForItsMotorsAndNoMapServer) {
  EXPECT_EQ(ParseRobotNames(Changed("pr2_ethercat/motors_halted", "''"), "x").motors_halted, "");
  EXPECT_EQ(ParseRobotNames(Changed("static_map: static_map", "static_map: ''"), "x").static_map,
            "");
}

TEST(RobotNamesTest, ACartHasNoJointsAndNoMoveBase) {
  std::string text = base::ReadTextFile(Pr2File());
  text = text.substr(0, text.find("trajectories:")) +
         "trajectories: {}\ngrippers: {}\nmove_base: {action: '', planner: '', parameters: {}}\n";
  const RobotNames names = ParseRobotNames(text, "cart_names.yaml");
  EXPECT_THAT(names.trajectories, IsEmpty());
  EXPECT_THAT(names.grippers, IsEmpty());
  EXPECT_EQ(names.move_base.action, "");
}

TEST(RobotNamesTest, TextThatIsNoYamlIsRefused) {
  EXPECT_THAT(ErrorOf("frames: [unclosed"), AllOf(HasSubstr("names.yaml"), HasSubstr("line")));
  EXPECT_THAT(ErrorOf(""), HasSubstr("frames is missing"));
}

}  // namespace
}  // namespace hires::control::robot_names_test
