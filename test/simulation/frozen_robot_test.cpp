#include "simulation/frozen_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/rng.h"
#include "simulation/arm_scene.h"
#include "support/box_mesh.h"
#include "support/messages.h"
#include "support/rounds.h"
#include "support/scenes.h"

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

/// Wheels stand on slabs whose top is the floor: what touches them is no contact, whatever the arm
/// is over, and what the arm touches is told all the same.
TEST(FrozenRobotTest, ASlabThatBearsTheWheelsIsNotWhatARaisedArmTouches) {
  base::Rng rng(19);
  for (int i = 0; i < test_support::Rounds(48); ++i) {
    const double torso = rng.Bernoulli(0.5) ? kTorso : 0.0, sunk = rng.Uniform(0.0, 0.005);
    const auto before = ArmScene();
    robot::Robot robot = before->robot;
    const auto base = robot.model.FindLink(robot.profile.base_link);
    robot.model.links[*base].collisions.push_back(
        test_support::Shape("wheel", geometry::Cylinder{0.1, 0.2}, {0.0, 0.0, 0.1 - sunk}));
    world::World world = before->world;
    const double top = rng.Uniform(-sunk, 0.005 - sunk);
    world::StaticBody slab = test_support::Block("slab", {6.0, 6.0, 0.1}, {0.0, 0.0, top - 0.05});
    if (rng.Bernoulli(0.5)) slab.collisions.front().shape = test_support::BoxMesh({6.0, 6.0, 0.1});
    world.statics.insert(world.statics.begin() + (rng.Bernoulli(0.5) ? 0 : 1), slab);
    const auto scene = MakeScene(world, robot);
    physics::PhysicsWorld physics{physics::PhysicsParams()};
    physics.AddFloor(1.0);
    for (const auto& body : scene->world.statics) physics.AddStatic(body.collisions, body.X_MB);
    robot::RobotState state = ReadyState();
    state.joints["torso_lift_joint"] = torso;
    FrozenRobot frozen(scene, state.joints);
    frozen.AddBody(Pose3(), {}, &physics);
    const auto contact = frozen.FindContact({});
    EXPECT_EQ(contact.has_value(), torso == 0.0) << i << " top " << top << " sunk " << sunk;
    EXPECT_EQ(contact.value_or(RobotContact()).obstacle, torso == 0.0 ? "table1" : "");
  }
}

}  // namespace
}  // namespace hires::simulation::frozen_robot_test
