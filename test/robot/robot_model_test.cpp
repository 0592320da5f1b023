#include "hires/robot/robot_model.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/log_catcher.h"

namespace hires::robot::robot_model_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Root, then a lift along z with limits 0.1 .. 0.5, an arm that turns about y (axis given twice as
/// long), a finger that follows the arm, and a wheel that may turn forever.
constexpr char kRobot[] = R"(<?xml version="1.0"?>
<robot name="small">
  <link name="base"/>
  <joint name="lift" type="prismatic">
    <origin xyz="1 0 0"/><parent link="base"/><child link="mast"/><axis xyz="0 0 1"/>
    <limit lower="0.1" upper="0.5" velocity="0.2" effort="30"/>
  </joint>
  <link name="mast">
    <inertial><origin xyz="0 0 0.5" rpy="0 0 1.57079632679489662"/><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial>
    <collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.2 1"/></geometry></collision>
  </link>
  <joint name="arm" type="revolute">
    <origin xyz="0 0 1" rpy="0 0 1.57079632679489662"/><parent link="mast"/><child link="arm"/>
    <axis xyz="0 2 0"/><limit lower="-1" upper="1.2" velocity="1" effort="5"/>
  </joint>
  <link name="arm">
    <collision name="tube"><origin xyz="0.2 0 0"/>
      <geometry><cylinder radius="0.05" length="0.4"/></geometry></collision>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="finger" type="revolute">
    <origin xyz="0.4 0 0"/><parent link="arm"/><child link="finger"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" velocity="1" effort="5"/>
    <mimic joint="arm" multiplier="-0.5" offset="0.25"/>
  </joint>
  <link name="finger"/>
  <joint name="wheel" type="continuous">
    <parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/>
  </joint>
  <link name="wheel"/>
  <gazebo reference="arm"><mu1>0.6</mu1><mu2>0.4</mu2></gazebo>
</robot>)";

RobotModel Small() { return ParseRobotModel(kRobot, "small.urdf"); }

geometry::Pose3 PoseOf(const RobotModel& model, const std::string& link,
                       const JointPositions& positions) {
  return ForwardKinematics(model, positions)[*model.FindLink(link)];
}

void ExpectAt(const geometry::Pose3& pose, double x, double y, double z) {
  EXPECT_NEAR(pose.translation.x(), x, 1e-12);
  EXPECT_NEAR(pose.translation.y(), y, 1e-12);
  EXPECT_NEAR(pose.translation.z(), z, 1e-12);
}

TEST(RobotModel, SortsParentsBeforeChildren) {
  const RobotModel model = Small();
  EXPECT_THAT(model.LinkNames(), ElementsAre("base", "mast", "wheel", "arm", "finger"));
  EXPECT_FALSE(model.links[0].joint);
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    EXPECT_LT(model.links[i].joint->parent, static_cast<int>(i));
  }
}

TEST(RobotModel, NamesTheJointsThatLead) {
  EXPECT_THAT(Small().JointNames(), ElementsAre("lift", "wheel", "arm"));
}

TEST(RobotModel, FindsLinks) {
  EXPECT_EQ(Small().FindLink("arm"), 3);
  EXPECT_EQ(Small().FindLink("leg"), std::nullopt);
}

TEST(RobotModel, KeepsLimitsAndUnitAxis) {
  const RobotModel model = Small();
  const Joint& arm = *model.links[3].joint;
  EXPECT_EQ(arm.axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(arm.limits->lower, -1.0);
  EXPECT_EQ(arm.limits->upper, 1.2);
  EXPECT_EQ(arm.limits->velocity, 1.0);
  EXPECT_EQ(arm.limits->effort, 5.0);
  EXPECT_FALSE(model.links[2].joint->limits);
}

TEST(RobotModel, TurnsInertiaIntoTheLinksAxes) {
  const geometry::MassProperties mass = *Small().links[1].inertial;
  EXPECT_EQ(mass.mass, 2.0);
  EXPECT_EQ(mass.p_BBcm, Eigen::Vector3d(0.0, 0.0, 0.5));
  const Eigen::Matrix3d wanted = Eigen::Vector3d(2.0, 1.0, 2.5).asDiagonal();
  EXPECT_TRUE(mass.I_BBcm.isApprox(wanted, 1e-12)) << mass.I_BBcm;
}

TEST(RobotModel, TakesTheSmallerFrictionOfGazebo) {
  const RobotModel model = Small();
  EXPECT_EQ(model.links[3].collisions[0].friction, 0.4);
  EXPECT_EQ(model.links[1].collisions[0].friction, 1.0);
}

TEST(RobotModel, TakesTheFrictionOfContacts) {
  std::string text = kRobot;
  const std::string link = "<link name=\"arm\">";
  text.replace(text.find(link), link.size(),
               link + "<contact><lateral_friction value=\"0.1\"/></contact>");
  EXPECT_EQ(ParseRobotModel(text, "small.urdf").links[3].collisions[0].friction, 0.1);
}

TEST(ForwardKinematics, RestsAtTheLimitNearestToZero) {
  const RobotModel model = Small();
  ExpectAt(PoseOf(model, "mast", {}), 1.0, 0.0, 0.1);
}

TEST(ForwardKinematics, AddsUpAlongTheChain) {
  const RobotModel model = Small();
  ExpectAt(PoseOf(model, "arm", {{"lift", 0.3}}), 1.0, 0.0, 1.3);
  // The arm's x axis points along the root's y; turned up by -0.5 rad about the arm's own y.
  ExpectAt(PoseOf(model, "finger", {{"lift", 0.3}, {"arm", -0.5}}), 1.0, 0.4 * std::cos(0.5),
           1.3 + 0.4 * std::sin(0.5));
}

TEST(ForwardKinematics, MimicFollowsWithFactorAndOffset) {
  const RobotModel model = Small();
  const auto X_R = ForwardKinematics(model, {{"arm", 0.8}});
  const Eigen::Quaterniond R_arm_finger = X_R[3].rotation.conjugate() * X_R[4].rotation;
  const Eigen::AngleAxisd turn(R_arm_finger);
  EXPECT_NEAR(turn.angle() * turn.axis().y(), -0.5 * 0.8 + 0.25, 1e-12);
}

TEST(ForwardKinematics, ContinuousJointHasNoLimit) {
  const RobotModel model = Small();
  const geometry::Pose3 X_RW = PoseOf(model, "wheel", {{"wheel", 10.0 * geometry::kPi + 0.1}});
  EXPECT_NEAR(X_RW.rotation.angularDistance(geometry::RotationFromRpy(0.0, 0.1, 0.0)), 0.0, 1e-9);
}

TEST(ForwardKinematics, RefusesPositionsOutsideTheLimits) {
  const RobotModel model = Small();
  EXPECT_THAT(
      [&] {
        ForwardKinematics(model, {{"lift", 0.6}});
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("'lift' is at 0.6"), HasSubstr("between 0.1 and 0.5"))));
  EXPECT_NO_THROW(ForwardKinematics(model, {{"lift", 0.5 + 9e-7}}));
  EXPECT_THROW(ForwardKinematics(model, {{"lift", 0.5 + 2e-6}}), base::ConfigError);
  EXPECT_THROW(ForwardKinematics(model, {{"wheel", NAN}}), base::ConfigError);
}

TEST(ForwardKinematics, AFollowerStopsAtItsLimits) {
  std::string xml = kRobot;
  xml.replace(xml.find("multiplier=\"-0.5\""), 17, "multiplier=\"-1.5\"");
  const RobotModel model = ParseRobotModel(xml, "small.urdf");
  const geometry::Pose3 X_AFAtZero =
      PoseOf(Small(), "arm", {}).Inverse() * PoseOf(Small(), "finger", {{"arm", 0.0}});
  base::Rng rng(5);
  for (int round = 0; round < 100; ++round) {
    const double arm = rng.Uniform(-1.0, 1.2);
    const double turned = std::clamp(-1.5 * arm + 0.25, -1.0, 1.0) - 0.25;
    const auto X_R = ForwardKinematics(model, {{"arm", arm}});
    const geometry::Pose3 X_AF =
        X_R[*model.FindLink("arm")].Inverse() * X_R[*model.FindLink("finger")];
    const geometry::Pose3 wanted =
        X_AFAtZero *
        geometry::Pose3{Eigen::Vector3d::Zero(),
                        Eigen::Quaterniond(Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitY()))};
    EXPECT_LT(X_AF.rotation.angularDistance(wanted.rotation), 1e-9) << arm;
    EXPECT_LT((X_AF.translation - wanted.translation).norm(), 1e-9) << arm;
  }
}

TEST(ParseRobotModel, AnInfiniteFrictionIsALargeOneAndIsTold) {
  const auto friction_of = [](const std::string& mu) {
    return ParseRobotModel(
               "<robot name='r'>\n<link name='a'><collision><geometry><sphere radius='1'/>"
               "</geometry></collision></link>\n<gazebo reference='a'>" +
                   mu + "</gazebo></robot>",
               "r.urdf")
        .links[0]
        .collisions[0]
        .friction;
  };
  for (const char* mu : {"<mu1>inf</mu1>", "<mu1>Infinity</mu1><mu2>+inf</mu2>",
                         "<mu2 value='inf'/>", "<mu1>-1</mu1>"}) {
    const hires::test_support::LogCatcher log(base::LogLevel::kWarn);
    EXPECT_EQ(friction_of(mu), 1000.0) << mu;
    EXPECT_THAT(log.lines, ::testing::ElementsAre(HasSubstr("endless_friction=a "))) << mu;
  }
  EXPECT_EQ(friction_of("<mu1>inf</mu1><mu2>0.5</mu2>"), 0.5);
  EXPECT_THROW(friction_of("<mu1>nan</mu1>"), base::ConfigError);
}

TEST(ForwardKinematics, RefusesJointsThatCannotBeSet) {
  const RobotModel model = Small();
  EXPECT_THAT(
      [&] {
        ForwardKinematics(model, {{"lifft", 0.2}});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("did you mean 'lift'")));
  EXPECT_THAT(
      [&] {
        ForwardKinematics(model, {{"finger", 0.2}});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("follows 'arm'; set that one")));
}

/// Is `link` or one above it carried by a joint named `joint` or by one that follows it?
bool MovesWith(const RobotModel& model, int link, const std::string& joint) {
  for (int at = link; model.links[at].joint; at = model.links[at].joint->parent) {
    const Joint& carrier = *model.links[at].joint;
    if (carrier.name == joint || carrier.mimics == joint) return true;
  }
  return false;
}

double RandomPosition(const Joint& joint, base::Rng* rng) {
  if (joint.type == JointType::kContinuous || !joint.limits) return rng->Uniform(-3.0, 3.0);
  return rng->Uniform(joint.limits->lower, joint.limits->upper);
}

JointPositions RandomPositions(const RobotModel& model, base::Rng* rng) {
  JointPositions positions;
  for (const Link& link : model.links) {
    if (!link.joint || link.joint->type == JointType::kFixed || !link.joint->mimics.empty()) {
      continue;
    }
    positions[link.joint->name] = RandomPosition(*link.joint, rng);
  }
  return positions;
}

class MovingOneJoint : public ::testing::TestWithParam<const char*> {};

TEST_P(MovingOneJoint, MovesItsDescendantsAndNothingElse) {
  const RobotModel model = LoadRobotModel(std::string(HIRES_SOURCE_DIR) + GetParam());
  base::Rng rng(7);
  for (const Link& child : model.links) {
    if (!child.joint || child.joint->type == JointType::kFixed) continue;
    if (!child.joint->mimics.empty()) continue;
    const std::string& joint = child.joint->name;
    JointPositions positions = RandomPositions(model, &rng);
    const auto before = ForwardKinematics(model, positions);
    positions[joint] = RandomPosition(*child.joint, &rng);
    const auto after = ForwardKinematics(model, positions);
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const bool same = before[i].translation == after[i].translation &&
                        before[i].rotation.coeffs() == after[i].rotation.coeffs();
      EXPECT_EQ(same, !MovesWith(model, static_cast<int>(i), joint))
          << joint << " and " << model.links[i].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, MovingOneJoint,
                         ::testing::Values("/urdf/pr2_tray.urdf", "/urdf/cart.urdf",
                                           "/urdf/car.urdf"));

TEST(FrozenCollisions, NamesAndPlacesEveryShape) {
  const RobotModel model = Small();
  const auto frozen = FrozenCollisions(model, {{"lift", 0.2}});
  ASSERT_EQ(frozen.size(), 3u);
  EXPECT_EQ(frozen[0].name, "mast");
  EXPECT_EQ(frozen[1].name, "arm/tube");
  EXPECT_EQ(frozen[2].name, "arm/2");
  ExpectAt(frozen[0].X_BS, 1.0, 0.0, 0.7);
  ExpectAt(frozen[1].X_BS, 1.0, 0.2, 1.2);
  EXPECT_EQ(frozen[1].friction, 0.4);
}

TEST(RobotHash, IgnoresLayout) {
  std::string moved = kRobot;
  const std::string wheel = R"(  <link name="wheel"/>)";
  moved.erase(moved.find(wheel), wheel.size());
  moved.insert(moved.find("  <link name=\"base\"/>"), "<!-- a comment -->\n\n" + wheel + "\n");
  const std::size_t limit = moved.find("lower=\"0.1\"");
  moved.replace(limit, 11, "lower=\"0.100\"");
  EXPECT_EQ(ParseRobotModel(moved, "elsewhere.urdf").hash, Small().hash);
}

TEST(RobotHash, TellsApartEveryValue) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {"name=\"small\"", "name=\"smaller\""},
      {"xyz=\"1 0 0\"", "xyz=\"1 0 1e-9\""},
      {"upper=\"0.5\"", "upper=\"0.6\""},
      {"velocity=\"0.2\"", "velocity=\"0.3\""},
      {"effort=\"30\"", "effort=\"31\""},
      {"mass value=\"2\"", "mass value=\"2.1\""},
      {"ixy=\"0\"", "ixy=\"0.1\""},
      {"size=\"0.1 0.2 1\"", "size=\"0.1 0.2 1.1\""},
      {"radius=\"0.05\"", "radius=\"0.06\""},
      {"sphere radius=\"0.1\"", "sphere radius=\"0.2\""},
      {"axis xyz=\"0 2 0\"", "axis xyz=\"0 -2 0\""},
      {"multiplier=\"-0.5\"", "multiplier=\"-0.4\""},
      {"offset=\"0.25\"", "offset=\"0.2\""},
      {"<mu2>0.4", "<mu2>0.3"},
      {"collision name=\"tube\"", "collision name=\"pipe\""},
      {"type=\"continuous\"", "type=\"fixed\""}};
  for (const auto& [from, to] : changes) {
    std::string xml = kRobot;
    ASSERT_NE(xml.find(from), std::string::npos) << from;
    xml.replace(xml.find(from), from.size(), to);
    EXPECT_NE(ParseRobotModel(xml, "small.urdf").hash, Small().hash) << from;
  }
}

}  // namespace
}  // namespace hires::robot::robot_model_test
