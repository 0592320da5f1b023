#include "hires/robot/upper_body.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/robot/robot_profile.h"
#include "support/temporary_folder.h"

namespace hires::robot::upper_body_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A crane: a mast that lifts, a camera that pans and tilts, an arm of two joints with a gripper.
constexpr char kCrane[] = R"(<?xml version="1.0"?>
<robot name="crane">
  <link name="base"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.4 0.2"/></geometry>
    </collision></link>
  <joint name="mast" type="prismatic"><origin xyz="0 0 0.2"/><parent link="base"/>
    <child link="mast_link"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" velocity="0.1" effort="1"/></joint>
  <link name="mast_link"/>
  <joint name="pan" type="revolute"><origin xyz="0 0 0.5"/><parent link="mast_link"/>
    <child link="pan_link"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <link name="pan_link"/>
  <joint name="tilt" type="revolute"><parent link="pan_link"/><child link="eye"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <link name="eye"/>
  <joint name="shoulder" type="revolute"><parent link="mast_link"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <link name="upper"/>
  <joint name="elbow" type="continuous"><origin xyz="0.3 0 0"/><parent link="upper"/>
    <child link="palm"/><axis xyz="0 0 1"/><limit velocity="1" effort="1"/></joint>
  <link name="palm"/>
  <joint name="tool_joint" type="fixed"><origin xyz="0.1 0 0"/><parent link="palm"/>
    <child link="tool"/></joint>
  <link name="tool"/>
  <joint name="finger" type="revolute"><parent link="palm"/><child link="finger_l"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.6" velocity="1" effort="1"/></joint>
  <link name="finger_l"><collision><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <joint name="finger_2" type="revolute"><parent link="palm"/><child link="finger_r"/>
    <axis xyz="0 0 -1"/><limit lower="0" upper="0.6" velocity="1" effort="1"/>
    <mimic joint="finger"/></joint>
  <link name="finger_r"><collision><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <joint name="gap" type="prismatic"><parent link="finger_r"/><child link="gap_frame"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.08" velocity="1" effort="1"/></joint>
  <link name="gap_frame"/>
  <joint name="slack" type="revolute"><parent link="base"/><child link="loose_end"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" velocity="0" effort="1"/></joint>
  <link name="loose_end"/>
</robot>)";

constexpr char kProfile[] = R"(urdf: crane.urdf
base_link: base
tray_link: ""
object_on_tray: {xyz: [0.0, 0.0, 0.0], rpy: [0.0, 0.0, 0.0]}
laser_link: ""
footprint: []
footprint_padding: 0.02
motion_sets:
  slow: {max_linear_velocity: 0.9, max_angular_velocity: 1.1, max_linear_acceleration: 1.2, max_angular_acceleration: 1.3}
default_motion_set: slow
base_controller:
  drive: omnidirectional
  limits: {max_linear_velocity: 1.5, max_angular_velocity: 2.5, max_linear_acceleration: 3.5, max_angular_acceleration: 4.5}
  max_linear_jerk: 0.0
  command_timeout: 0.3
  at_timeout: ramp
  command_lag: 0.0
  loop_frequency: 0.0
  loop_damping: 0.7
  sway_compliance: 0.0
  sway_frequency: 11.0
  sway_damping: 0.3
joints: {}
upper_body:
  arms:
    Arm1:
      joints: [shoulder, elbow]
      tool_link: tool
      palm_link: palm
      gripper_joint: gap
      finger_joint: finger
      left_finger_links: [finger_l]
      right_finger_links: [finger_r]
      postures:
        Folded: {first: [1.5, 3.0], second: [-1.5, -3.0]}
        Stretched: {only: [0.0, 0.0]}
      holding_postures:
        Folded: [1.0, 2.0]
      way_points:
        Half: [0.7, 1.0]
  gripper: {max_gap: 0.08, max_finger_angle: 0.5, finger_slant: 0.1, max_speed: 0.04, force: 30.0}
  torso:
    joint: mast
    postures: {Up: 0.4, Down: 0.05}
  head: {pan_joint: pan, tilt_joint: tilt}
  camera: {link: eye, width: 1.0, height: 0.8, min_range: 0.3, max_range: 2.5}
  accelerations: {shoulder: 3.5}
  default_acceleration: 1.5
)";

class UpperBodyFile : public ::testing::Test {
 protected:
  UpperBodyFile() { folder_.Write("crane.urdf", kCrane); }

  Robot LoadWith(const std::string& from, const std::string& to) const {
    std::string yaml = kProfile;
    const std::size_t at = yaml.find(from);
    if (at == std::string::npos) throw std::logic_error("not in the profile: " + from);
    return LoadRobot(folder_.Write("robot.yaml", yaml.replace(at, from.size(), to)));
  }

  void ExpectRefused(const std::string& from, const std::string& to,
                     const std::vector<std::string>& says) const {
    try {
      LoadWith(from, to);
      ADD_FAILURE() << to << " was accepted";
    } catch (const base::ConfigError& error) {
      for (const std::string& words : says) EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_THAT(error.what(), HasSubstr("robot.yaml"));
    }
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(UpperBodyFile, EveryFieldIsRead) {
  const Robot robot = LoadWith("urdf", "urdf");
  ASSERT_TRUE(robot.profile.upper_body);
  const UpperBodyProfile& body = *robot.profile.upper_body;
  ASSERT_EQ(body.arms.count("arm1"), 1u);
  const ArmProfile& arm = body.arms.at("arm1");
  EXPECT_THAT(arm.joints, ElementsAre("shoulder", "elbow"));
  EXPECT_EQ(arm.tool_link, "tool");
  EXPECT_EQ(arm.palm_link, "palm");
  EXPECT_EQ(arm.gripper_joint, "gap");
  EXPECT_EQ(arm.finger_joint, "finger");
  EXPECT_THAT(arm.left_finger_links, ElementsAre("finger_l"));
  EXPECT_THAT(arm.right_finger_links, ElementsAre("finger_r"));
  EXPECT_THAT(arm.postures.at("folded"),
              ElementsAre(ElementsAre(1.5, 3.0), ElementsAre(-1.5, -3.0)));
  EXPECT_THAT(arm.postures.at("stretched"), ElementsAre(ElementsAre(0.0, 0.0)));
  EXPECT_THAT(arm.holding_postures.at("folded"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(arm.way_points.at("half"), ElementsAre(0.7, 1.0));
  EXPECT_EQ(body.gripper.max_gap, 0.08);
  EXPECT_EQ(body.gripper.max_finger_angle, 0.5);
  EXPECT_EQ(body.gripper.finger_slant, 0.1);
  EXPECT_EQ(body.gripper.max_speed, 0.04);
  EXPECT_EQ(body.gripper.force, 30.0);
  EXPECT_EQ(body.torso_joint, "mast");
  EXPECT_EQ(body.torso_postures.at("up"), 0.4);
  EXPECT_EQ(body.torso_postures.at("down"), 0.05);
  EXPECT_EQ(body.head_pan_joint, "pan");
  EXPECT_EQ(body.head_tilt_joint, "tilt");
  EXPECT_EQ(body.camera_link, "eye");
  EXPECT_EQ(body.camera_width, 1.0);
  EXPECT_EQ(body.camera_height, 0.8);
  EXPECT_EQ(body.camera_min_range, 0.3);
  EXPECT_EQ(body.camera_max_range, 2.5);
  EXPECT_EQ(AccelerationOf(body, "shoulder"), 3.5);
  EXPECT_EQ(AccelerationOf(body, "elbow"), 1.5);
}

TEST_F(UpperBodyFile, GroupsNameTheirJoints) {
  const Robot robot = LoadWith("urdf", "urdf");
  const UpperBodyProfile& body = *robot.profile.upper_body;
  EXPECT_THAT(JointsOfGroup(body, "torso"), ElementsAre("mast"));
  EXPECT_THAT(JointsOfGroup(body, "head"), ElementsAre("pan", "tilt"));
  EXPECT_THAT(JointsOfGroup(body, "arm1"), ElementsAre("shoulder", "elbow"));
  EXPECT_THAT(JointsOfGroup(body, "arm2"), IsEmpty());
}

TEST_F(UpperBodyFile, ARobotMayHaveNone) {
  std::string yaml = kProfile;
  yaml.erase(yaml.find("upper_body:"));
  EXPECT_FALSE(LoadRobot(folder_.Write("robot.yaml", yaml)).profile.upper_body);
}

TEST_F(UpperBodyFile, HashTellsApartEveryField) {
  const std::uint64_t hash = LoadWith("urdf", "urdf").hash();
  const std::vector<std::pair<std::string, std::string>> changes{
      {"Arm1:", "Arm2:"},
      {"tool_link: tool", "tool_link: palm"},
      {"left_finger_links: [finger_l]", "left_finger_links: [finger_r]"},
      {"right_finger_links: [finger_r]", "right_finger_links: [finger_l]"},
      {"first: [1.5, 3.0]", "first: [1.5, 3.1]"},
      {", second: [-1.5, -3.0]", ""},
      {"Stretched", "Straight"},
      {"[1.0, 2.0]", "[1.0, 2.1]"},
      {"[0.7, 1.0]", "[0.7, 1.1]"},
      {"max_gap: 0.08", "max_gap: 0.07"},
      {"max_finger_angle: 0.5", "max_finger_angle: 0.51"},
      {"finger_slant: 0.1", "finger_slant: 0.11"},
      {"max_speed: 0.04", "max_speed: 0.05"},
      {"force: 30", "force: 31"},
      {"Up: 0.4", "Up: 0.41"},
      {"pan_joint: pan", "pan_joint: tilt"},
      {"link: eye", "link: pan_link"},
      {"width: 1.0", "width: 1.1"},
      {"height: 0.8", "height: 0.9"},
      {"min_range: 0.3", "min_range: 0.4"},
      {"max_range: 2.5", "max_range: 2.6"},
      {"shoulder: 3.5", "shoulder: 3.6"},
      {"default_acceleration: 1.5", "default_acceleration: 1.6"}};
  for (const auto& [from, to] : changes) {
    EXPECT_NE(LoadWith(from, to).hash(), hash) << to;
  }
}

TEST_F(UpperBodyFile, RefusesMissingAndUnknownKeys) {
  ExpectRefused("      palm_link: palm\n", "", {"upper_body.arms.Arm1.palm_link is missing"});
  ExpectRefused("force: 30.0", "force: 30.0, fource: 3",
                {"gripper.fource' is unknown", "gripper.force"});
  ExpectRefused("  head: {", "  hed: {}\n  head: {", {"upper_body.hed' is unknown"});
}

TEST_F(UpperBodyFile, RefusesNamesThatTheUrdfLacks) {
  ExpectRefused("tool_link: tool", "tool_link: tol", {"tool_link", "'tol' is unknown", "'tool'"});
  ExpectRefused("[shoulder, elbow]", "[shoulder, elbo]", {"joint 'elbo' is unknown", "'elbow'"});
  ExpectRefused("joint: mast", "joint: must", {"upper_body.torso.joint", "'must' is unknown"});
  ExpectRefused("link: eye", "link: eyes", {"upper_body.camera.link", "'eyes' is unknown"});
  ExpectRefused("shoulder: 3.5", "sholder: 3.5", {"accelerations", "'sholder' is unknown"});
}

TEST_F(UpperBodyFile, RefusesWhatIsNoArm) {
  ExpectRefused("[shoulder, elbow]", "[elbow, shoulder]", {"joints", "not carried by"});
  ExpectRefused("palm_link: palm", "palm_link: upper", {"palm_link", "'upper' is not carried by"});
  ExpectRefused("[finger_l]", "[base]", {"left_finger_links", "'base' is not carried by 'palm'"});
  ExpectRefused("[finger_l]", "[tool]", {"left_finger_links", "no collision shape"});
  ExpectRefused("[finger_r]", "[]", {"right_finger_links", "at least one"});
  ExpectRefused("gripper_joint: gap", "gripper_joint: finger", {"gripper_joint", "prismatic"});
  ExpectRefused("finger_joint: finger", "finger_joint: finger_2", {"follows finger"});
  ExpectRefused("pan_joint: pan", "pan_joint: tool_joint", {"'tool_joint' is fixed"});
  ExpectRefused("pan_joint: pan", "pan_joint: slack", {"'slack'", "velocity"});
  ExpectRefused("Arm1:", "Torso:", {"groups of joints of their own"});
}

const char kSwinging[] = "{max_gap: 0.08, max_finger_angle: 0.5, finger_slant: 0.1, max_speed";
const char kShape[] =
    "shape: {tip_reach: 0.03, palm_distance: 0.05, pad_half_height: 0.01, half_height: 0.02, "
    "max_gap_used: 0.07, open_width: 0.08, narrowing: 0.5}, max_speed";

TEST_F(UpperBodyFile, FingersMayHaveAShapeOfTheirOwn) {
  const Robot robot =
      LoadWith(kSwinging,
               std::string("{max_gap: 0.08, max_finger_angle: 0.5, finger_slant: 0.1, ") + kShape);
  const FingerShape& shape = robot.profile.upper_body->gripper.shape;
  EXPECT_EQ(shape.tip_reach, 0.03);
  EXPECT_EQ(shape.palm_distance, 0.05);
  EXPECT_EQ(shape.pad_half_height, 0.01);
  EXPECT_EQ(shape.half_height, 0.02);
  EXPECT_EQ(shape.max_gap_used, 0.07);
  EXPECT_EQ(shape.open_width, 0.08);
  EXPECT_EQ(shape.narrowing, 0.5);
  EXPECT_NE(robot.hash(), LoadWith("urdf", "urdf").hash());
}

TEST_F(UpperBodyFile, RefusesFingersThatDoNotFitTheirJoint) {
  ExpectRefused(kSwinging, std::string("{fingers: sliding, max_gap: 0.08, ") + kShape,
                {"finger_joint", "wanted a prismatic joint for sliding fingers"});
  ExpectRefused(kSwinging, "{fingers: sliding, max_gap: 0.08, max_speed",
                {"upper_body.gripper.shape is missing"});
  ExpectRefused(kSwinging, "{fingers: three, max_gap: 0.08, max_speed", {"three", "sliding"});
}

TEST_F(UpperBodyFile, RefusesPosturesThatCannotBe) {
  ExpectRefused("first: [1.5, 3.0]", "first: [1.5]", {"Folded.first", "2 numbers"});
  ExpectRefused("first: [1.5, 3.0]", "first: [2.5, 3.0]",
                {"'shoulder' would be at 2.5", "-2 to 2"});
  ExpectRefused("[1.0, 2.0]", "[-2.1, 2.0]", {"holding_postures.Folded", "-2.1"});
  ExpectRefused("Stretched: {only: [0.0, 0.0]}", "Stretched: {}", {"Stretched", "one variant"});
  ExpectRefused("Stretched", "folded", {"differ from 'Folded' in more than case"});
  ExpectRefused("Up: 0.4", "Up: 0.6", {"upper_body.torso.postures.Up", "0 to 0.5"});
}

TEST_F(UpperBodyFile, RefusesNumbersThatCannotBe) {
  ExpectRefused("max_gap: 0.08", "max_gap: 0.09", {"gripper_joint", "0.09", "0 to 0.08"});
  ExpectRefused("max_finger_angle: 0.5", "max_finger_angle: 0.7", {"finger_joint", "0 to 0.6"});
  ExpectRefused("finger_slant: 0.1", "finger_slant: 1.2", {"finger_slant", "1.57"});
  ExpectRefused("force: 30.0", "force: 0.0", {"force is '0.0'", "above 0"});
  ExpectRefused("max_range: 2.5", "max_range: 0.2", {"max_range", "more than min_range"});
  ExpectRefused("shoulder: 3.5", "shoulder: 0.0", {"accelerations.shoulder"});
}

}  // namespace
}  // namespace hires::robot::upper_body_test
