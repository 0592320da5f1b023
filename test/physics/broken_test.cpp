// What is void: energy that nothing gave.
#include <gtest/gtest.h>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/physics/physics_world.h"
#include "physics/scenes.h"

namespace hires::physics::broken_test {
namespace {

using Eigen::Vector3d;
using test_support::At;
using test_support::MakeCollision;

const geometry::Box kCube{{0.06, 0.06, 0.06}};
constexpr double kMass = 0.3;

BodyId AddCube(PhysicsWorld* world, const BodyState& state, double restitution = 0.0) {
  geometry::Collision solid = MakeCollision(kCube, Vector3d::Zero());
  solid.restitution = restitution;
  return world->AddLoose({kMass, Vector3d::Zero(), geometry::SolidInertia(kCube, kMass)}, {solid},
                         state);
}

TEST(BrokenTest, WhatBeginsDeepInSomethingAndIsThrownOutIsNamed) {
  PhysicsWorld world{PhysicsParams()};
  world.AddDriven({MakeCollision(geometry::Box{{0.5, 0.4, 0.06}}, Vector3d::Zero())}, {});
  AddCube(&world, At(0.1, 0.1, 0.0601));
  const BodyId deep = AddCube(&world, At(-0.1, 0.0, 0.04));  // 0.02 m below the plate's top
  for (int i = 0; i < 100; ++i) world.Step();
  ASSERT_TRUE(world.broken());
  EXPECT_EQ(*world.broken(), deep);
}

TEST(BrokenTest, ItStaysSoWhereTheWorldIsRestored) {
  PhysicsWorld world{PhysicsParams()};
  world.AddFloor(0.8);
  AddCube(&world, At(0.0, 0.0, 0.001));
  const PhysicsState sound = world.Save();
  for (int i = 0; i < 10; ++i) world.Step();
  const PhysicsState broken = world.Save();
  world.Restore(sound);
  EXPECT_FALSE(world.broken());
  world.Restore(broken);
  EXPECT_TRUE(world.broken());
}

TEST(BrokenTest, FallsBouncesPushesAndFastRidesAreNot) {
  const base::Rng seed(5);
  for (int i = 0; i < 300; ++i) {
    base::Rng rng = seed.Fork(i);
    PhysicsWorld world{PhysicsParams()};
    world.AddFloor(rng.Uniform(0.2, 1.0));
    const BodyId wall =
        world.AddDriven({MakeCollision(geometry::Box{{0.2, 2.0, 0.5}}, {0.0, 0.0, 0.25})},
                        geometry::Lift({-1.0, 0.0, 0.0}));
    BodyState pushing = world.GetState(wall);
    pushing.V_WB.linear.x() = rng.Uniform(0.0, 5.0);
    world.SetMotion(wall, pushing);
    for (int k = 0; k < 4; ++k) {
      BodyState state = At(rng.Uniform(-0.5, 0.5), 0.2 * k, rng.Uniform(0.1, 2.0));
      state.X_WB.rotation =
          Eigen::Quaterniond(rng.Normal(0, 1), rng.Normal(0, 1), rng.Normal(0, 1), rng.Normal(0, 1))
              .normalized();
      state.V_WB.linear = {rng.Normal(0, 2), rng.Normal(0, 2), rng.Normal(0, 2)};
      state.V_WB.angular = {rng.Normal(0, 5), rng.Normal(0, 5), rng.Normal(0, 5)};
      AddCube(&world, state, rng.Uniform(0.0, 0.3));
    }
    for (int step = 0; step < 800; ++step) world.Step();
    EXPECT_FALSE(world.broken()) << "case " << i;
  }
}

}  // namespace
}  // namespace hires::physics::broken_test
