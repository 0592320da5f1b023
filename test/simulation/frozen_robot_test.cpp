#include "simulation/frozen_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/arm_scene.h"
#include "support/messages.h"

namespace hires::simulation::frozen_robot_test {
namespace {

using namespace test_arm;  // NOLINT: the scene's words
using geometry::Pose3;
using test_support::ConfigErrorOf;
using ::testing::HasSubstr;

TEST(FrozenRobotTest, HasTheScenesShapesInTheDrivingPostureAlone) {
  const auto scene = ArmScene();
  EXPECT_EQ(&FrozenRobot(scene, {}).shapes_B(), &scene->robot_shapes_B);
  EXPECT_NE(&FrozenRobot(scene, ReadyState().joints).shapes_B(), &scene->robot_shapes_B);
}

TEST(FrozenRobotTest, LinksGoWhereTheBaseGoes) {
  const FrozenRobot robot(ArmScene(), ReadyState().joints);
  const Pose3 X_MB = geometry::Lift({2.0, -1.0, 0.7});
  const Pose3 X_BL = robot.X_MLink(Pose3(), "r_gripper_palm_link");
  EXPECT_NEAR(X_BL.translation.y(), kToolY, 1e-9);
  EXPECT_LT(
      (robot.X_MLink(X_MB, "r_gripper_palm_link").translation - X_MB * X_BL.translation).norm(),
      1e-12);
  EXPECT_THAT(ConfigErrorOf([&] { robot.X_MLink(X_MB, "r_gripper_pal_link"); }),
              HasSubstr("r_gripper_palm_link"));
}

/// The arm that reaches over the table touches it once the torso is low; the prism round the arm
/// alone would say so before.
TEST(FrozenRobotTest, TouchesWithItsExactShapes) {
  for (const double torso : {kTorso, 0.0}) {
    const auto scene = ArmScene();
    physics::PhysicsWorld physics{physics::PhysicsParams()};
    physics.AddFloor(1.0);
    for (const auto& body : scene->world.statics) physics.AddStatic(body.collisions, body.X_MB);
    robot::RobotState state = ReadyState();
    state.joints["torso_lift_joint"] = torso;
    FrozenRobot robot(scene, state.joints);
    robot.AddBody(Pose3(), {}, &physics);
    const auto contact = robot.FindContact({});
    EXPECT_EQ(contact.has_value(), torso == 0.0);
    EXPECT_EQ(contact.value_or(RobotContact()).obstacle, torso == 0.0 ? "table1" : "");
  }
}

}  // namespace
}  // namespace hires::simulation::frozen_robot_test
