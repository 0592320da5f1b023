#include "hires/translation/classification.h"

#include <gmock/gmock.h>

#include "hires/geometry/angles.h"
#include "support/restaurant_translation.h"

namespace hires::translation::classification_test {
namespace {

using base::Atom;
using test_support::RestaurantContext;
using test_support::Texts;
using testing::Contains;
using testing::Not;
using testing::StartsWith;

GeometricState RobotAt(double x, double y, double yaw) {
  GeometricState state;
  state.robot.X_MB = {x, y, yaw};
  state.robot.joints = RestaurantContext().robot->profile.joints;
  return state;
}

void AddObject(const std::string& name, const geometry::Pose3& X_MO, GeometricState* state) {
  world::ObjectState object;
  object.name = name;
  object.model = RestaurantContext().ModelOf(name);
  object.X_MO = X_MO;
  state->world.objects.push_back(object);
}

geometry::Pose3 Standing(double x, double y, double z) {
  geometry::Pose3 pose;
  pose.translation = {x, y, z};
  return pose;
}

std::vector<std::string> Says(const GeometricState& state,
                              const std::vector<Atom>* before = nullptr) {
  return Texts(AtomsOf(RestaurantContext(), state, before));
}

TEST(AtomsOfTest, TheRobotIsAtTheNearestAreaWithinTolerance) {
  EXPECT_THAT(Says(RobotAt(12.6, 11.7, 3.0)), Contains("RobotAt(nearstartarea1)"));
  EXPECT_THAT(Says(RobotAt(12.9, 11.4, 3.1)), Contains("RobotAt(home)"));
}

TEST(AtomsOfTest, ElsewhereItIsInTheRoom) {
  EXPECT_THAT(Says(RobotAt(12.5, 12.1, 3.14)), Contains("RobotAt(floorareatamsrestaurant1)"));
  EXPECT_THAT(Says(RobotAt(12.5, 11.8, 2.6)), Contains("RobotAt(floorareatamsrestaurant1)"));
}

TEST(AtomsOfTest, TheYawIsComparedAcrossTheTurn) {
  EXPECT_THAT(Says(RobotAt(12.5, 11.8, -3.1)), Contains("RobotAt(nearstartarea1)"));
}

TEST(AtomsOfTest, AnAreaIsLeftLaterThanItIsEntered) {
  const std::vector<Atom> before = {{"RobotAt", {"nearstartarea1"}}};
  const GeometricState border = RobotAt(12.5, 12.07, 3.14);  // 0.27 m off, 0.25 m are allowed
  EXPECT_THAT(Says(border), Contains("RobotAt(floorareatamsrestaurant1)"));
  EXPECT_THAT(Says(border, &before), Contains("RobotAt(nearstartarea1)"));
  EXPECT_THAT(Says(RobotAt(12.5, 12.11, 3.14), &before),
              Contains("RobotAt(floorareatamsrestaurant1)"));
}

TEST(AtomsOfTest, PosturesAreNamedAndOthersAreUnnamed) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  const robot::ArmProfile& arm = RestaurantContext().robot->profile.upper_body->arms.at("leftarm1");
  const auto set = [&](std::vector<double> positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      state.robot.joints[arm.joints[i]] = positions[i];
    }
  };
  auto tucked = arm.postures.at("armtuckedposture")[0];
  set(tucked);
  EXPECT_THAT(Says(state), Contains("HasArmPosture(leftarm1, armtuckedposture)"));
  tucked[0] += 0.11;  // beyond 0.1 rad, within 1.2 times that
  set(tucked);
  EXPECT_THAT(Says(state), Contains("HasArmPosture(leftarm1, armunnamedposture)"));
  const std::vector<Atom> before = {{"HasArmPosture", {"leftarm1", "armtuckedposture"}}};
  EXPECT_THAT(Says(state, &before), Contains("HasArmPosture(leftarm1, armtuckedposture)"));
}

TEST(AtomsOfTest, JointsThatTurnRoundAreComparedAcrossTheTurn) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  const robot::ArmProfile& arm =
      RestaurantContext().robot->profile.upper_body->arms.at("rightarm1");
  const auto& carry = arm.postures.at("armcarryposture")[0];
  for (std::size_t i = 0; i < carry.size(); ++i) state.robot.joints[arm.joints[i]] = carry[i];
  state.robot.joints["r_wrist_roll_joint"] -= 2.0 * geometry::kPi;
  EXPECT_THAT(Says(state), Contains("HasArmPosture(rightarm1, armcarryposture)"));
}

TEST(AtomsOfTest, TheTorsoIsNamedWithinItsTolerance) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  state.robot.joints["torso_lift_joint"] = 0.28;
  EXPECT_THAT(Says(state), Contains("HasTorsoPosture(torsoupposture)"));
  state.robot.joints["torso_lift_joint"] = 0.24;
  EXPECT_THAT(Says(state), Contains("HasTorsoPosture(torsoposture)"));
}

TEST(AtomsOfTest, ObjectsAreOnTheAreaWhoseMiddleIsNearest) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  AddObject("mug1", Standing(5.47, 9.90, 0.75), &state);    // the counter's area is 0.65 m long
  AddObject("mug2", Standing(7.48, 11.452, 0.73), &state);  // where two squares overlap
  EXPECT_THAT(Says(state), Contains("On(mug1, placingareaeastrightcounter1)"));
  EXPECT_THAT(Says(state), Contains("On(mug2, placingareawestlefttable1)"));
  const std::vector<Atom> before = {{"On", {"mug2", "placingareawestrighttable1"}}};
  EXPECT_THAT(Says(state, &before), Contains("On(mug2, placingareawestrighttable1)"));
}

TEST(AtomsOfTest, WhatLiesOrHangsInTheAirOrStandsOnTheFloorIsOnNothing) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  geometry::Pose3 lying = Standing(5.47, 10.16, 0.79);
  lying.rotation = geometry::RotationFromRpy(1.5, 0.0, 0.0);
  AddObject("mug1", lying, &state);
  AddObject("mug2", Standing(5.47, 10.16, 0.90), &state);
  AddObject("peppermill1", Standing(8.9, 10.0, 0.0), &state);
  EXPECT_THAT(Says(state), Not(Contains(StartsWith("On("))));
}

TEST(AtomsOfTest, WhatAHandHoldsIsOnNothing) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  AddObject("mug1", Standing(5.47, 10.16, 0.75), &state);
  state.world.objects[0].attached_to = "r_gripper_palm_link";
  EXPECT_THAT(Says(state), Contains("Holding(rightarm1, mug1)"));
  EXPECT_THAT(Says(state), Contains("Holding(leftarm1, nothing)"));
  EXPECT_THAT(Says(state), Not(Contains(StartsWith("On("))));
}

TEST(AtomsOfTest, TheTrayTravelsWithTheRobot) {
  for (const double yaw : {0.0, 1.0, -2.5}) {
    GeometricState state = RobotAt(9.0, 12.5, yaw);
    const geometry::Pose3 X_MB = geometry::Lift(state.robot.X_MB);
    AddObject("mug1", X_MB * Standing(0.28, 0.2, 0.346), &state);
    AddObject("mug2", X_MB * Standing(0.50, 0.2, 0.346), &state);
    EXPECT_THAT(Says(state), Contains("On(mug1, trayarea1)"));
    EXPECT_THAT(Says(state), Not(Contains(StartsWith("On(mug2"))));
  }
}

TEST(AtomsOfTest, GripperGapsBesideFingerAnglesDoNoHarm) {
  GeometricState state = RobotAt(12.5, 11.8, 3.14);
  state.robot.joints["l_gripper_joint"] = 0.08;
  state.robot.joints["l_gripper_l_finger_joint"] = 0.48;
  EXPECT_THAT(Says(state), Contains("Holding(leftarm1, nothing)"));
}

}  // namespace
}  // namespace hires::translation::classification_test
