#include "hires/robot/robot_profile.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "support/temporary_folder.h"

namespace hires::robot::robot_profile_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A stranger's robot: a box on three wheels with a tray that stands on a post.
constexpr char kTricycle[] = R"(<?xml version="1.0"?>
<robot name="tricycle">
  <link name="chassis">
    <inertial><origin xyz="0 0 0.2"/><mass value="12"/>
      <inertia ixx="0.3" ixy="0" ixz="0" iyy="0.4" iyz="0" izz="0.5"/></inertial>
    <collision name="box"><origin xyz="0.1 0 0.2"/>
      <geometry><box size="0.6 0.4 0.3"/></geometry></collision>
  </link>
  <joint name="post" type="prismatic"><origin xyz="0.1 0 0.35"/>
    <parent link="chassis"/><child link="Serving_Tray"/><axis xyz="0 0 1"/>
    <limit lower="0.2" upper="0.6" velocity="0.05" effort="100"/></joint>
  <link name="Serving_Tray">
    <collision><origin xyz="0 0 0.01"/><geometry><box size="0.3 0.3 0.02"/></geometry></collision>
    <collision><origin xyz="0 0 -0.1"/>
      <geometry><cylinder radius="0.02" length="0.2"/></geometry></collision>
  </link>
  <joint name="camera" type="fixed"><origin xyz="0.1 0 0.1"/>
    <parent link="Serving_Tray"/><child link="tray_camera"/></joint>
  <link name="tray_camera">
    <collision><geometry><box size="0.05 0.05 0.05"/></geometry></collision>
  </link>
  <joint name="front" type="continuous"><origin xyz="0.3 0 0.1" rpy="1.57079632679 0 0"/>
    <parent link="chassis"/><child link="front_wheel"/><axis xyz="0 0 1"/></joint>
  <link name="front_wheel">
    <collision><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
  <joint name="left" type="continuous"><origin xyz="-0.1 0.25 0.1" rpy="1.57079632679 0 0"/>
    <parent link="chassis"/><child link="left_wheel"/><axis xyz="0 0 1"/></joint>
  <link name="left_wheel">
    <collision><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
  <joint name="right" type="continuous"><origin xyz="-0.1 -0.25 0.1" rpy="1.57079632679 0 0"/>
    <parent link="chassis"/><child link="right_wheel"/><axis xyz="0 0 1"/></joint>
  <link name="right_wheel">
    <collision><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
</robot>)";

constexpr char kProfile[] = R"(urdf: robots/tricycle.urdf
base_link: chassis
tray_link: Serving_Tray
object_on_tray: {xyz: [0.05, 0.0, 0.02], rpy: [0.0, 0.0, 0.1]}
laser_link: ""
footprint: [{x: 0.4, y: 0.3}, {x: 0.4, y: -0.3}, {x: -0.2, y: -0.3}, {x: -0.2, y: 0.3}]
footprint_padding: 0.02
motion_sets:
  Brisk: {max_linear_velocity: 0.9, max_angular_velocity: 1.1, max_linear_acceleration: 1.2, max_angular_acceleration: 1.3}
default_motion_set: brisk
base_controller:
  drive: differential
  limits: {max_linear_velocity: 1.5, max_angular_velocity: 2.5, max_linear_acceleration: 3.5, max_angular_acceleration: 4.5}
  max_linear_jerk: 9.0
  command_timeout: 0.3
  at_timeout: ramp
  command_lag: 0.04
  loop_frequency: 20.0
  loop_damping: 0.7
  sway_compliance: 0.002
  sway_frequency: 11.0
  sway_damping: 0.3
joints: {post: 0.4}
)";

class RobotProfileFile : public ::testing::Test {
 protected:
  RobotProfileFile() { folder_.Write("robots/tricycle.urdf", kTricycle); }

  std::string Write(const std::string& yaml) const { return folder_.Write("robot.yaml", yaml); }

  /// The profile with the first `from` replaced.
  std::string WriteWith(const std::string& from, const std::string& to) const {
    std::string yaml = kProfile;
    const std::size_t at = yaml.find(from);
    if (at == std::string::npos) throw std::logic_error("not in the profile: " + from);
    return Write(yaml.replace(at, from.size(), to));
  }

  void ExpectRefused(const std::string& from, const std::string& to,
                     const std::vector<std::string>& says) const {
    const std::string path = WriteWith(from, to);
    try {
      LoadRobot(path);
      ADD_FAILURE() << to << " was accepted";
    } catch (const base::ConfigError& error) {
      for (const std::string& words : says) EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_THAT(error.what(), HasSubstr(folder_.path().string()));
    }
  }

  test_support::TemporaryFolder folder_;
};

constexpr char kLastLimit[] = "max_angular_acceleration: 1.3}";

TEST_F(RobotProfileFile, DecelerationsAreReadAndAreThoseOfTheAccelerationElse) {
  const Robot plain = LoadRobot(Write(kProfile));
  EXPECT_EQ(plain.profile.motion_sets.at("brisk").linear_deceleration(), 1.2);
  EXPECT_EQ(plain.profile.base_controller.limits.angular_deceleration(), 4.5);
  EXPECT_EQ(plain.profile.base_controller.emergency_deceleration, 0.0);
  const Robot robot = LoadRobot(WriteWith(kLastLimit,
                                          "max_angular_acceleration: 1.3, "
                                          "max_linear_deceleration: 0.4, "
                                          "max_angular_deceleration: 0.6}"));
  EXPECT_EQ(robot.profile.motion_sets.at("brisk").linear_deceleration(), 0.4);
  EXPECT_EQ(robot.profile.motion_sets.at("brisk").angular_deceleration(), 0.6);
  EXPECT_NE(robot.profile.hash, plain.profile.hash);
  const Robot hard = LoadRobot(
      WriteWith("at_timeout: ramp", "at_timeout: ramp\n  emergency_deceleration: 5.0"));
  EXPECT_EQ(hard.profile.base_controller.emergency_deceleration, 5.0);
  EXPECT_NE(hard.profile.hash, plain.profile.hash);
}

TEST_F(RobotProfileFile, DecelerationsOfNavigationAreReadWhereThereAreNoneInTheProfile) {
  folder_.Write("nav2.yaml",
                "controller_server:\n  ros__parameters:\n"
                "    FollowPath: {decel_lim_x: -2.5, decel_lim_theta: -3.2, acc_lim_x: 2.5}\n"
                "velocity_smoother:\n  ros__parameters: {max_decel: [-0.5, 0.0, -4.0]}\n");
  const std::string profile = std::string(kProfile) + "navigation: nav2.yaml\n";
  const MotionSet set = LoadRobot(Write(profile)).profile.motion_sets.at("brisk");
  EXPECT_EQ(set.max_linear_deceleration, 0.5) << "the smaller one";
  EXPECT_EQ(set.max_angular_deceleration, 3.2);
  folder_.Write("dwa.yaml", "DWAPlannerROS: {acc_lim_x: 2.5, acc_lim_theta: 3.2}\n");
  const Robot dwa = LoadRobot(Write(std::string(kProfile) + "navigation: dwa.yaml\n"));
  EXPECT_EQ(dwa.profile.hash, LoadRobot(Write(kProfile)).profile.hash) << "DWA defines none";
}

TEST_F(RobotProfileFile, BadDecelerationsAreRefused) {
  ExpectRefused(kLastLimit, "max_angular_acceleration: 1.3, max_linear_deceleration: -1}",
                {"motion_sets.Brisk.max_linear_deceleration is '-1'", "between"});
  ExpectRefused("at_timeout: ramp", "at_timeout: stop\n  emergency_deceleration: 5.0",
                {"emergency_deceleration", "at_timeout: ramp"});
  folder_.Write("bad.yaml", "a:\n  decel_lim_x: fast\n  decel_lim_theta: 0\n");
  ExpectRefused("joints: {post: 0.4}", "joints: {post: 0.4}\nnavigation: bad.yaml",
                {"bad.yaml: decel_lim_x in line 2 is 'fast'", "other than 0"});
  ExpectRefused("joints: {post: 0.4}", "joints: {post: 0.4}\nnavigation: gone.yaml",
                {"gone.yaml", "cannot be read"});
}

TEST_F(RobotProfileFile, EveryFieldIsRead) {
  const Robot robot = LoadRobot(Write(kProfile));
  const RobotProfile& profile = robot.profile;
  EXPECT_EQ(robot.model.name, "tricycle");
  EXPECT_EQ(profile.urdf, "robots/tricycle.urdf");
  EXPECT_EQ(profile.base_link, "chassis");
  EXPECT_EQ(profile.tray_link, "Serving_Tray");
  EXPECT_EQ(profile.X_TO.translation, Eigen::Vector3d(0.05, 0.0, 0.02));
  EXPECT_NEAR(geometry::YawOf(profile.X_TO.rotation), 0.1, 1e-12);
  EXPECT_EQ(profile.laser_link, "");
  EXPECT_EQ(profile.footprint.size(), 4u);
  EXPECT_TRUE(geometry::Contains(profile.footprint, {0.39, 0.29}));
  EXPECT_FALSE(geometry::Contains(profile.footprint, {-0.21, 0.0}));
  EXPECT_EQ(profile.footprint_padding, 0.02);
  const MotionSet& brisk = profile.motion_sets.at("brisk");
  EXPECT_EQ(brisk.max_linear_velocity, 0.9);
  EXPECT_EQ(brisk.max_angular_velocity, 1.1);
  EXPECT_EQ(brisk.max_linear_acceleration, 1.2);
  EXPECT_EQ(brisk.max_angular_acceleration, 1.3);
  EXPECT_EQ(profile.default_motion_set, "brisk");
  const BaseControllerParams& base = profile.base_controller;
  EXPECT_EQ(base.limits.max_angular_acceleration, 4.5);
  EXPECT_EQ(base.drive, Drive::kDifferential);
  EXPECT_EQ(base.max_linear_jerk, 9.0);
  EXPECT_EQ(base.command_timeout, 0.3);
  EXPECT_EQ(base.command_lag, 0.04);
  EXPECT_EQ(base.loop_frequency, 20.0);
  EXPECT_EQ(base.loop_damping, 0.7);
  EXPECT_EQ(base.sway_compliance, 0.002);
  EXPECT_EQ(base.sway_frequency, 11.0);
  EXPECT_EQ(base.sway_damping, 0.3);
  EXPECT_EQ(profile.joints.at("post"), 0.4);
}

TEST_F(RobotProfileFile, EmptyFootprintComesFromTheShapes) {
  const Robot robot =
      LoadRobot(WriteWith("footprint: [{x: 0.4, y: 0.3}, {x: 0.4, y: -0.3}, {x: -0.2, y: -0.3}, "
                          "{x: -0.2, y: 0.3}]",
                          "footprint: []"));
  EXPECT_TRUE(geometry::Contains(robot.profile.footprint, {0.399, 0.199}));
  EXPECT_TRUE(geometry::Contains(robot.profile.footprint, {-0.1, 0.269}));
  EXPECT_FALSE(geometry::Contains(robot.profile.footprint, {0.41, 0.0}));
}

TEST_F(RobotProfileFile, HashIgnoresLayoutAndPlace) {
  const Robot robot = LoadRobot(Write(kProfile));
  const std::string moved = folder_.Write(
      "elsewhere/my.yaml", "# a comment\n" + [] {
        std::string yaml = kProfile;
        return yaml.replace(yaml.find("robots/"), 7, "../robots/");
      }());
  EXPECT_EQ(LoadRobot(moved).hash(), robot.hash());
}

TEST_F(RobotProfileFile, WhatHasADefaultMayBeLeftOut) {
  const Robot robot = LoadRobot(Write(R"(urdf: robots/tricycle.urdf
base_link: chassis
tray_link: ""
motion_sets:
  only: {max_linear_velocity: 0.9, max_angular_velocity: 1.1, max_linear_acceleration: 1.2, max_angular_acceleration: 1.3}
base_controller:
  drive: differential
  limits: {max_linear_velocity: 1.5, max_angular_velocity: 2.5, max_linear_acceleration: 3.5, max_angular_acceleration: 4.5}
  command_timeout: 0.3
  at_timeout: stop
)"));
  EXPECT_EQ(robot.profile.tray_link, "");
  EXPECT_EQ(robot.profile.laser_link, "");
  EXPECT_EQ(robot.profile.footprint, OutlineOf(robot.model, "chassis", {}));
  EXPECT_EQ(robot.profile.base_controller.loop_frequency, BaseControllerParams{}.loop_frequency);
}

TEST_F(RobotProfileFile, TheModelTellsWhatTheFileLeavesOut) {
  const Robot robot = LoadRobot(Write("urdf: robots/tricycle.urdf\n"));
  const Robot bare = LoadRobotFromUrdf(folder_.path() / "robots/tricycle.urdf");
  EXPECT_EQ(robot.hash(), bare.hash());
  EXPECT_EQ(robot.profile.base_link, bare.profile.base_link);
  EXPECT_EQ(robot.profile.tray_link, bare.profile.tray_link);
  EXPECT_EQ(LoadRobot(Write("urdf: robots/tricycle.urdf\ntray_link: \"\"\n")).profile.tray_link,
            "");
}

TEST_F(RobotProfileFile, ATrayThatIsNamedHasThePlaceThatABareUrdfHas) {
  const Robot bare = LoadRobotFromUrdf(folder_.path() / "robots/tricycle.urdf");
  const Robot named = LoadRobot(Write("urdf: robots/tricycle.urdf\ntray_link: Serving_Tray\n"));
  EXPECT_EQ(named.hash(), bare.hash());
  const Robot placed = LoadRobot(
      Write("urdf: robots/tricycle.urdf\ntray_link: Serving_Tray\nobject_on_tray: {xyz: [0.0, 0.1, "
            "0.02], rpy: [0.0, 0.0, 0.0]}\n"));
  EXPECT_EQ(placed.profile.X_TO.translation, Eigen::Vector3d(0.0, 0.1, 0.02));
}

/// Of any link, however it is turned: upright on the middle of the top of its largest shape.
TEST_F(RobotProfileFile, APlaceThatIsNotGivenIsOnTopOfTheNamedLink) {
  base::Rng rng(5);
  for (int round = 0; round < 60; ++round) {
    const Eigen::Vector3d size(rng.Uniform(0.2, 0.8), rng.Uniform(0.2, 0.8),
                               rng.Uniform(0.01, 0.1));
    const double height = rng.Uniform(0.4, 1.0), yaw = rng.Uniform(-3.0, 3.0);
    const bool is_upside_down = rng.Bernoulli(0.5);
    const std::string deck = fmt::format(
        "<joint name=\"j\" type=\"fixed\"><origin xyz=\"2 0 {}\" rpy=\"{} 0 {}\"/><parent "
        "link=\"chassis\"/><child link=\"deck\"/></joint><link name=\"deck\"><collision>"
        "<geometry><box size=\"{} {} {}\"/></geometry></collision></link></robot>",
        height, is_upside_down ? M_PI : 0.0, yaw, size.x(), size.y(), size.z());
    std::string urdf = kTricycle;
    urdf.replace(urdf.find("</robot>"), 8, deck);
    folder_.Write("robots/decked.urdf", urdf);
    const Robot robot = LoadRobot(Write("urdf: robots/decked.urdf\ntray_link: deck\n"));
    const auto X_R = ForwardKinematics(robot.model, robot.profile.joints);
    const geometry::Pose3 X_RO = X_R[*robot.model.FindLink("deck")] * robot.profile.X_TO;
    EXPECT_LT((X_RO.translation - Eigen::Vector3d(2.0, 0.0, height + size.z() / 2)).norm(), 1e-9);
    EXPECT_NEAR(geometry::TiltOf(X_RO.rotation), 0.0, 1e-9);
  }
}

TEST_F(RobotProfileFile, TheControllerLetsEveryMotionSetPassUnlessTheFileSaysLess) {
  const std::string sets = R"(urdf: robots/tricycle.urdf
motion_sets:
  quick: {max_linear_velocity: 0.9, max_angular_velocity: 0.5, max_linear_acceleration: 1.2, max_angular_acceleration: 1.3}
  nimble: {max_linear_velocity: 0.2, max_angular_velocity: 1.5, max_linear_acceleration: 0.2, max_angular_acceleration: 3.3}
default_motion_set: quick
)";
  const MotionSet limits = LoadRobot(Write(sets)).profile.base_controller.limits;
  EXPECT_EQ(limits.max_linear_velocity, 0.9);
  EXPECT_EQ(limits.max_angular_velocity, 1.5);
  EXPECT_EQ(limits.max_linear_acceleration, 1.2);
  EXPECT_EQ(limits.max_angular_acceleration, 3.3);
}

TEST_F(RobotProfileFile, AllMissingKeysAreToldAtOnce) {
  const std::string path = Write("base_link: chassis\nmotion_sets: {}\n");
  EXPECT_THAT([&] { LoadRobot(path); },
              ThrowsMessage<base::ConfigError>(HasSubstr("urdf, default_motion_set are missing")));
}

TEST_F(RobotProfileFile, HashTellsApartEveryField) {
  const std::uint64_t hash = LoadRobot(Write(kProfile)).hash();
  const std::vector<std::pair<std::string, std::string>> changes{
      {"base_link: chassis", "base_link: Serving_Tray"},
      {"tray_link: Serving_Tray", "tray_link: \"\""},
      {"[0.05, 0.0, 0.02]", "[0.05, 0.0, 0.03]"},
      {"[0.0, 0.0, 0.1]", "[0.0, 0.0, 0.2]"},
      {"laser_link: \"\"", "laser_link: tray_camera"},
      {"{x: 0.4, y: 0.3}", "{x: 0.5, y: 0.3}"},
      {"footprint_padding: 0.02", "footprint_padding: 0.03"},
      {"max_linear_velocity: 0.9", "max_linear_velocity: 0.8"},
      {"max_angular_acceleration: 4.5", "max_angular_acceleration: 4.6"},
      {"max_linear_jerk: 9.0", "max_linear_jerk: 9.1"},
      {"command_timeout: 0.3", "command_timeout: 0.4"},
      {"at_timeout: ramp", "at_timeout: stop"},
      {"drive: differential", "drive: omnidirectional"},
      {"command_lag: 0.04", "command_lag: 0.05"},
      {"loop_frequency: 20.0", "loop_frequency: 21.0"},
      {"loop_damping: 0.7", "loop_damping: 0.8"},
      {"sway_compliance: 0.002", "sway_compliance: 0.003"},
      {"sway_frequency: 11.0", "sway_frequency: 12.0"},
      {"sway_damping: 0.3", "sway_damping: 0.4"},
      {"post: 0.4", "post: 0.5"}};
  for (const auto& [from, to] : changes) {
    EXPECT_NE(LoadRobot(WriteWith(from, to)).hash(), hash) << to;
  }
}

/// The profile on four casters, in the place of the velocity loop.
std::string OnCasters(const std::string& from = "", const std::string& to = "") {
  std::string yaml = kProfile;
  yaml.replace(yaml.find("drive: differential"), 19, "drive: omnidirectional");
  yaml.erase(yaml.find("  max_linear_jerk"), std::string("  max_linear_jerk: 9.0\n").size());
  const std::size_t loop = yaml.find("  loop_frequency");
  yaml.replace(loop, yaml.find("  sway_compliance") - loop,
               "  casters: {version: 1, at: 0.3, track: 0.11, wheel_radius: 0.08, wheel_inertia: "
               "0.01, wheel_effort: 6.0, wheel_damping: 0.1, steering_inertia: 0.04, "
               "steering_effort: 5.0, steering_speed: 9.0, steering_damping: 0.5, mass: 150.0, "
               "yaw_inertia: 7.0, grip: 0.7}\n");
  if (!from.empty()) yaml.replace(yaml.find(from), from.size(), to);
  return yaml;
}

TEST_F(RobotProfileFile, CastersAreReadAndTellHashesApart) {
  const Robot robot = LoadRobot(Write(OnCasters()));
  ASSERT_TRUE(robot.profile.base_controller.casters);
  const CasterParams& casters = *robot.profile.base_controller.casters;
  EXPECT_EQ(casters.version, 1);
  EXPECT_EQ(casters.at, 0.3);
  EXPECT_EQ(casters.track, 0.11);
  EXPECT_EQ(casters.wheel_radius, 0.08);
  EXPECT_EQ(casters.wheel_inertia, 0.01);
  EXPECT_EQ(casters.wheel_effort, 6.0);
  EXPECT_EQ(casters.wheel_damping, 0.1);
  EXPECT_EQ(casters.steering_inertia, 0.04);
  EXPECT_EQ(casters.steering_effort, 5.0);
  EXPECT_EQ(casters.steering_speed, 9.0);
  EXPECT_EQ(casters.steering_damping, 0.5);
  EXPECT_EQ(casters.mass, 150.0);
  EXPECT_EQ(casters.yaw_inertia, 7.0);
  EXPECT_EQ(casters.grip, 0.7);
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"version: 1", "version: 2"},
           {"at: 0.3,", "at: 0.31,"},
           {"track: 0.11", "track: 0.12"},
           {"wheel_radius: 0.08", "wheel_radius: 0.09"},
           {"wheel_inertia: 0.01", "wheel_inertia: 0.02"},
           {"wheel_effort: 6.0", "wheel_effort: 6.1"},
           {"wheel_damping: 0.1", "wheel_damping: 0.2"},
           {"steering_inertia: 0.04", "steering_inertia: 0.05"},
           {"steering_effort: 5.0", "steering_effort: 5.1"},
           {"steering_speed: 9.0", "steering_speed: 9.1"},
           {"steering_damping: 0.5", "steering_damping: 0.6"},
           {"mass: 150.0", "mass: 151.0"},
           {"yaw_inertia: 7.0", "yaw_inertia: 7.1"},
           {"grip: 0.7", "grip: 0.8"}}) {
    EXPECT_NE(LoadRobot(Write(OnCasters(from, to))).hash(), robot.hash()) << to;
  }
}

TEST_F(RobotProfileFile, RefusesCastersThatCannotBe) {
  const auto why = [&](const std::string& from, const std::string& to) {
    try {
      LoadRobot(Write(OnCasters(from, to)));
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(why("version: 1", "version: 3"), HasSubstr("casters.version"));
  EXPECT_THAT(why("grip: 0.7", "grap: 0.7"), HasSubstr("grip"));
  EXPECT_THAT(why("wheel_radius: 0.08", "wheel_radius: 0"), HasSubstr("wheel_radius"));
  EXPECT_THAT(why("drive: omnidirectional", "drive: differential"),
              testing::AllOf(HasSubstr("base_controller.casters"), HasSubstr("differential")));
  EXPECT_THAT(why("  sway_compliance", "  loop_frequency: 20.0\n  sway_compliance"),
              testing::AllOf(HasSubstr("loop_frequency"), HasSubstr("leave it out")));
}

TEST_F(RobotProfileFile, RefusesMissingAndUnknownKeys) {
  ExpectRefused("urdf: robots/tricycle.urdf\n", "", {"urdf is missing; add it"});
  ExpectRefused("differential", "car", {"base_controller.drive", "'car'", "differential"});
  ExpectRefused("joints: {", "jonts: {}\njoints: {", {"'jonts' is unknown", "'joints'"});
  ExpectRefused("  loop_damping", "  loop_dampening: 1\n  loop_damping",
                {"loop_dampening' is unknown"});
}

TEST_F(RobotProfileFile, SaysAllLimitsAtOnceThatAreMissing) {
  ExpectRefused("max_angular_velocity: 1.1, max_linear_acceleration: 1.2, ", "",
                {"motion_sets.Brisk.max_angular_velocity, "
                 "motion_sets.Brisk.max_linear_acceleration are missing"});
  ExpectRefused("max_linear_velocity: 1.5, max_angular_velocity: 2.5, ", "",
                {"base_controller.limits.max_linear_velocity, "
                 "base_controller.limits.max_angular_velocity are missing"});
}

TEST_F(RobotProfileFile, APlaceOnTheTrayNeedsNoRotation) {
  const Robot upright = LoadRobot(WriteWith(", rpy: [0.0, 0.0, 0.1]", ""));
  EXPECT_EQ(upright.profile.X_TO.translation, Eigen::Vector3d(0.05, 0.0, 0.02));
  EXPECT_TRUE(upright.profile.X_TO.rotation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST_F(RobotProfileFile, ACarLikeDriveHasATurningRadius) {
  const auto car = [&](const std::string& radius) {
    return WriteWith("drive: differential", "drive: car_like" + radius);
  };
  const Robot robot = LoadRobot(car("\n  min_turning_radius: 0.8"));
  EXPECT_EQ(robot.profile.base_controller.drive, Drive::kCarLike);
  EXPECT_EQ(robot.profile.base_controller.min_turning_radius, 0.8);
  EXPECT_NE(LoadRobot(car("\n  min_turning_radius: 0.9")).hash(), robot.hash());
  EXPECT_EQ(LoadRobot(Write(kProfile)).profile.base_controller.min_turning_radius, 0.0);
}

TEST_F(RobotProfileFile, RefusesTurningRadiiThatMeanNothing) {
  ExpectRefused("drive: differential", "drive: car_like",
                {"base_controller.min_turning_radius is missing"});
  for (const char* radius : {"0", "-0.8", "wide", ".nan"}) {
    ExpectRefused("drive: differential",
                  std::string("drive: car_like\n  min_turning_radius: ") + radius,
                  {"base_controller.min_turning_radius", "wanted"});
  }
  ExpectRefused("drive: differential", "drive: differential\n  min_turning_radius: 0.8",
                {"base_controller.min_turning_radius", "differential", "car_like"});
  ExpectRefused("drive: differential", "min_turning_radius: 0.8",
                {"base_controller.min_turning_radius", "`drive: car_like`"});
}

TEST_F(RobotProfileFile, RefusesLinksThatAreNotThere) {
  ExpectRefused("base_link: chassis", "base_link: chasis",
                {"base_link is 'chasis'", "did you mean 'chassis'", "line 2"});
  ExpectRefused("tray_link: Serving_Tray", "tray_link: tray", {"tray_link is 'tray'", "unknown"});
  ExpectRefused("laser_link: \"\"", "laser_link: laser", {"laser_link is 'laser'"});
}

TEST_F(RobotProfileFile, RefusesATrayWithoutShape) {
  std::string urdf = kTricycle;
  const std::size_t begin = urdf.find("<collision><geometry><box size=\"0.05");
  urdf.erase(begin, urdf.find("</collision>", begin) + 12 - begin);
  folder_.Write("robots/tricycle.urdf", urdf);
  ExpectRefused("tray_link: Serving_Tray", "tray_link: tray_camera",
                {"tray_link is 'tray_camera'", "no collision shape"});
}

TEST_F(RobotProfileFile, RefusesBadFootprints) {
  ExpectRefused("{x: 0.4, y: 0.3}, {x: 0.4, y: -0.3}, ", "", {"footprint", "three corners"});
  ExpectRefused("{x: -0.2, y: 0.3}", "{x: 0.4, y: 0.0}", {"footprint", "convex"});
  ExpectRefused("{x: -0.2, y: 0.3}", "{x: -0.2}", {"footprint[3].y is missing"});
  ExpectRefused("{x: 0.4, y: 0.3}", "{x: far, y: 0.3}", {"footprint[0].x is 'far'"});
}

TEST_F(RobotProfileFile, AFootprintIsCornersOrPairsAsMoveBaseHasThem) {
  const std::string corners = "[{x: 0.4, y: 0.3}, {x: 0.4, y: -0.3}, {x: -0.2, y: -0.3}, ";
  const std::string from = corners + "{x: -0.2, y: 0.3}]";
  const std::string pairs = "[[0.4, 0.3], [0.4, -0.3], [-0.2, -0.3], [-0.2, 0.3]]";
  const Robot wanted = LoadRobot(Write(kProfile));
  for (const std::string& to : {pairs, "\"" + pairs + "\"",
                                std::string("\n- [0.4, 0.3]\n- [0.4, "
                                            "-0.3]\n- [-0.2, -0.3]\n- [-0.2, 0.3]")}) {
    const Robot robot = LoadRobot(WriteWith(from, to));
    EXPECT_EQ(robot.profile.footprint, wanted.profile.footprint) << to;
    EXPECT_EQ(robot.profile.hash, wanted.profile.hash) << to;
  }
  const Robot derived = LoadRobot(WriteWith(from, "[]"));
  EXPECT_EQ(LoadRobot(WriteWith(from, "'[]'")).profile.footprint, derived.profile.footprint);
  ExpectRefused(from, "[[0.4, 0.3], [0.4, -0.3]]", {"footprint", "three corners"});
  ExpectRefused(from, "[[0.4, 0.3], [0.4], [-0.2, 0.3]]", {"footprint", "item 2", "pair [x, y]"});
  ExpectRefused(from, "[[0.4, 0.3], [0.4, far], [-0.2, 0.3]]", {"item 2", "numbers between"});
  ExpectRefused(from, "[[0.4, 0.3], {x: 0.4, y: 0.1}, [-0.2, 0.3]]", {"item 2", "pair [x, y]"});
  ExpectRefused(from, "'a circle'", {"footprint is 'a circle'", "a list"});
}

TEST_F(RobotProfileFile, ARadiusIsToldToBeAFootprint) {
  ExpectRefused("footprint_padding", "robot_radius: 0.3\nfootprint_padding",
                {"robot_radius is '0.3'", "wanted `footprint`"});
}

TEST_F(RobotProfileFile, ARobotWithoutShapesNeedsAFootprintAndSaysWhatItIsWithoutThem) {
  folder_.Write("ghost.urdf", "<robot name=\"ghost\"><link name=\"a\"/></robot>");
  EXPECT_THAT([&] { LoadRobot(Write("urdf: ghost.urdf\nfootprint: []\n")); },
              ThrowsMessage<base::ConfigError>(HasSubstr("give 'footprint'")));
  const Robot ghost = LoadRobot(
      Write("urdf: ghost.urdf\nfootprint: [[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.2, -0.2]]\n"));
  EXPECT_THAT(ghost.assumed, ::testing::Contains(HasSubstr("no link has a <collision>")));
  EXPECT_THAT(LoadRobot(Write(kProfile)).assumed,
              ::testing::Not(::testing::Contains(HasSubstr("no link has a <collision>"))));
}

TEST_F(RobotProfileFile, RefusesBadMotionSets) {
  ExpectRefused("default_motion_set: brisk", "default_motion_set: brusque",
                {"default_motion_set is 'brusque'", "did you mean 'brisk'"});
  ExpectRefused("max_linear_velocity: 0.9", "max_linear_velocity: -0.9",
                {"motion_sets.Brisk.max_linear_velocity is '-0.9'", "between 0"});
  ExpectRefused("default_motion_set",
                "  brisk: {max_linear_velocity: 1, max_angular_velocity: 1, "
                "max_linear_acceleration: 1, max_angular_acceleration: 1}\ndefault_motion_set",
                {"motion_sets.brisk", "differ in more than case"});
}

TEST_F(RobotProfileFile, RefusesBadPosture) {
  ExpectRefused("post: 0.4", "post: 0.7", {"joints", "'post' is at 0.7", "0.2 and 0.6"});
  ExpectRefused("post: 0.4", "pst: 0.4", {"joints", "'pst' is unknown", "'post'"});
  ExpectRefused("post: 0.4", "post: high", {"joints.post is 'high'"});
}

TEST_F(RobotProfileFile, RefusesBadPose) {
  ExpectRefused("[0.05, 0.0, 0.02]", "[0.05, 0.0]", {"object_on_tray.xyz", "3 numbers"});
  ExpectRefused("[0.05, 0.0, 0.02]", "[0.05, .nan, 0.02]", {"object_on_tray.xyz", "finite"});
}

TEST_F(RobotProfileFile, RefusesMissingFiles) {
  ExpectRefused("tricycle.urdf", "bicycle.urdf", {"bicycle.urdf is not"});
  EXPECT_THAT([] { LoadRobot("no/such.yaml"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("no/such.yaml")));
}

TEST_F(RobotProfileFile, BareUrdfIsEnough) {
  const Robot robot = LoadRobotFromUrdf((folder_.path() / "robots/tricycle.urdf").string());
  EXPECT_EQ(robot.profile.base_link, "chassis");
  EXPECT_EQ(robot.profile.tray_link, "Serving_Tray");  // wider than tray_camera
  EXPECT_TRUE(robot.profile.X_TO.translation.isApprox(Eigen::Vector3d(0.0, 0.0, 0.02), 1e-12));
  EXPECT_EQ(robot.profile.default_motion_set, "fast");
  EXPECT_EQ(robot.profile.motion_sets.at("slow").max_linear_velocity, 0.30);
  EXPECT_TRUE(geometry::Contains(robot.profile.footprint, {0.399, 0.199}));
  EXPECT_TRUE(geometry::Contains(robot.profile.footprint, {-0.199, 0.199}));
  EXPECT_TRUE(geometry::Contains(robot.profile.footprint, {-0.1, -0.269}));
  EXPECT_FALSE(geometry::Contains(robot.profile.footprint, {0.0, 0.29}));
  EXPECT_NE(robot.hash(), 0u);
}

TEST_F(RobotProfileFile, BareUrdfWithoutTrayCarriesNothing) {
  std::string urdf = kTricycle;
  for (const char* name : {"Serving_Tray", "tray_camera"}) {
    for (std::size_t at = urdf.find(name); at != std::string::npos; at = urdf.find(name)) {
      urdf.replace(at, std::string(name).size(), name[0] == 'S' ? "shelf" : "camera");
    }
  }
  const Robot robot = LoadRobotFromUrdf(folder_.Write("shelf.urdf", urdf));
  EXPECT_EQ(robot.profile.tray_link, "");
}

TEST_F(RobotProfileFile, BareUrdfWithoutShapesIsRefused) {
  const std::string path =
      folder_.Write("ghost.urdf", "<robot name=\"ghost\"><link name=\"a\"/></robot>");
  EXPECT_THAT(
      [&] { LoadRobotFromUrdf(path); },
      ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("'ghost'"), HasSubstr("no footprint"))));
}

TEST_F(RobotProfileFile, BareUrdfTurnedTrayStillHasItsTopUp) {
  std::string urdf = kTricycle;
  const std::string origin = "<origin xyz=\"0.1 0 0.35\"/>";
  urdf.replace(urdf.find(origin), origin.size(),
               "<origin xyz=\"0.1 0 0.35\" rpy=\"3.14159265358979312 0 0\"/>");
  urdf.replace(urdf.find("<axis xyz=\"0 0 1\"/>"), 19, "<axis xyz=\"0 0 -1\"/>");
  const Robot robot = LoadRobotFromUrdf(folder_.Write("turned.urdf", urdf));
  const auto X_R = ForwardKinematics(robot.model, {});
  const geometry::Pose3 X_RO = X_R[*robot.model.FindLink("Serving_Tray")] * robot.profile.X_TO;
  // The plate lies 0 .. 0.02 along the turned frame's z: its top is now the frame's origin. The
  // post, of 0.02 m, stands on its middle now.
  EXPECT_NEAR(X_RO.translation.z(), 0.55, 1e-9);
  EXPECT_GT((X_RO.translation.head<2>() - Eigen::Vector2d(0.1, 0.0)).norm(), 0.07);
  EXPECT_NEAR(geometry::TiltOf(X_RO.rotation), 0.0, 1e-9);
}

TEST(ConfiguredRobots, AllLoad) {
  int num_robots = 0;
  const std::filesystem::path folder = std::filesystem::path(HIRES_SOURCE_DIR) / "config/robots";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string stem = entry.path().stem().string();
    if (stem.find("_names") != std::string::npos) continue;  // topics and frames: no robot
    EXPECT_NO_THROW(LoadRobot(entry.path().string())) << entry.path();
    ++num_robots;
  }
  EXPECT_GE(num_robots, 2);
}

TEST(ConfiguredRobots, CartCarriesItsTrayHigh) {
  const Robot cart = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/cart.yaml");
  const auto X_R = ForwardKinematics(cart.model, cart.profile.joints);
  const geometry::Pose3 X_RO = X_R[*cart.model.FindLink("tray_link")] * cart.profile.X_TO;
  EXPECT_TRUE(X_RO.translation.isApprox(Eigen::Vector3d(-0.05, 0.0, 0.78), 1e-12));
  geometry::Aabb box;
  for (const auto& collision : FrozenCollisions(cart.model, {})) {
    box.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  EXPECT_NEAR(box.lower.z(), 0.0, 1e-3);  // wheels and ball touch the floor
  EXPECT_NEAR(box.upper.z(), 0.78, 1e-12);
}

TEST(ConfiguredRobots, CartFromItsBareUrdfIsTheSameCart) {
  const Robot cart = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/cart.yaml");
  const Robot bare = LoadRobotFromUrdf(std::string(HIRES_SOURCE_DIR) + "/urdf/cart.urdf");
  EXPECT_EQ(bare.model.hash, cart.model.hash);
  EXPECT_EQ(bare.profile.tray_link, cart.profile.tray_link);
  EXPECT_LT((bare.profile.X_TO.translation - cart.profile.X_TO.translation).norm(), 1e-12);
  EXPECT_EQ(bare.profile.footprint, cart.profile.footprint);
  EXPECT_EQ(bare.profile.base_controller.drive, cart.profile.base_controller.drive);
}

/// [m] of the outline along x and y.
Eigen::Vector4d ExtentOf(const geometry::Polygon& outline) {
  Eigen::Vector4d extent(1e9, -1e9, 1e9, -1e9);
  for (const Eigen::Vector2d& p : outline) {
    extent[0] = std::min(extent[0], p.x());
    extent[1] = std::max(extent[1], p.x());
    extent[2] = std::min(extent[2], p.y());
    extent[3] = std::max(extent[3], p.y());
  }
  return extent;
}

TEST(ConfiguredRobots, TheBaseOfAPr2IsItsSquareBoxWithoutArms) {
  const Robot pr2 = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  const Eigen::Vector4d base = ExtentOf(BaseOutlineOf(pr2));
  EXPECT_LT((base - Eigen::Vector4d(-0.334, 0.334, -0.334, 0.334)).norm(), 1e-9)
      << base.transpose();
}

TEST(ConfiguredRobots, TheBaseOfARobotWithoutAnUpperBodyIsItsOutline) {
  const Robot cart = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/cart.yaml");
  EXPECT_EQ(BaseOutlineOf(cart), cart.profile.footprint);
}

}  // namespace
}  // namespace hires::robot::robot_profile_test
