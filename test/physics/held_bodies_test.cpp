// Loose bodies that move with driven ones, touches, and driven bodies against static ones.
#include <gmock/gmock.h>

#include <cmath>

#include "physics/scenes.h"

namespace hires::physics::held_bodies_test {
namespace {

using Eigen::Vector3d;
using test_support::AddStandingCylinder;
using test_support::At;
using test_support::MakeCollision;

constexpr double kDt = 0.001;

/// A driven plate above the floor, with a cylinder that stands on it.
struct Hand {
  Hand() : world({}) {
    floor = world.AddFloor(1.0);
    plate = world.AddDriven({MakeCollision(geometry::Box{{0.3, 0.3, 0.02}}, {0.0, 0.0, -0.01})},
                            At(0.0, 0.0, 1.0).X_WB);
    mug = AddStandingCylinder(&world, {0.04, 0.1}, 0.3, {0.05, 0.0, 1.0});
  }
  void Move(const Vector3d& v, const Vector3d& w, int num_steps) {
    for (int i = 0; i < num_steps; ++i) {
      BodyState motion = world.GetState(plate);
      motion.V_WB = {v, w};
      world.SetMotion(plate, motion);
      world.Step();
    }
  }
  geometry::Pose3 InPlate() {
    return world.GetState(plate).X_WB.Inverse() * world.GetState(mug).X_WB;
  }

  PhysicsWorld world;
  BodyId floor{0}, plate{0}, mug{0};
};

TEST(HeldBodiesTest, ItFollowsWhateverTheHolderDoes) {
  Hand hand;
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});
  const geometry::Pose3 X_PM = hand.InPlate();
  hand.Move({0.5, -0.3, 0.4}, {1.0, 2.0, -1.5}, 1500);
  EXPECT_TRUE(hand.world.IsHeld(hand.mug));
  EXPECT_LT((hand.InPlate().translation - X_PM.translation).norm(), 1e-12);
  EXPECT_LT(hand.InPlate().rotation.angularDistance(X_PM.rotation), 1e-7);
  // Its velocity is that of the rigid body.
  const BodyState plate = hand.world.GetState(hand.plate), mug = hand.world.GetState(hand.mug);
  const Vector3d v =
      plate.V_WB.linear + plate.V_WB.angular.cross(mug.X_WB.translation - plate.X_WB.translation);
  EXPECT_LT((mug.V_WB.linear - v).norm(), 1e-12);
}

TEST(HeldBodiesTest, LetGoItFliesOnWithItsVelocity) {
  Hand hand;
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});
  hand.Move({1.0, 0.0, 2.0}, Vector3d::Zero(), 500);
  const double x = hand.world.GetState(hand.mug).X_WB.translation.x();
  const double z = hand.world.GetState(hand.mug).X_WB.translation.z();
  hand.world.LetGo(hand.mug);
  hand.Move({0.0, 0.0, -2.0}, Vector3d::Zero(), 200);
  EXPECT_FALSE(hand.world.IsHeld(hand.mug));
  const Vector3d p = hand.world.GetState(hand.mug).X_WB.translation;
  EXPECT_NEAR(p.x() - x, 0.2, 1e-9);
  EXPECT_NEAR(p.z() - z, 2.0 * 0.2 - 0.5 * 9.81 * 0.2 * (0.2 + kDt), 1e-9);
}

TEST(HeldBodiesTest, ItPushesLooseBodiesAndIsNotPushed) {
  Hand hand;
  const BodyId other = AddStandingCylinder(&hand.world, {0.04, 0.1}, 3.0, {0.15, 0.0, 1.0});
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});
  const geometry::Pose3 X_PM = hand.InPlate();
  // The plate stays below the other one and slides away under it: friction alone would carry it.
  hand.Move({0.3, 0.0, 0.0}, {0.0, 0.0, 4.0}, 400);
  EXPECT_GT((hand.world.GetState(other).X_WB.translation - Vector3d(0.15, 0.0, 1.0)).norm(), 0.05);
  EXPECT_LT((hand.InPlate().translation - X_PM.translation).norm(), 1e-12);
}

TEST(HeldBodiesTest, TouchesAreToldWithDepthAndNormal) {
  Hand hand;
  for (int i = 0; i < 200; ++i) hand.world.Step();
  ASSERT_EQ(hand.world.touches().size(), 1u);
  const Touch touch = hand.world.touches()[0];
  EXPECT_EQ(touch.loose, hand.mug);
  EXPECT_EQ(touch.other, hand.plate);
  EXPECT_NEAR(touch.normal.z(), 1.0, 1e-6);
  EXPECT_NEAR(touch.position.x(), 0.05, 0.005);
  EXPECT_EQ(touch.friction, 0.8);
  EXPECT_LT(touch.depth, 0.0011);
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});  // the grip is left out
  hand.world.Step();
  EXPECT_TRUE(hand.world.touches().empty());
}

TEST(HeldBodiesTest, PressedOnTheFloorItTouchesAndCanBeShifted) {
  Hand hand;
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});
  BodyState low = At(0.0, 0.0, -0.005);
  hand.world.SetMotion(hand.plate, low);
  const std::vector<Touch> touches = hand.world.FindTouches();
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].other, hand.floor);
  EXPECT_NEAR(touches[0].depth, 0.005, 1e-9);
  EXPECT_NEAR(touches[0].normal.z(), 1.0, 1e-12);
  hand.world.ShiftHeld(hand.mug, touches[0].depth * touches[0].normal);
  EXPECT_NEAR(hand.world.GetState(hand.mug).X_WB.translation.z(), 0.0, 1e-9);
}

TEST(HeldBodiesTest, LookingForTouchesChangesNothing) {
  Hand looked, plain;
  for (int i = 0; i < 300; ++i) {
    looked.world.FindTouches();
    looked.Move({0.2, 0.0, 0.0}, {0.0, 0.0, 1.0}, 1);
    plain.Move({0.2, 0.0, 0.0}, {0.0, 0.0, 1.0}, 1);
  }
  const BodyState a = looked.world.GetState(looked.mug), b = plain.world.GetState(plain.mug);
  EXPECT_EQ(a.X_WB.translation, b.X_WB.translation);
  EXPECT_EQ(a.V_WB.angular, b.V_WB.angular);
  EXPECT_EQ(looked.world.num_contacts(), plain.world.num_contacts());
}

TEST(HeldBodiesTest, SavedAndRestoredHoldsAreTheSame) {
  Hand hand;
  hand.world.Hold(hand.mug, hand.plate, {hand.plate});
  hand.Move({0.2, 0.1, 0.0}, {0.5, 0.0, 1.0}, 100);
  const PhysicsState held = hand.world.Save();
  const auto play = [&] {
    hand.Move({0.0, 0.3, 0.1}, {0.0, 1.0, 0.0}, 100);
    hand.world.LetGo(hand.mug);
    hand.Move({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 600);
    return hand.world.GetState(hand.mug);
  };
  const BodyState first = play();
  EXPECT_FALSE(hand.world.IsHeld(hand.mug));
  hand.world.Restore(held);
  EXPECT_TRUE(hand.world.IsHeld(hand.mug));
  const BodyState second = play();
  EXPECT_EQ(first.X_WB.translation, second.X_WB.translation);
  EXPECT_EQ(first.X_WB.rotation.coeffs(), second.X_WB.rotation.coeffs());
  EXPECT_EQ(first.V_WB.linear, second.V_WB.linear);
}

TEST(HeldBodiesTest, DrivenBodiesAreLookedAtAgainstStaticOnes) {
  Hand hand;
  const BodyId table = hand.world.AddStatic(
      {MakeCollision(geometry::Box{{0.4, 0.4, 0.5}}, {0.0, 0.0, 0.25})}, At(1.0, 0.0, 0.0).X_WB);
  EXPECT_FALSE(hand.world.FindFixedTouch(hand.plate));
  hand.world.SetMotion(hand.plate, At(0.7, 0.0, 0.525));  // its lower face at 0.505
  EXPECT_FALSE(hand.world.FindFixedTouch(hand.plate));
  hand.world.SetMotion(hand.plate, At(0.7, 0.0, 0.517));
  const auto touch = hand.world.FindFixedTouch(hand.plate);
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->fixed, table);
  EXPECT_EQ(touch->shape, 0);
  EXPECT_GT(touch->depth, 0.0);
  hand.world.SetMotion(hand.plate, At(0.0, 0.0, 0.005));
  ASSERT_TRUE(hand.world.FindFixedTouch(hand.plate));
  EXPECT_EQ(hand.world.FindFixedTouch(hand.plate)->fixed, hand.floor);
}

TEST(HeldBodiesTest, WhatCannotBeIsRefused) {
  Hand hand;
  EXPECT_THROW(hand.world.LetGo(hand.mug), std::logic_error);
  EXPECT_THROW(hand.world.Hold(hand.plate, hand.plate, {}), std::logic_error);
  EXPECT_THROW(hand.world.Hold(hand.mug, hand.floor, {}), std::logic_error);
  EXPECT_THROW(hand.world.Hold(hand.mug, hand.plate, {hand.mug}), std::logic_error);
  hand.world.Hold(hand.mug, hand.plate, {});
  EXPECT_THROW(hand.world.Hold(hand.mug, hand.plate, {}), std::logic_error);
  EXPECT_THROW(hand.world.SetState(hand.mug, At(0.0, 0.0, 2.0)), std::logic_error);
  EXPECT_THROW(hand.world.FindFixedTouch(hand.mug), std::logic_error);
}

}  // namespace
}  // namespace hires::physics::held_bodies_test
