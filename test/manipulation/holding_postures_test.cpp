#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/manipulation/grasp.h"
#include "restaurant_scene.h"

namespace hires::manipulation::holding_postures_test {
namespace {

using namespace test_support;

const std::vector<std::string> kObjects{"peppermill_thesis", "coffee_cup"};
const geometry::Pose2 kFreeFloor{12.5, 9.8, 2.0};

/// The numbers of docs/notes_manipulation.md.
const std::map<std::string, ArmJoints> kSideHoldingToSide{
    {"leftarm1", {2.115, -0.02, 1.64, -2.07, 0.0, -0.5, -1.523}},
    {"rightarm1", {-2.115, -0.02, -1.64, -2.07, 0.0, -0.5, 1.523}}};
const std::map<std::string, ArmJoints> kSideHoldingCarry{
    {"leftarm1", {0.986, 1.263, 0.985, -2.078, 1.967, -0.861, -2.503}},
    {"rightarm1", {-0.986, 1.263, -0.985, -2.078, -1.967, -0.861, 2.503}}};

Grasp BestGrasp(const std::string& model, const std::string& kind) {
  for (const Grasp& grasp : GraspsFor(*Model(model), Pr2()->profile.upper_body->gripper)) {
    if (grasp.kind == kind) return grasp;
  }
  throw std::runtime_error("no grasp");
}

Eigen::Vector3d UprightAxis(const Grasp& grasp) {
  return grasp.X_OT.rotation.conjugate() * Eigen::Vector3d::UnitZ();
}

/// An object in the hand of an arm that stands as `posture` says.
world::ObjectState Held(const std::string& arm, const std::string& model, const Grasp& grasp,
                        const robot::JointPositions& posture) {
  const ArmKinematics kinematics(*Pr2(), arm);
  world::ObjectState held = Standing(model + " of " + arm, model, 0.0, 0.0, 0.0);
  held.X_MO = geometry::Lift(kFreeFloor) *
              kinematics.ToolPose(posture, kinematics.JointsOf(posture)) * grasp.X_OT.Inverse();
  held.attached_to = Pr2()->profile.upper_body->arms.at(arm).palm_link;
  return held;
}

void TakeInHand(const std::string& arm, const Grasp& grasp, const ArmJoints& joints,
                robot::JointPositions* posture) {
  SetArm(arm, joints, posture);
  const robot::UpperBodyProfile& body = *Pr2()->profile.upper_body;
  robot::SetGap(body.gripper, body.arms.at(arm), grasp.gap, posture);
}

/// Angle [rad] between the axis of what is held and the vertical.
double Tilt(const std::string& arm, const Grasp& grasp, const robot::JointPositions& posture) {
  const ArmKinematics kinematics(*Pr2(), arm);
  const auto R_BT = kinematics.ToolPose(posture, kinematics.JointsOf(posture)).rotation;
  return std::acos(std::clamp((R_BT * UprightAxis(grasp).normalized()).z(), -1.0, 1.0));
}

std::string TouchWith(const std::vector<world::ObjectState>& objects,
                      const robot::JointPositions& posture, const std::string& arm) {
  CollisionScene scene = RestaurantScene();
  scene.SetObjects(objects, kFreeFloor, posture);
  const auto links = scene.MovedBy(Pr2()->profile.upper_body->arms.at(arm).joints);
  const auto touch = scene.FindTouch(kFreeFloor, posture, links);
  return touch ? ToString(*touch) : "";
}

TEST(HoldingPosturesTest, ToSideKeepsUprightWhatIsHeldFromTheSide) {
  for (const auto& [arm, joints] : kSideHoldingToSide) {
    for (const std::string& model : kObjects) {
      const Grasp grasp = BestGrasp(model, "side");
      for (const std::string other : {"armtosideposture", "armtuckedposture"}) {
        robot::JointPositions posture = Posture(other, 0.295, 0.0);
        TakeInHand(arm, grasp, joints, &posture);
        EXPECT_LT(Tilt(arm, grasp, posture), 0.1);
        EXPECT_EQ(TouchWith({Held(arm, model, grasp, posture)}, posture, arm), "");
      }
    }
  }
}

TEST(HoldingPosturesTest, CarryKeepsUprightWhatIsHeldFromTheSide) {
  for (const auto& [arm, joints] : kSideHoldingCarry) {
    for (const std::string& model : kObjects) {
      const Grasp grasp = BestGrasp(model, "side");
      for (const std::string other : {"armcarryposture", "armtosideposture"}) {
        for (const double torso : {0.295, 0.2, 0.15}) {
          robot::JointPositions posture = Posture(other, torso, 0.0);
          TakeInHand(arm, grasp, joints, &posture);
          EXPECT_LT(Tilt(arm, grasp, posture), 0.1);
          EXPECT_EQ(TouchWith({Held(arm, model, grasp, posture)}, posture, arm), "")
              << arm << other;
        }
      }
    }
  }
}

TEST(HoldingPosturesTest, TheProfilesVariantsKeepUprightWhatIsHeldFromAbove) {
  int num_variants = 0;
  for (const auto& [arm, profile] : Pr2()->profile.upper_body->arms) {
    for (const auto& [name, joints] : profile.holding_postures) {
      for (const std::string& model : kObjects) {
        const Grasp grasp = BestGrasp(model, "top");
        robot::JointPositions posture = Posture(name, 0.295, 0.0);
        TakeInHand(arm, grasp, joints, &posture);
        EXPECT_LT(Tilt(arm, grasp, posture), 0.1) << arm << " " << name;
        EXPECT_EQ(TouchWith({Held(arm, model, grasp, posture)}, posture, arm), "") << name;
        ++num_variants;
      }
    }
  }
  EXPECT_EQ(num_variants, 8) << "two arms, two postures, two objects";
}

TEST(HoldingPosturesTest, BothArmsCanCarryAtOnce) {
  for (const double torso : {0.295, 0.2, 0.15}) {
    robot::JointPositions posture = Posture("armcarryposture", torso);
    std::vector<world::ObjectState> objects;
    const Grasp grasp = BestGrasp("coffee_cup", "side");
    for (const auto& [arm, joints] : kSideHoldingCarry) TakeInHand(arm, grasp, joints, &posture);
    for (const auto& [arm, joints] : kSideHoldingCarry) {
      objects.push_back(Held(arm, "coffee_cup", grasp, posture));
    }
    for (const auto& [arm, joints] : kSideHoldingCarry) {
      EXPECT_EQ(TouchWith(objects, posture, arm), "");
    }
  }
}

TEST(HoldingPosturesTest, PublishedCarryKeepsUprightWhatIsHeldFromAbove) {
  for (const std::string arm : {"leftarm1", "rightarm1"}) {
    const Grasp grasp = BestGrasp("coffee_cup", "top");
    robot::JointPositions posture = Posture("armcarryposture", 0.295);
    TakeInHand(arm, grasp, ArmKinematics(*Pr2(), arm).JointsOf(posture), &posture);
    EXPECT_LT(Tilt(arm, grasp, posture), 0.1);
    EXPECT_EQ(TouchWith({Held(arm, "coffee_cup", grasp, posture)}, posture, arm), "");
  }
}

TEST(HoldingPosturesTest, PublishedCarryMeetsTheTrayBelowTorsoHeight019) {
  const CollisionScene scene = RestaurantScene();
  const auto closed = [](double torso) { return Posture("armcarryposture", torso, 0.0); };
  EXPECT_FALSE(scene.FindTouch(kFreeFloor, closed(0.19)));
  const auto touch = scene.FindTouch(kFreeFloor, closed(0.15));
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->a, "base_tray_link");
}

}  // namespace
}  // namespace hires::manipulation::holding_postures_test
