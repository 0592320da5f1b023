#include "hires/simulation/free_start.h"

#include <gtest/gtest.h>

#include "simulation/arm_scene.h"

namespace hires::simulation::free_start_test {
namespace {

using test_arm::Pr2;
using test_arm::ReadyState;

/// A post that stands in the way of a stretched right arm after some 0.25 m, of the base later.
std::shared_ptr<const Scene> SceneWithPost() {
  world::World room = test_support::Room();
  room.statics = {test_support::Block("post", {0.1, 0.1, 1.6}, {1.2, test_arm::kToolY, 0.8})};
  return MakeScene(room, Pr2());
}

Variation Shifted(double x, double y, double yaw) {
  Variation variation;
  variation.start_offset = {x, y, yaw};
  variation.wheel_slip = 0.01;
  return variation;
}

void ExpectOffset(const Variation& variation, double x, double y, double yaw) {
  EXPECT_EQ(variation.start_offset.x, x);
  EXPECT_EQ(variation.start_offset.y, y);
  EXPECT_EQ(variation.start_offset.yaw, yaw);
  EXPECT_EQ(variation.wheel_slip, 0.01) << "all else stays as drawn";
}

TEST(FreeStartTest, AnOffsetThatTouchesNothingStays) {
  ExpectOffset(WithFreeStart(Shifted(-0.4, 0.1, 0.02), *SceneWithPost(), ReadyState()), -0.4, 0.1,
               0.02);
}

TEST(FreeStartTest, AnOffsetIntoAThingIsHalvedUntilItTouchesNothing) {
  robot::RobotState driving;  // the base ends 0.34 m before its origin
  ExpectOffset(WithFreeStart(Shifted(1.2, 0.0, 0.01), *SceneWithPost(), driving), 0.6, 0.0, 0.005);
}

TEST(FreeStartTest, WhatTheJointsReachCounts) {
  const auto scene = SceneWithPost();
  ExpectOffset(WithFreeStart(Shifted(0.4, 0.0, 0.0), *scene, {}), 0.4, 0.0, 0.0);
  ExpectOffset(WithFreeStart(Shifted(0.4, 0.0, 0.0), *scene, ReadyState()), 0.2, 0.0, 0.0);
}

TEST(FreeStartTest, ARobotThatTouchesSomethingAnywayHasNoOffset) {
  robot::RobotState start;
  start.X_MB = {1.2, test_arm::kToolY, 0.0};
  ExpectOffset(WithFreeStart(Shifted(0.02, 0.0, 0.1), *SceneWithPost(), start), 0.0, 0.0, 0.0);
}

}  // namespace
}  // namespace hires::simulation::free_start_test
