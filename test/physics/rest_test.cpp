// What rolls at the least touch rests until something comes to it, and it is known whom what
// reached.
#include <gtest/gtest.h>

#include <vector>

#include "hires/geometry/angles.h"
#include "physics/scenes.h"

namespace hires::physics::rest_test {
namespace {

using Eigen::Vector3d;
using test_support::At;
using test_support::MakeCollision;

constexpr double kRadius = 0.1, kMass = 0.4;
const geometry::Sphere kBall{kRadius};

void StepTimes(PhysicsWorld* world, int num_steps) {
  for (int i = 0; i < num_steps; ++i) world->Step();
}

BodyId AddBall(PhysicsWorld* world, const Vector3d& p, bool may_rest = true) {
  const BodyId ball =
      world->AddLoose({kMass, Vector3d::Zero(), geometry::SolidInertia(kBall, kMass)},
                      {MakeCollision(kBall, Vector3d::Zero())}, At(p.x(), p.y(), p.z()));
  if (may_rest) world->LetRest(ball);
  return ball;
}

bool IsSame(const BodyState& a, const BodyState& b) {
  return a.X_WB.translation == b.X_WB.translation &&
         a.X_WB.rotation.coeffs() == b.X_WB.rotation.coeffs() && a.V_WB.linear == b.V_WB.linear &&
         a.V_WB.angular == b.V_WB.angular;
}

/// A floor, and a block that is driven along x.
class RestTest : public ::testing::Test {
 protected:
  RestTest() {
    world_.AddFloor(1.0);
    pusher_ = world_.AddDriven({MakeCollision(geometry::Box{{0.2, 0.4, 0.2}}, {0.0, 0.0, 0.1})},
                               geometry::Lift({-1.0, 0.0, 0.0}));
  }

  void Push(double from, double to, double speed) {
    world_.SetMotion(pusher_, {geometry::Lift({from, 0.0, 0.0}), {{speed, 0.0, 0.0}, {}}});
    StepTimes(&world_, static_cast<int>((to - from) / speed / world_.params().time_step));
  }

  PhysicsWorld world_{PhysicsParams()};
  BodyId pusher_{-1};
};

TEST_F(RestTest, ABallOnTheFloorKeepsItsPoseBitForBit) {
  const BodyId ball = AddBall(&world_, {0.0, 0.0, kRadius});
  const BodyId other = AddBall(&world_, {0.0, 1.0, kRadius}, false);
  StepTimes(&world_, 5);
  ASSERT_TRUE(world_.IsResting(ball));
  EXPECT_FALSE(world_.IsResting(other)) << "nobody lets it";
  const BodyState rests = world_.GetState(ball);
  StepTimes(&world_, 2000);
  EXPECT_TRUE(IsSame(world_.GetState(ball), rests));
  EXPECT_EQ(world_.num_contacts(), 1) << "that of the other one";
  EXPECT_FALSE(world_.IsReached(ball));
  EXPECT_LT((rests.X_WB.translation - Vector3d(0.0, 0.0, kRadius)).norm(), 1e-3);
}

TEST_F(RestTest, ACylinderOnItsSideRests) {
  const geometry::Cylinder pipe{kRadius, 0.6};
  BodyState lying = At(0.0, 0.0, kRadius);
  lying.X_WB.rotation = geometry::RotationFromRpy(geometry::kPi / 2, 0.0, 0.4);
  const BodyId body =
      world_.AddLoose({kMass, Vector3d::Zero(), geometry::SolidInertia(pipe, kMass)},
                      {MakeCollision(pipe, Vector3d::Zero())}, lying);
  world_.LetRest(body);
  StepTimes(&world_, 20);
  EXPECT_TRUE(world_.IsResting(body));
}

TEST_F(RestTest, WhatFallsRestsWhereItComesToLieAndWhatRollsDownASlopeDoesNot) {
  const BodyId falling = AddBall(&world_, {0.0, 0.0, 0.5});
  geometry::Pose3 slope;
  slope.translation = {5.0, 0.0, 0.3};
  slope.rotation = geometry::RotationFromRpy(0.0, 0.05, 0.0);
  world_.AddStatic({MakeCollision(geometry::Box{{2.0, 2.0, 0.1}}, Vector3d::Zero())}, slope);
  const BodyId rolling = AddBall(&world_, {4.5, 0.0, 0.35 + kRadius + 0.026});
  StepTimes(&world_, 10);
  EXPECT_FALSE(world_.IsResting(falling));
  StepTimes(&world_, 490);
  EXPECT_TRUE(world_.IsResting(falling));
  EXPECT_NEAR(world_.GetState(falling).X_WB.translation.z(), kRadius, 2e-3);
  EXPECT_FALSE(world_.IsResting(rolling));
  EXPECT_GT(world_.GetState(rolling).X_WB.translation.x(), 4.53);
  EXPECT_FALSE(world_.IsReached(rolling)) << "its own weight moves it";
}

TEST_F(RestTest, WhatIsPushedRollsAndReachesWhatItHits) {
  const BodyId first = AddBall(&world_, {0.0, 0.0, kRadius});
  const BodyId second = AddBall(&world_, {0.5, 0.0, kRadius});
  const BodyId beside = AddBall(&world_, {0.0, 1.0, kRadius});
  StepTimes(&world_, 5);
  Push(-0.3, -0.2, 0.5);
  EXPECT_TRUE(world_.IsResting(first));
  Push(-0.2, -0.05, 0.5);
  EXPECT_FALSE(world_.IsResting(first));
  EXPECT_TRUE(world_.IsReached(first));
  EXPECT_GT(world_.GetState(first).V_WB.linear.x(), 0.4);
  EXPECT_FALSE(world_.IsReached(second));
  world_.SetMotion(pusher_, {geometry::Lift({-1.0, 0.0, 0.0}), {}});
  StepTimes(&world_, 1000);
  EXPECT_TRUE(world_.IsReached(second));
  EXPECT_GT(world_.GetState(second).X_WB.translation.x(), 0.55);
  EXPECT_TRUE(world_.IsResting(beside));
  EXPECT_FALSE(world_.IsReached(beside));
  EXPECT_FALSE(world_.broken());
}

TEST_F(RestTest, ARowWakesAsAWhole) {
  std::vector<BodyId> row;
  for (int i = 4; i >= 0; --i) row.push_back(AddBall(&world_, {2.0 * kRadius * i, 0.0, kRadius}));
  StepTimes(&world_, 50);
  Push(-0.25, -0.15, 0.5);
  for (const BodyId ball : row) {
    EXPECT_TRUE(world_.IsReached(ball));
    EXPECT_GT(world_.GetState(ball).V_WB.linear.x(), 0.1);
  }
}

TEST_F(RestTest, WhatIsPutElsewhereOrHeldOrShakenDoesNotRest) {
  const BodyId ball = AddBall(&world_, {0.0, 0.0, kRadius});
  StepTimes(&world_, 5);
  world_.SetState(ball, At(0.0, 0.0, 1.0));
  EXPECT_FALSE(world_.IsResting(ball));
  StepTimes(&world_, 1000);
  ASSERT_TRUE(world_.IsResting(ball));
  world_.SetExtraAcceleration({1.0, 0.0, 0.0});
  StepTimes(&world_, 100);
  EXPECT_GT(world_.GetState(ball).V_WB.linear.x(), 0.05);
  world_.SetExtraAcceleration(Vector3d::Zero());
  world_.SetState(ball, At(0.0, 0.0, kRadius));
  StepTimes(&world_, 5);
  ASSERT_TRUE(world_.IsResting(ball));
  world_.Hold(ball, pusher_, {});
  EXPECT_FALSE(world_.IsResting(ball));
  EXPECT_TRUE(world_.IsReached(ball));
  Push(-1.0, -0.5, 0.5);
  EXPECT_NEAR(world_.GetState(ball).X_WB.translation.x(), 0.5, 0.01);
}

TEST_F(RestTest, WhatRestsAndWhatWasReachedIsSaved) {
  const BodyId first = AddBall(&world_, {0.0, 0.0, kRadius});
  const BodyId second = AddBall(&world_, {0.5, 0.0, kRadius});
  StepTimes(&world_, 5);
  Push(-0.3, -0.05, 0.5);
  const PhysicsState saved = world_.Save();
  StepTimes(&world_, 1500);
  const BodyState ends[] = {world_.GetState(first), world_.GetState(second)};
  EXPECT_TRUE(world_.IsReached(second));
  world_.Restore(saved);
  EXPECT_TRUE(world_.IsReached(first));
  EXPECT_FALSE(world_.IsResting(first));
  EXPECT_TRUE(world_.IsResting(second));
  EXPECT_FALSE(world_.IsReached(second));
  StepTimes(&world_, 1500);
  EXPECT_TRUE(IsSame(world_.GetState(first), ends[0]));
  EXPECT_TRUE(IsSame(world_.GetState(second), ends[1]));
}

}  // namespace
}  // namespace hires::physics::rest_test
