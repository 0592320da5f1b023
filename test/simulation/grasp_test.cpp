#include <gmock/gmock.h>

#include "arm_scene.h"
#include "simulation/hands.h"

namespace hires::simulation::grasp_test {
namespace {

using namespace test_arm;  // NOLINT: the scene's words
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

double GapOf(const RobotSimulator& simulator) {
  return simulator.GetRobotState().joints.at("r_gripper_joint");
}

/// Closes on a mug between the fingers.
std::unique_ptr<RobotSimulator> Holding(const Variation& variation = {}) {
  auto simulator = Simulator({MugAt()}, variation);
  StepFor(simulator.get(), 0.1);
  simulator->Send(Gripper(0.0));
  StepFor(simulator.get(), 1.0);
  return simulator;
}

TEST(GraspTest, ClosingOnAMugHoldsIt) {
  const auto simulator = Holding();
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  EXPECT_EQ(simulator->GetWorldState().objects[0].attached_to, "r_gripper_palm_link");
  EXPECT_NEAR(GapOf(*simulator), 2.0 * kMugRadius, 0.004);
}

TEST(GraspTest, ClosingBesideItHoldsNothing) {
  for (const Eigen::Vector2d& offset :
       {Eigen::Vector2d(0.12, 0.0), Eigen::Vector2d(0.0, 0.15), Eigen::Vector2d(0.0, -0.15)}) {
    const auto simulator = Simulator({MugAt(offset)});
    simulator->Send(Gripper(0.0));
    StepFor(simulator.get(), 2.5);
    EXPECT_THAT(simulator->held(), IsEmpty()) << offset.transpose();
    EXPECT_NEAR(GapOf(*simulator), 0.0, 1e-9);
  }
}

TEST(GraspTest, FingersThatStopBeforeTheyTouchHoldNothing) {
  const auto simulator = Simulator({MugAt()});
  simulator->Send(Gripper(0.08));
  StepFor(simulator.get(), 1.0);
  EXPECT_THAT(simulator->held(), IsEmpty());
  EXPECT_NEAR(GapOf(*simulator), 0.08, 1e-9);
}

TEST(GraspTest, AMugBesideTheMiddleIsPushedThereAndHeld) {
  const auto simulator = Simulator({MugAt({0.0, 0.007})});
  simulator->Send(Gripper(0.0));
  StepFor(simulator.get(), 1.5);
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  EXPECT_NEAR(simulator->PoseOf(0).translation.y(), kToolY, 0.003);
}

TEST(GraspTest, WhatIsHeldIsLiftedAndCarried) {
  const auto simulator = Holding();
  const auto in_palm = [&] {
    return simulator->X_MLink("r_gripper_palm_link").Inverse() * simulator->PoseOf(0);
  };
  const geometry::Pose3 X_PO = in_palm();
  simulator->Send(TorsoTo(kTorso + 0.05));
  StepFor(simulator.get(), 5.0);
  EXPECT_NEAR(simulator->PoseOf(0).translation.z(), kTableTop + 0.05, 0.002);
  simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.5, 1.0));
  robot::Command drive;
  drive.base_velocity = geometry::Twist2{-0.3, 0.0, 0.0};
  for (int i = 0; i < 30; ++i) {
    simulator->Send(drive);
    StepFor(simulator.get(), 0.05);
  }
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  EXPECT_LT((in_palm().translation - X_PO.translation).norm(), 1e-9);
  EXPECT_LT(in_palm().rotation.angularDistance(X_PO.rotation), 1e-7);
  EXPECT_NEAR(geometry::YawOf(simulator->PoseOf(0).rotation), 0.5, 0.01);
  EXPECT_FALSE(simulator->contact());
}

/// Lifts the mug by `lift` [m], turns it by `tilt` [rad] and lets it go.
geometry::Pose3 AfterLettingGo(double lift, double tilt) {
  const auto simulator = Holding();
  simulator->Send(TorsoTo(kTorso + lift));
  StepFor(simulator.get(), lift / 0.013 + 0.5);
  if (tilt != 0.0) {
    simulator->Send(JointTo("rightarm1", "r_wrist_roll_joint", tilt, 1.5));
    StepFor(simulator.get(), 2.0);
  }
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  simulator->Send(Gripper(0.09));
  StepFor(simulator.get(), 3.0);
  EXPECT_THAT(simulator->held(), IsEmpty());
  return simulator->PoseOf(0);
}

TEST(GraspTest, LetGoJustAboveTheTableItStands) {
  const geometry::Pose3 X_MO = AfterLettingGo(0.005, 0.0);
  EXPECT_LT(geometry::TiltOf(X_MO.rotation), 0.01);
  EXPECT_NEAR(X_MO.translation.z(), kTableTop, 0.002);
}

TEST(GraspTest, LetGoHighAndTiltedItFalls) {
  const geometry::Pose3 X_MO = AfterLettingGo(0.2, 0.9);
  EXPECT_GT(geometry::TiltOf(X_MO.rotation), 1.0);
}

TEST(GraspTest, SlipsWhereTheGripIsTooWeakByClosedForm) {
  // 2 mu F against m g while it stands still in the hand: mu 0.8 of the mug.
  const double weight = 0.3 * 9.81, limit = weight / (2.0 * 0.8);
  for (const double share : {0.95, 1.05}) {
    const auto simulator = Simulator({MugAt()});
    StepFor(simulator.get(), 0.1);
    simulator->Send(Gripper(0.0, share * limit));
    StepFor(simulator.get(), 1.0);
    EXPECT_EQ(simulator->held().size(), share > 1.0 ? 1u : 0u) << share;
  }
}

TEST(GraspTest, SlipsWhenTheArmAcceleratesTooMuch) {
  // The arm swings at its 2 rad/s^2 about the shoulder's axis, 0.05 m behind the base's origin.
  const double swing = 2.0 * (kToolX + 0.05);
  const double needed = 0.3 * std::hypot(9.81, swing);
  for (const double share : {0.995, 1.01}) {
    const auto simulator = Simulator({MugAt()});
    StepFor(simulator.get(), 0.1);
    simulator->Send(Gripper(0.0, share * needed / (2.0 * 0.8)));
    StepFor(simulator.get(), 1.0);
    ASSERT_EQ(simulator->held().size(), 1u) << share;
    simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", -0.6, 0.1));
    StepFor(simulator.get(), 0.2);
    EXPECT_EQ(simulator->held().size(), share > 1.0 ? 1u : 0u) << share;
  }
}

TEST(GraspTest, AHeldMugIsNotPushedThroughTheTable) {
  const auto simulator = Holding();
  simulator->Send(TorsoTo(kTorso - 0.04));
  for (int i = 0; i < 400; ++i) {
    StepFor(simulator.get(), 0.01);
    ASSERT_GT(simulator->PoseOf(0).translation.z(), kTableTop - 0.003);
  }
  ASSERT_TRUE(simulator->contact());
  EXPECT_EQ(simulator->contact()->robot_part, "mug1");
  EXPECT_EQ(simulator->contact()->obstacle, "table1");
}

TEST(GraspTest, AHeldMugPushesWhatStandsInItsWay) {
  auto simulator = Simulator({MugAt(), MugAt({0.0, 0.2}, "mug2")});
  simulator->Send(Gripper(0.0));
  StepFor(simulator.get(), 1.0);
  simulator->Send(TorsoTo(kTorso + 0.01));
  StepFor(simulator.get(), 1.5);
  ASSERT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  const Eigen::Vector3d before = simulator->PoseOf(1).translation;
  simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.5, 2.0));
  StepFor(simulator.get(), 2.5);
  EXPECT_GT((simulator->PoseOf(1).translation - before).norm(), 0.1);
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
}

TEST(GraspTest, HeldAtTheStartAsTheStateSays) {
  world::ObjectState mug = MugAt();
  mug.attached_to = "r_gripper_palm_link";
  mug.X_MO.translation.z() += 0.1;
  robot::RobotState state = ReadyState(0.0);
  state.joints["torso_lift_joint"] = kTorso + 0.1;
  const auto simulator = Simulator({mug}, {}, state);
  EXPECT_THAT(simulator->held(), ElementsAre(Pair("rightarm1", 0)));
  EXPECT_NEAR(GapOf(*simulator), 2.0 * kMugRadius, 0.004);
  StepFor(simulator.get(), 1.0);
  EXPECT_NEAR(simulator->PoseOf(0).translation.z(), mug.X_MO.translation.z(), 1e-9);
  simulator->Send(Gripper(0.09));
  StepFor(simulator.get(), 1.0);
  EXPECT_THAT(simulator->held(), IsEmpty());
  EXPECT_NEAR(simulator->PoseOf(0).translation.z(), kTableTop, 0.01);
}

TEST(GraspTest, WhatIsTooWideIsNotHeld) {
  world::ObjectState brick = MugAt({0.11, 0.0}, "brick1");
  brick.model = "brick";
  const auto simulator = Simulator({brick});
  simulator->Send(Gripper(0.0));
  StepFor(simulator.get(), 2.5);
  EXPECT_THAT(simulator->held(), IsEmpty());
}

TEST(ForceClosureTest, TheLineBetweenTheTouchesLiesInBothCones) {
  physics::Touch left, right;
  left.position = {0.0, 0.03, 0.0};
  left.normal = {0.0, -1.0, 0.0};
  right.position = {0.0, -0.03, 0.0};
  right.normal = {0.0, 1.0, 0.0};
  left.friction = right.friction = 0.5;
  EXPECT_TRUE(IsForceClosure(left, right));
  right.position.x() = 0.029;  // just within atan(0.5)
  EXPECT_TRUE(IsForceClosure(left, right));
  right.position.x() = 0.031;
  EXPECT_FALSE(IsForceClosure(left, right));
  right.friction = 2.0;  // the smaller one counts
  EXPECT_FALSE(IsForceClosure(left, right));
  left.friction = 0.6;
  EXPECT_TRUE(IsForceClosure(left, right));
  right.position.x() = 0.0;
  left.normal = right.normal = {0.0, 0.0, 1.0};  // both from below
  EXPECT_FALSE(IsForceClosure(left, right));
}

}  // namespace
}  // namespace hires::simulation::grasp_test
