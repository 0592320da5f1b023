#include "navigation/oscillation_guard.h"

#include <gtest/gtest.h>

namespace hires::navigation::oscillation_guard_test {
namespace {

const geometry::Twist2 kForward{0.3, 0.0, 0.0}, kBackward{-0.3, 0.0, 0.0};
const geometry::Twist2 kLeft{0.0, 0.1, 0.0}, kRight{0.0, -0.1, 0.0};
const geometry::Twist2 kTurnLeft{0.0, 0.0, 0.5}, kTurnRight{0.0, 0.0, -0.5};

class OscillationGuardTest : public ::testing::Test {
 protected:
  OscillationGuard guard_{0.05, 0.2, 0.1};
};

TEST_F(OscillationGuardTest, AtFirstEverythingIsAllowed) {
  for (const auto& V : {kForward, kBackward, kLeft, kRight, kTurnLeft, kTurnRight}) {
    EXPECT_TRUE(guard_.Allows(V));
  }
}

TEST_F(OscillationGuardTest, OneReversalIsAllowedASecondOneIsNot) {
  const geometry::Twist2* pairs[][2] = {
      {&kForward, &kBackward}, {&kLeft, &kRight}, {&kTurnLeft, &kTurnRight}};
  for (const auto& [one, other] : pairs) {
    guard_.Reset();
    guard_.Chosen(*one, {});
    EXPECT_TRUE(guard_.Allows(*other));
    guard_.Chosen(*other, {});
    EXPECT_TRUE(guard_.Allows(*other));
    EXPECT_FALSE(guard_.Allows(*one));
  }
}

TEST_F(OscillationGuardTest, GettingAwayFromTheTurningPointFrees) {
  guard_.Chosen(kLeft, {});
  guard_.Chosen(kRight, {});
  guard_.Chosen(kRight, {0.0, -0.04, 0.0});
  EXPECT_FALSE(guard_.Allows(kLeft));
  guard_.Chosen(kRight, {0.0, -0.06, 0.0});
  EXPECT_TRUE(guard_.Allows(kLeft));
}

TEST_F(OscillationGuardTest, TurningFarEnoughFreesAsWell) {
  guard_.Chosen(kTurnLeft, {0.0, 0.0, 3.1});
  guard_.Chosen(kTurnRight, {0.0, 0.0, 3.1});
  guard_.Chosen(kTurnRight, {0.0, 0.0, -3.1});  // 0.08 rad farther, across pi
  EXPECT_FALSE(guard_.Allows(kTurnLeft));
  guard_.Chosen(kTurnRight, {0.0, 0.0, 2.8});
  EXPECT_TRUE(guard_.Allows(kTurnLeft));
}

TEST_F(OscillationGuardTest, SteeringWhileDrivingForwardIsNoOscillation) {
  guard_.Chosen({0.3, 0.1, 0.5}, {});
  guard_.Chosen({0.3, -0.1, -0.5}, {});
  guard_.Chosen({0.3, 0.1, 0.5}, {});
  EXPECT_TRUE(guard_.Allows({0.3, 0.1, 0.5}));
  EXPECT_TRUE(guard_.Allows({0.3, -0.1, -0.5}));
}

}  // namespace
}  // namespace hires::navigation::oscillation_guard_test
