#include "hires/robot/posture.h"

#include <gtest/gtest.h>

#include "hires/robot/gripper.h"

namespace hires::robot::posture_test {
namespace {

const Robot& Pr2() {
  static const Robot robot = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return robot;
}

TEST(PostureOfTest, WhatIsNotGivenIsAsInTheDrivingPosture) {
  const JointPositions nothing_given = PostureOf(Pr2(), {});
  for (const auto& [name, position] : Pr2().profile.joints) {
    EXPECT_EQ(nothing_given.at(name), position) << name;
  }
  const JointPositions posture = PostureOf(Pr2(), {{"torso_lift_joint", 0.2}});
  EXPECT_EQ(posture.at("torso_lift_joint"), 0.2);
  EXPECT_EQ(posture.at("head_pan_joint"), nothing_given.at("head_pan_joint"));
  EXPECT_EQ(posture.size(), nothing_given.size());
}

TEST(PostureOfTest, OfAPostureItIsThatPosture) {
  const JointPositions posture = PostureOf(Pr2(), {{"torso_lift_joint", 0.2}});
  EXPECT_EQ(PostureOf(Pr2(), posture), posture);
}

TEST(PostureOfTest, AnEncodersErrorOverALimitIsTheLimitAndMoreIsKept) {
  const double upper = FindJoint(Pr2().model, "torso_lift_joint")->limits->upper;
  EXPECT_EQ(PostureOf(Pr2(), {{"torso_lift_joint", upper + 0.019}}).at("torso_lift_joint"), upper);
  EXPECT_EQ(PostureOf(Pr2(), {{"torso_lift_joint", upper + 0.5}}).at("torso_lift_joint"),
            upper + 0.5);
}

TEST(PostureOfTest, AFingerAngleThatIsGivenLeadsTheGap) {
  const UpperBodyProfile& upper_body = *Pr2().profile.upper_body;
  const ArmProfile& arm = upper_body.arms.begin()->second;
  JointPositions given{{"torso_lift_joint", 0.2}};
  SetGap(upper_body.gripper, arm, 0.05, &given);
  JointPositions angle_alone = given;
  angle_alone.erase(arm.gripper_joint);
  EXPECT_EQ(given.size(), angle_alone.size() + 1);
  EXPECT_NEAR(PostureOf(Pr2(), angle_alone).at(arm.gripper_joint), 0.05, 1e-9);
}

}  // namespace
}  // namespace hires::robot::posture_test
