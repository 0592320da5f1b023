#include "hires/robot/gripper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/robot/robot_profile.h"

namespace hires::robot::gripper_test {
namespace {

const Robot& Pr2() {
  static const Robot robot = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return robot;
}
const GripperProfile& Gripper() { return Pr2().profile.upper_body->gripper; }

TEST(GripperTest, EndsAreThePublishedOnes) {
  EXPECT_EQ(GapOf(Gripper(), 0.0), 0.0);
  EXPECT_EQ(GapOf(Gripper(), 0.548), 0.09);
  EXPECT_EQ(FingerPositionOf(Gripper(), 0.0), 0.0);
  EXPECT_NEAR(FingerPositionOf(Gripper(), 0.09), 0.548, 1e-12);
  EXPECT_EQ(GapOf(Gripper(), -0.1), 0.0);
  EXPECT_EQ(GapOf(Gripper(), 0.6), 0.09);
}

TEST(GripperTest, GapAndAngleAreEachOthersInverse) {
  double last = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const double gap = 0.09 * i / 100;
    EXPECT_GT(FingerPositionOf(Gripper(), gap), last);
    last = FingerPositionOf(Gripper(), gap);
    EXPECT_NEAR(GapOf(Gripper(), FingerPositionOf(Gripper(), gap)), gap, 1e-12);
  }
}

TEST(GripperTest, SlidingFingersMoveByHalfTheGapEach) {
  GripperProfile jaws;
  jaws.fingers = FingerMotion::kSliding;
  jaws.max_gap = 0.10;
  EXPECT_EQ(GapOf(jaws, 0.02), 0.04);
  EXPECT_EQ(FingerPositionOf(jaws, 0.04), 0.02);
  EXPECT_EQ(GapOf(jaws, -0.01), 0.0);
  EXPECT_EQ(GapOf(jaws, 0.06), 0.10);
  EXPECT_EQ(FingerPositionOf(jaws, 0.12), 0.05);
}

TEST(GripperTest, ItIsNearTheLinkage) {
  // Both tips swing on links of 0.0915 m from 3.6029 degrees.
  const double r = 0.0915, theta0 = 3.6029 * M_PI / 180.0;
  for (double angle = 0.0; angle <= 0.548; angle += 0.01) {
    const double linkage = 2.0 * r * (std::sin(theta0 + angle) - std::sin(theta0));
    EXPECT_NEAR(GapOf(Gripper(), angle), linkage, 0.0035) << angle;
  }
}

TEST(GripperTest, ItIsNearTheDistanceOfTheTipsInTheUrdf) {
  for (const double gap : {0.01, 0.03, 0.05, 0.07, 0.09}) {
    JointPositions joints;
    SetGap(Gripper(), Pr2().profile.upper_body->arms.at("leftarm1"), gap, &joints);
    geometry::Aabb left, right;
    for (const auto& shape : FrozenCollisions(Pr2().model, joints)) {
      if (shape.name.find("l_gripper_l_finger_tip") == 0) {
        left.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
      }
      if (shape.name.find("l_gripper_r_finger_tip") == 0) {
        right.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
      }
    }
    EXPECT_NEAR(left.lower.y() - right.upper.y(), gap, 0.003) << gap;
  }
}

TEST(GripperTest, CompletingMakesGapAndAngleAgree) {
  const UpperBodyProfile& profile = *Pr2().profile.upper_body;
  JointPositions by_angle{{"r_gripper_l_finger_joint", 0.3}};
  CompleteGrippers(profile, &by_angle);
  EXPECT_NEAR(by_angle.at("r_gripper_joint"), GapOf(Gripper(), 0.3), 1e-12);
  EXPECT_EQ(by_angle.count("l_gripper_joint"), 0u);
  JointPositions by_gap{{"r_gripper_joint", 0.04}, {"r_gripper_l_finger_joint", 0.0}};
  CompleteGrippers(profile, &by_gap);
  EXPECT_EQ(by_gap.at("r_gripper_joint"), 0.04);
  EXPECT_NEAR(by_gap.at("r_gripper_l_finger_joint"), FingerPositionOf(Gripper(), 0.04), 1e-12);
}

}  // namespace
}  // namespace hires::robot::gripper_test
